#include "planning/feed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp::planning {
namespace {

using programs::MotionKind;

class Profile {
 public:
  Profile(const programs::Program& program, const std::vector<PathPoint>& points,
          const recording::Samples& q, const FeedLimits& limits)
      : program_(program), points_(points), q_(q), limits_(limits) {}

  Eigen::VectorXd times() {
    const std::size_t count = points_.size();
    std::vector<double> way(count, 0);
    std::vector<double> most(count, std::numeric_limits<double>::infinity());
    for (std::size_t i = 1; i < count; ++i) {
      way[i] = std::max(distance(points_[i - 1].pose, points_[i].pose), 1e-9);
      const double along = speed_between(i, way[i]);
      most[i - 1] = std::min(most[i - 1], along);
      most[i] = std::min(most[i], along);
    }
    for (std::size_t i = 1; i + 1 < count; ++i) {
      most[i] = std::min(most[i], speed_round(i, way[i], way[i + 1]));
    }
    most.front() = most.back() = 0;
    limit_acceleration(way, &most);
    return add_up(way, most);
  }

 private:
  double speed_between(std::size_t i, double way) const {
    double speed = way / time_at_feed(i, way);
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const auto row = static_cast<Eigen::Index>(i);
      const double turn = std::abs(q_(row, joint) - q_(row - 1, joint));
      if (limits_.joint_speed[joint] > 0 && turn > 0) {
        speed = std::min(speed, way * limits_.joint_speed[joint] / turn);
      }
    }
    return speed;
  }

  /// The slower governs of the TCP's feed and that of the orientation.
  double time_at_feed(std::size_t i, double way) const {
    const programs::Motion& motion = program_.motions[points_[i].motion];
    if (motion.kind == MotionKind::rapid) {
      return way / limits_.rapid;
    }
    const Pose<double>& from = points_[i - 1].pose;
    const Pose<double>& to = points_[i].pose;
    const double feed = motion.feed > 0 ? motion.feed : limits_.feed;
    const double turn_feed = motion.turn_feed > 0 ? motion.turn_feed : limits_.turn;
    constexpr double kStands = 1e-9;  // m
    return std::max({(to.position - from.position).norm() / feed,
                     programs::turn_between(from.rotation, to.rotation) / turn_feed,
                     kStands / feed});
  }

  /// The speed round a bend. Within a motion its curvature tells; from one motion to the next the
  /// arc that a corner may be rounded by (junction deviation).
  double speed_round(std::size_t i, double before, double after) const {
    const Vector3<double> in = points_[i].pose.position - points_[i - 1].pose.position;
    const Vector3<double> out = points_[i + 1].pose.position - points_[i].pose.position;
    const double lengths = in.norm() * out.norm();
    if (!(lengths > 0)) {
      return std::numeric_limits<double>::infinity();
    }
    const double turn = std::acos(std::clamp(in.dot(out) / lengths, -1.0, 1.0));
    constexpr double kCorner = 0.17;  // rad: less is a curve in short lines
    if (turn > kCorner && points_[i].motion != points_[i + 1].motion) {
      const double half = std::cos(turn / 2);  // sine of half the angle between the two ways
      return std::sqrt(limits_.acceleration * limits_.corner * half / std::max(1 - half, 1e-9));
    }
    return std::sqrt(limits_.acceleration * (before + after) / 2 / std::max(turn, 1e-12));
  }

  void limit_acceleration(const std::vector<double>& way, std::vector<double>* speed) const {
    const auto reached = [&](double from, double length) {
      return std::sqrt(from * from + 2 * limits_.acceleration * length);
    };
    for (std::size_t i = 1; i < way.size(); ++i) {
      (*speed)[i] = std::min((*speed)[i], reached((*speed)[i - 1], way[i]));
    }
    for (std::size_t i = way.size() - 1; i > 0; --i) {
      (*speed)[i - 1] = std::min((*speed)[i - 1], reached((*speed)[i], way[i]));
    }
  }

  /// Between two stops a robot speeds up to the middle and slows down: at half of that on average.
  Eigen::VectorXd add_up(const std::vector<double>& way, const std::vector<double>& speed) const {
    Eigen::VectorXd time(static_cast<Eigen::Index>(way.size()));
    time[0] = 0;
    for (std::size_t i = 1; i < way.size(); ++i) {
      const double least = std::sqrt(limits_.acceleration * way[i]) / 2;
      const double mean =
          std::max((speed[i - 1] + speed[i]) / 2, std::min(least, speed_between(i, way[i])));
      const auto row = static_cast<Eigen::Index>(i);
      time[row] = time[row - 1] + way[i] / mean;
      if (time[row] <= time[row - 1]) {
        time[row] = std::nextafter(time[row - 1], std::numeric_limits<double>::infinity());
      }
    }
    return time;
  }

  const programs::Program& program_;
  const std::vector<PathPoint>& points_;
  const recording::Samples& q_;
  const FeedLimits& limits_;
};

}  // namespace

Eigen::VectorXd times_along(const programs::Program& program, const std::vector<PathPoint>& points,
                            const recording::Samples& q, const FeedLimits& limits) {
  return Profile(program, points, q, limits).times();
}

}  // namespace flexcomp::planning
