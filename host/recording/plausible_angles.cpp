#include "recording/plausible_angles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::recording {
namespace {

using model::Chain;
using model::ChainJoint;

constexpr double kHalfTurn = 3.141592653589793;

/// An angle beyond this one is taken for a slip of the unit; below it a robot's own limits may be a
/// little off.
double slip_of(const ChainJoint& joint) {
  return joint.slides() ? joint.upper - joint.lower : kHalfTurn;
}

[[noreturn]] void refuse(const std::string& place, const std::string& column, double angle,
                         const ChainJoint& joint) {
  const double beyond = std::max(joint.lower - angle, angle - joint.upper);
  const char* const asked = joint.slides() ? "; expected metres: are these millimetres?"
                                           : "; expected radians: are these degrees?";
  const char* const unit = joint.slides() ? "m" : "rad";
  throw InputError(fmt::format(
      "{}: column '{}': {:.6g} {} lies outside the joint's limits, {:.4g} to {:.4g} {}{}", place,
      column, angle, unit, joint.lower, joint.upper, unit, beyond > slip_of(joint) ? asked : ""));
}

/// `margin`: let pass beyond the limits, as a share of a slip.
void refuse_angles_outside_limits(const Recording& recording, const std::optional<Samples>& angles,
                                  const char* columns, const Chain& chain, double margin) {
  for (Eigen::Index row = 0; angles && row < angles->rows(); ++row) {
    for (Eigen::Index i = 0; i < angles->cols(); ++i) {
      const ChainJoint& joint = chain.joint(i);
      const double angle = (*angles)(row, i);
      const double beyond = margin * slip_of(joint);
      if (angle < joint.lower - beyond || angle > joint.upper + beyond) {
        refuse(recording.place(row), fmt::format("{}_{}", columns, i + 1), angle, joint);
      }
    }
  }
}

}  // namespace

Recording read_recording_of(const Chain& chain, const std::filesystem::path& path) {
  Recording recording = read_recording(path, static_cast<int>(chain.size()));
  refuse_angles_outside_limits(recording, recording.q_cmd, "q_cmd", chain, 1);
  refuse_angles_outside_limits(recording, recording.q_meas, "q_meas", chain, 1);
  return recording;
}

Recording read_program_of(const Chain& chain, const std::filesystem::path& path) {
  constexpr double kRounded = 3e-7;  // the limits that the core compares with are these, as floats
  Recording program = read_recording_of(chain, path);
  refuse_angles_outside_limits(program, program.q_cmd, "q_cmd", chain, kRounded);
  return program;
}

}  // namespace flexcomp::recording
