#include "programs/read_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "error.hpp"
#include "programs/csv_reader.hpp"
#include "programs/gcode_reader.hpp"
#include "programs/krl_reader.hpp"
#include "programs/rapid_reader.hpp"

namespace flexcomp::programs {
namespace {

constexpr std::array<std::pair<std::string_view, Format>, 13> kEndings = {{
    {".src", Format::krl},
    {".mod", Format::rapid},
    {".modx", Format::rapid},
    {".prg", Format::rapid},
    {".csv", Format::csv},
    {".nc", Format::gcode},
    {".ngc", Format::gcode},
    {".gcode", Format::gcode},
    {".gc", Format::gcode},
    {".tap", Format::gcode},
    {".cnc", Format::gcode},
    {".iso", Format::gcode},
    {".mpf", Format::gcode},
}};

Program read_as(Format format, const std::filesystem::path& file) {
  switch (format) {
    case Format::krl:
      return read_krl(file);
    case Format::rapid:
      return read_rapid(file);
    case Format::csv:
      return read_cartesian_csv(file);
    case Format::gcode:
      break;
  }
  return read_gcode(file);
}

}  // namespace

Format format_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* const found = std::find_if(kEndings.begin(), kEndings.end(),
                                         [&](const auto& each) { return each.first == ending; });
  if (found == kEndings.end()) {
    throw InputError(fmt::format(
        "{}: no program's ending; expected .nc, .ngc, .gcode or .tap (G-code), .src (KRL), .mod "
        "(RAPID) or .csv",
        file.string()));
  }
  return found->second;
}

Program read_program(const std::filesystem::path& file) {
  Program program = read_as(format_of(file), file);
  if (program.motions.empty()) {
    throw InputError(fmt::format("{}: a program without motions", file.string()));
  }
  return program;
}

}  // namespace flexcomp::programs
