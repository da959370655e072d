#include "study/path_wrench.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "error.hpp"
#include "flexcomp/chain.hpp"

namespace flexcomp::study {
namespace {

constexpr double kStands = 1e-9;        // m/s
constexpr double kAlongTheAxis = 1e-3;  // of the speed: less is across the tool's axis

void refuse_coarse_rows(const recording::Recording& path, const EndMilling& milling, double speed) {
  constexpr double kLeastRows = 8;  // in a tooth's pass
  if (!(speed > 0) || !std::isfinite(speed)) {
    throw InputError("the spindle's speed must be above zero");
  }
  const double pass = 2 * M_PI / (speed * milling.teeth);
  for (Eigen::Index i = 1; i < path.size(); ++i) {
    const double step = path.time[i] - path.time[i - 1];
    if (step > pass / kLeastRows) {
      throw InputError(
          fmt::format("{}: {:.3g} s since the row before, but a tooth passes every {:.3g} s: take "
                      "mean forces, or rows at most an eighth of that apart",
                      path.place(i), step, pass));
    }
  }
}

}  // namespace

recording::Recording with_milling_wrench(const RobotModel<double, 6>& model,
                                         recording::Recording path, const EndMilling& milling,
                                         const Spindle& spindle) {
  check(milling);
  const recording::Samples& q = recording::require(path, path.q_cmd, "q_cmd_1..6");
  if (path.size() < 2) {
    throw InputError(fmt::format("{}: a path needs two rows or more", path.file));
  }
  if (!spindle.is_mean) {
    refuse_coarse_rows(path, milling, spindle.speed);
  }
  std::vector<Pose<double>> poses;
  for (Eigen::Index i = 0; i < path.size(); ++i) {
    poses.push_back(forward_kinematics<double, 6>(model, q.row(i).transpose()).tcp);
  }
  const Wrench<double> mean = spindle.is_mean ? mean_wrench(milling) : Wrench<double>::Zero();
  recording::Samples wrenches = recording::Samples::Zero(path.size(), 6);
  for (Eigen::Index i = 0; i < path.size(); ++i) {
    const Eigen::Index before = std::max<Eigen::Index>(i - 1, 0);
    const Eigen::Index after = std::min<Eigen::Index>(i + 1, path.size() - 1);
    const Vector3<double> velocity = (poses[static_cast<std::size_t>(after)].position -
                                      poses[static_cast<std::size_t>(before)].position) /
                                     (path.time[after] - path.time[before]);
    if (velocity.norm() < kStands) {
      continue;
    }
    const Vector3<double> up = -poses[static_cast<std::size_t>(i)].rotation.col(2);
    const Vector3<double> feed = velocity - up.dot(velocity) * up;
    if (feed.norm() < kAlongTheAxis * velocity.norm()) {
      throw InputError(fmt::format(
          "{}: the TCP moves along the tool's axis: that is drilling, not milling", path.place(i)));
    }
    Matrix3<double> frame;
    frame << feed.normalized(), up.cross(feed).normalized(), up;
    const Wrench<double> own =
        spindle.is_mean ? mean : instantaneous_wrench(milling, spindle.speed * path.time[i]);
    wrenches.row(i).head<3>() = (frame * own.head<3>()).transpose();
    wrenches.row(i).tail<3>() = (frame * own.tail<3>()).transpose();
  }
  path.wrench = wrenches;
  return path;
}

}  // namespace flexcomp::study
