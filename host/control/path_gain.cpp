#include "control/path_gain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexcomp/compliance.hpp"

namespace flexcomp::control {
namespace {

/// Of the feedback λ (cut_feedback), along a path.
struct FeedbackRange {
  double least = 0;
  double most = 0;

  void include(double feedback) {
    least = std::min(least, feedback);
    most = std::max(most, feedback);
  }
};

/// The part of a displacement that is at right angles to the feed at a row.
double across_feed(const Vector3<double>& displacement, const recording::Samples& position,
                   Eigen::Index row) {
  const Eigen::Index next = std::min(row + 1, position.rows() - 1);
  const Eigen::Index previous = std::max<Eigen::Index>(row - 1, 0);
  const Vector3<double> feed = (position.row(next) - position.row(previous)).transpose();
  const Vector3<double> along = feed.norm() > 0 ? feed.normalized() : Vector3<double>::Zero();
  return (displacement - along * along.dot(displacement)).norm();
}

FeedbackRange feedback_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                             const simulation::Process& process) {
  const recording::Samples& q_cmd = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
  const recording::Samples& wrenches = recording::require(path, path.wrench, "fx..mz");
  recording::Samples position(path.size(), 3);
  recording::Samples displacement(path.size(), 3);
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    const JointVector<double, 6> q = q_cmd.row(row).transpose();
    const Wrench<double> wrench = wrenches.row(row).transpose();
    const Kinematics<double, 6> at = forward_kinematics<double, 6>(model, q);
    const Twist<double> bent = tcp_compliance<double, 6>(model, at) * wrench;
    position.row(row) = at.tcp.position.transpose();
    displacement.row(row) = bent.head<3>().transpose();
  }
  const std::optional<recording::Samples> normals =
      simulation::surface_normals(position, process.side);
  FeedbackRange range;
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    if (normals) {
      range.include(normals->row(row).dot(displacement.row(row)) / process.depth_of_cut);
      continue;
    }
    const double worst =
        across_feed(displacement.row(row).transpose(), position, row) / process.depth_of_cut;
    range.include(worst);
    range.include(-worst);
  }
  return range;
}

}  // namespace

GainLimit gain_limit_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                           const simulation::Process& process, const CorrectionLoop& loop,
                           double softer) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const FeedbackRange range = feedback_along(model, path, process);
  const auto deepened = [&](double gain) {
    const double left = 1 - range.most * (1 - gain / softer);
    return left > 0 ? 1 / left : kInfinite;
  };
  GainLimit limit;
  limit.engagement_without = deepened(0);
  if (range.most < 1) {
    // λ/(1−λ) grows with λ: only the ends of the range can be the worst.
    const auto critical = [&](double feedback) {
      return critical_gain(feedback / softer / (1 - feedback), loop);
    };
    limit.stable = std::min(critical(range.least), critical(range.most));
  }
  limit.safe = std::clamp(limit.stable / GainLimit::kMargin, GainLimit::kNone, 1.0);
  limit.engagement = range.most < 1 ? deepened(limit.safe) : kInfinite;
  if (limit.digs_in()) {
    limit.safe = GainLimit::kNone;
  }
  return limit;
}

}  // namespace flexcomp::control
