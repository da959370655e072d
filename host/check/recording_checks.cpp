#include "check/recording_checks.hpp"

#include <algorithm>
#include <string>

#include "check/angles.hpp"
#include "check/columns.hpp"
#include "check/loads.hpp"
#include "check/positions.hpp"
#include "check/times.hpp"

namespace flexcomp::check {
namespace {

bool names(const Checks& checks, const std::string& beginning) {
  return std::any_of(checks.begin(), checks.end(), [&](const Check& each) {
    return each.name.compare(0, beginning.size(), beginning) == 0;
  });
}

}  // namespace

Checks check_recording(const model::Robot* robot, recording::Recording recording) {
  Checks checks;
  if (robot != nullptr && recording.angles() == nullptr) {
    return {{Severity::error, "recording", "column.missing",
             recording.file + ": the recording has no joint angles, without which nothing can be "
                              "compared with the model",
             "record q_meas_1 to q_meas_n, or q_cmd_1 to q_cmd_n"}};
  }
  if (robot != nullptr) {
    add(check_angles(*robot, &recording), &checks);
  }
  add(check_times(robot, &recording), &checks);
  if (robot != nullptr) {
    bool proved = false;
    add(check_positions(*robot, &recording, &proved), &checks);
    if (!names(checks, "model.")) {
      add(check_torques(*robot, proved, &recording), &checks);
      add(check_wrench(*robot, recording), &checks);
      if (!proved && !names(checks, "joint.")) {
        add(check_signs_by_limits(*robot, &recording), &checks);
      }
      add(check_limits(*robot, recording), &checks);
    }
  }
  add(check_columns(recording), &checks);
  add(check_motion(recording), &checks);
  return checks;
}

}  // namespace flexcomp::check
