#include "control/path_gain.hpp"

#include <algorithm>
#include <cmath>

#include "flexcomp/compliance.hpp"

namespace flexcomp::control {
namespace {

/// The part of a displacement that is at right angles to the feed at a row.
double across_feed(const Vector3<double>& displacement, const recording::Samples& position,
                   Eigen::Index row) {
  const Eigen::Index next = std::min(row + 1, position.rows() - 1);
  const Eigen::Index previous = std::max<Eigen::Index>(row - 1, 0);
  const Vector3<double> feed = (position.row(next) - position.row(previous)).transpose();
  const Vector3<double> along = feed.norm() > 0 ? feed.normalized() : Vector3<double>::Zero();
  return (displacement - along * along.dot(displacement)).norm();
}

}  // namespace

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

GainBasis gain_basis(const FeedbackRange& feedback, const simulation::Process& process,
                     const CorrectionLoop& loop) {
  const double depth = process.depth_of_cut;
  return {static_cast<float>(feedback.least * depth),
          static_cast<float>(feedback.most * depth),
          static_cast<float>(depth),
          static_cast<float>(loop.period),
          static_cast<float>(loop.filter_cutoff),
          static_cast<float>(loop.delay)};
}

double largest_gain_in(const TableHeader& header, double period, double filter_cutoff) {
  const auto stated = static_cast<double>(header.largest_gain);
  GainBasis basis = flexcomp::gain_basis(header);
  if (stated <= 0 || is_empty(basis)) {
    return stated;
  }
  basis.period = static_cast<float>(period);
  basis.filter_cutoff = static_cast<float>(filter_cutoff);
  basis.delay = std::max(basis.delay, basis.period);
  return std::min(stated, gain_limit(basis).safe);
}

}  // namespace flexcomp::control
