#include "recording/plausible_angles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::recording {
namespace {

constexpr double kHalfTurn = 3.141592653589793;

[[noreturn]] void refuse(const std::string& place, const std::string& column, double angle,
                         const Joint<double>& joint) {
  const double beyond = std::max(joint.lower - angle, angle - joint.upper);
  throw InputError(fmt::format(
      "{}: column '{}': {:.6g} rad lies outside the joint's limits, {:.4g} to {:.4g} rad{}", place,
      column, angle, joint.lower, joint.upper,
      beyond > kHalfTurn ? "; expected radians: are these degrees?" : ""));
}

void refuse_angles_outside_limits(const Recording& recording, const std::optional<Samples>& angles,
                                  const char* columns, const RobotModel<double, 6>& model,
                                  double margin) {
  for (Eigen::Index row = 0; angles && row < angles->rows(); ++row) {
    for (Eigen::Index i = 0; i < angles->cols(); ++i) {
      const Joint<double>& joint = model.joints[static_cast<std::size_t>(i)];
      const double angle = (*angles)(row, i);
      if (angle < joint.lower - margin || angle > joint.upper + margin) {
        refuse(recording.place(row), fmt::format("{}_{}", columns, i + 1), angle, joint);
      }
    }
  }
}

}  // namespace

Recording read_recording_of(const RobotModel<double, 6>& model, const std::filesystem::path& path) {
  Recording recording = read_recording(path);
  refuse_angles_outside_limits(recording, recording.q_cmd, "q_cmd", model, kHalfTurn);
  refuse_angles_outside_limits(recording, recording.q_meas, "q_meas", model, kHalfTurn);
  return recording;
}

Recording read_program_of(const RobotModel<double, 6>& model, const std::filesystem::path& path) {
  Recording program = read_recording_of(model, path);
  // The limits that the core compares with are these, rounded to float.
  refuse_angles_outside_limits(program, program.q_cmd, "q_cmd", model, 1e-6);
  return program;
}

}  // namespace flexcomp::recording
