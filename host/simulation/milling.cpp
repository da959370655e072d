#include "simulation/milling.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/chain.hpp"

namespace flexcomp::simulation {

// The sides come from the way the path turns: its area vector (Newell) is the axis it runs around,
// and outside is feed × axis.
std::optional<recording::Samples> surface_normals(const recording::Samples& position,
                                                  MaterialSide side) {
  constexpr double kNoArea = 1e-6;  // of the length squared: a line that wavers
  const Eigen::Index rows = position.rows();
  Vector3<double> axis = Vector3<double>::Zero();
  double length = 0;
  const Vector3<double> origin = position.row(0).transpose();
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Vector3<double> a = position.row(i).transpose() - origin;
    const Vector3<double> b = position.row((i + 1) % rows).transpose() - origin;
    axis += a.cross(b);
    length += (b - a).norm();
  }
  if (!(axis.norm() > kNoArea * length * length)) {
    return std::nullopt;
  }
  axis.normalize();
  recording::Samples normals(rows, 3);
  Vector3<double> last = Vector3<double>::Zero();
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Index next = std::min(i + 1, rows - 1);
    const Eigen::Index previous = std::max<Eigen::Index>(i - 1, 0);
    const Vector3<double> feed = (position.row(next) - position.row(previous)).transpose();
    const Vector3<double> outward = feed.cross(axis);
    last = outward.norm() > 0 ? outward.normalized() : last;
    normals.row(i) = (side == MaterialSide::outside ? last : Vector3<double>(-last)).transpose();
  }
  return normals;
}

Contour::Contour(const RobotModel<double, 6>& model, const recording::Recording& path,
                 MaterialSide side)
    : model_(model),
      time_(path.time),
      q_(recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6")),
      wrench_(recording::require(path, path.wrench, "fx..mz")) {
  if (path.size() < 3) {
    throw InputError(path.file + ": expected a path of at least three rows");
  }
  recording::Samples position(path.size(), 3);
  for (Eigen::Index i = 0; i < path.size(); ++i) {
    const JointVector<double, 6> q = q_.row(i).transpose();
    position.row(i) = forward_kinematics<double, 6>(model_, q).tcp.position.transpose();
  }
  const std::optional<recording::Samples> normals = surface_normals(position, side);
  if (!normals) {
    throw InputError(path.file + ": the path encloses no area, so it has no outside to mill");
  }
  normal_ = *normals;
}

Contour::Point Contour::at(double time) const {
  const double wanted = std::clamp(time + time_[0], time_[0], time_[time_.size() - 1]);
  const double* const after =
      std::upper_bound(time_.data() + 1, time_.data() + time_.size() - 1, wanted);
  const Eigen::Index row = after - time_.data() - 1;
  const double share = (wanted - time_[row]) / (time_[row + 1] - time_[row]);
  const auto between = [&](const recording::Samples& samples) {
    return Eigen::VectorXd((1 - share) * samples.row(row) + share * samples.row(row + 1));
  };
  Point point;
  point.q = between(q_);
  point.wrench = between(wrench_);
  point.position = forward_kinematics<double, 6>(model_, point.q).tcp.position;
  point.normal = between(normal_).normalized();
  return point;
}

RobotInCut::State MillingRobot::stand(const JointVector<double, 6>& q_motor,
                                      const Contour::Point& point, double load) {
  constexpr int kIterations = 8;
  constexpr double kEnough = 1e-10;
  Vector3<double> position = point.position;
  const auto engagement_after = [&](double engagement) {
    const Wrench<double> wrench = load * engagement * point.wrench;
    position = settle(chain_, q_motor, wrench).tcp.position;
    const double deeper = point.normal.dot(position - point.position);
    return 1 + deeper / process_.depth_of_cut;
  };
  // The fixed point of a nearly straight line, by the secant through its last two points.
  double first = engagement_;
  double first_miss = engagement_after(first) - first;
  double second = std::clamp(first + first_miss, 0.0, kMostEngagement);
  for (int i = 0; i < kIterations && std::abs(second - first) > kEnough; ++i) {
    const double miss = engagement_after(second) - second;
    const double slope = (miss - first_miss) / (second - first);
    first = second;
    first_miss = miss;
    // A slope of zero or more means that the force grows faster than the depth: it digs in.
    const double next = slope < 0 ? second - miss / slope : (miss > 0 ? kMostEngagement : 0.0);
    second = std::clamp(next, 0.0, kMostEngagement);
  }
  engagement_ = second;
  engagement_after(engagement_);
  return {position, load * engagement_ * point.wrench, engagement_};
}

}  // namespace flexcomp::simulation
