#include "programs/corrected_program.hpp"

#include <Eigen/Geometry>

#include "programs/csv_writer.hpp"
#include "programs/gcode_writer.hpp"
#include "programs/krl_writer.hpp"
#include "programs/rapid_writer.hpp"

namespace flexcomp::programs {

std::string text_of(const CorrectedProgram& program, Format format, const std::string& name) {
  switch (format) {
    case Format::krl:
      return krl_text(program, name);
    case Format::rapid:
      return rapid_text(program, name);
    case Format::csv:
      return csv_text(program);
    case Format::gcode:
      break;
  }
  return gcode_text(program);
}

}  // namespace flexcomp::programs
