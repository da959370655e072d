#include "planning/closed_form.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

namespace flexcomp::planning {
namespace {

using Angles = JointVector<double, 6>;
using Planar = std::complex<double>;  // x + iz

constexpr double kExact = 1e-5;   // rad, and of the reach
constexpr double kNearly = 1e-3;  // the same
constexpr double kInLine = 1e-9;  // sine between axes that turn as one

Matrix3<double> turn(const Vector3<double>& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

double sine(const Vector3<double>& axis, const Vector3<double>& other) {
  return axis.cross(other).norm();
}

Planar in_plane(const Vector3<double>& point) { return {point.x(), point.z()}; }

/// A line in space.
struct Line {
  Vector3<double> point;
  Vector3<double> direction;  ///< unit
};

/// The points of two lines that are closest to each other, of lines that are not parallel.
std::pair<Vector3<double>, Vector3<double>> closest(const Line& a, const Line& b) {
  const double cosine = a.direction.dot(b.direction);
  const Vector3<double> apart = b.point - a.point;
  const double square = 1 - cosine * cosine;
  const double along_a = (apart.dot(a.direction) - cosine * apart.dot(b.direction)) / square;
  const double along_b = (cosine * apart.dot(a.direction) - apart.dot(b.direction)) / square;
  return {a.point + along_a * a.direction, b.point + along_b * b.direction};
}

/// The robot with all joints at zero, in a frame with z along the axis of joint 1 and through its
/// origin, y along that of joint 2.
class Arm {
 public:
  explicit Arm(const RobotModel<double, 6>& model) {
    const Kinematics<double, 6> at = forward_kinematics<double, 6>(model, Angles(Angles::Zero()));
    const Vector3<double> z = at.axes[0].normalized();
    const Vector3<double> y = (at.axes[1] - at.axes[1].dot(z) * z).normalized();
    frame_ << y.cross(z), y, z;
    origin_ = at.links[0].position;
    for (std::size_t i = 0; i < 6; ++i) {
      axes_[i] = {into_frame(at.links[i].position), frame_.transpose() * at.axes[i]};
    }
    tcp_ = {frame_.transpose() * at.tcp.rotation, into_frame(at.tcp.position)};
    for (std::size_t i = 1; i < 6; ++i) {
      reach_ += (at.links[i].position - at.links[i - 1].position).norm();
    }
    reach_ += (at.tcp.position - at.links[5].position).norm();
    judge();
  }

  /// How far, in rad or of the reach, it is from a robot of either kind.
  double off() const { return std::min(off_wrist_, off_parallel_); }

  std::vector<Angles> solve(const Pose<double>& target) const {
    const Pose<double> inside = {frame_.transpose() * target.rotation, into_frame(target.position)};
    // From all joints at zero to the target, as the last link is moved.
    const Matrix3<double> hand = inside.rotation * tcp_.rotation.transpose();
    const Vector3<double> center = inside.position + hand * (center_ - tcp_.position);
    std::vector<Angles> all;
    for (const double way : {1.0, -1.0}) {
      const double out =
          way * reach_ *
          root((center.head<2>().squaredNorm() - center_.y() * center_.y()) / (reach_ * reach_));
      if (std::isnan(out)) {
        continue;
      }
      // The centre keeps its distance from the plane of joints 2 and 3.
      const double first = std::atan2(center.y(), center.x()) - std::atan2(center_.y(), out);
      const Matrix3<double> rest = turn(Vector3<double>::UnitZ(), -first) * hand;
      Angles q = Angles::Zero();
      q[0] = first;
      if (off_wrist_ <= off_parallel_) {
        for (const std::array<double, 2>& pair : planar(Planar(out, center.z()), center_)) {
          q[1] = pair[0];
          q[2] = pair[1];
          const Matrix3<double> turned =
              turn(axes_[1].direction, q[1]) * turn(axes_[2].direction, q[2]);
          add_wrists(turned.transpose() * rest, q, &all);
        }
      } else {
        add_parallel(rest, Planar(out, center.z()), q, &all);
      }
    }
    return all;
  }

 private:
  Vector3<double> into_frame(const Vector3<double>& point) const {
    return frame_.transpose() * (point - origin_);
  }

  void judge() {
    const auto across = [&](std::size_t a, std::size_t b) {
      return std::abs(axes_[a].direction.dot(axes_[b].direction));
    };
    const double arm = std::max(
        {across(0, 1), sine(axes_[1].direction, axes_[2].direction), across(3, 4), across(4, 5)});
    off_wrist_ = off_parallel_ = arm;
    if (!(arm < kNearly)) {
      return;
    }
    const auto [on_5, on_6] = closest(axes_[4], axes_[5]);
    center_ = (on_5 + on_6) / 2;
    const auto gap_to = [&](std::size_t axis) {
      return axes_[axis].direction.cross(center_ - axes_[axis].point).norm() / reach_;
    };
    const double meet = std::max({arm, gap_to(4), gap_to(5)});
    off_wrist_ = std::max(meet, gap_to(3));
    off_parallel_ = std::max(meet, sine(axes_[1].direction, axes_[3].direction));
  }

  /// The root; of a robot not quite of its kind, zero where a share is below zero by so little.
  double root(double share) const {
    return std::sqrt(share < 0 && off() > kInLine && share > -kNearly ? 0 : share);
  }

  /// Angles of joints 2 and 3, both elbows, that bring a point that joint 3 moves, with all joints
  /// at zero at `zero`, to `wanted` in the plane.
  std::vector<std::array<double, 2>> planar(Planar wanted, const Vector3<double>& zero) const {
    const Planar shoulder = in_plane(axes_[1].point);
    const Planar upper_arm = in_plane(axes_[2].point) - shoulder;
    const Planar forearm = in_plane(zero - axes_[2].point);
    const Planar reach = wanted - shoulder;
    const double square = std::norm(reach);
    const double along = (std::norm(upper_arm) - std::norm(forearm) + square) / (2 * square);
    const double height = root(std::norm(upper_arm) / square - along * along);
    std::vector<std::array<double, 2>> pairs;
    for (const double elbow : {1.0, -1.0}) {
      const Planar first = reach * Planar(along, elbow * height) / upper_arm;
      const Planar second = (reach - first * upper_arm) / forearm;
      // From x to z is the negative sense about y.
      if (!std::isnan(height)) {
        pairs.push_back({-std::arg(first), -axes_[2].direction.y() * std::arg(second / first)});
      }
    }
    return pairs;
  }

  /// Joints 4 to 6, both ways, of axes that meet, for a hand that is to turn so from where it is
  /// with them at zero. In line with joint 4, joint 6 turns alone.
  void add_wrists(const Matrix3<double>& hand, Angles q, std::vector<Angles>* all) const {
    const Vector3<double>& axis = axes_[3].direction;
    const Vector3<double>& up = axes_[4].direction;
    const Vector3<double> side = up.cross(axis);
    const Vector3<double>& last = axes_[5].direction;
    const Vector3<double> aim = hand * last;
    const double across = std::hypot(aim.dot(side), aim.dot(up));
    for (const double sign : {1.0, -1.0}) {
      q[3] = across > kInLine ? std::atan2(sign * aim.dot(up), sign * aim.dot(side)) : 0;
      q[4] = std::atan2(sign * across, aim.dot(axis)) - std::atan2(last.dot(side), last.dot(axis));
      add_last((turn(axis, q[3]) * turn(up, q[4])).transpose() * hand, q, all);
    }
  }

  /// Joints 2 to 6 of an arm with joint 4 parallel to 2 and 3, for a hand that is to turn so, and
  /// the point where the last two axes meet, in the plane.
  void add_parallel(const Matrix3<double>& hand, Planar center, Angles q,
                    std::vector<Angles>* all) const {
    const Vector3<double>& last = axes_[5].direction;
    const Vector3<double>& fifth = axes_[4].direction;
    const Vector3<double> aim = hand * last;
    const double start = std::atan2(fifth.cross(last).y(), last.y());
    for (const double sign : {1.0, -1.0}) {
      q[4] = start + sign * std::acos(std::clamp(aim.y(), -1.0, 1.0));
      const Vector3<double> leaning = turn(fifth, q[4]) * last;
      // Joints 2, 3 and 4 together; in line with joint 6 they need not turn.
      const bool is_in_line = std::hypot(aim.x(), aim.z()) < kInLine;
      const double angle = is_in_line ? 0 : -std::arg(in_plane(aim) * std::conj(in_plane(leaning)));
      const Planar fourth = center - std::polar(1.0, -angle) * in_plane(center_ - axes_[3].point);
      for (const std::array<double, 2>& pair : planar(fourth, axes_[3].point)) {
        q[1] = pair[0];
        q[2] = pair[1];
        q[3] = axes_[3].direction.y() * (angle - q[1] - axes_[2].direction.y() * q[2]);
        add_last((turn(Vector3<double>::UnitY(), angle) * turn(fifth, q[4])).transpose() * hand, q,
                 all);
      }
    }
  }

  /// Joint 6, for a hand that is to turn so from where it is with that joint at zero.
  void add_last(const Matrix3<double>& hand, Angles q, std::vector<Angles>* all) const {
    const Vector3<double>& side = axes_[4].direction;
    const Vector3<double> turned = hand * side;
    q[5] = std::atan2(turned.dot(axes_[5].direction.cross(side)), turned.dot(side));
    all->push_back(q);
  }

  Matrix3<double> frame_;
  Vector3<double> origin_;
  std::array<Line, 6> axes_;
  Pose<double> tcp_;
  Vector3<double> center_ = Vector3<double>::Zero();  ///< where the last two axes, or three, meet
  double reach_ = 0;
  double off_wrist_ = 0;
  double off_parallel_ = 0;
};

}  // namespace

std::optional<ClosedForm> solve_closed_form(const RobotModel<double, 6>& model,
                                            const Pose<double>& target) {
  const Arm arm(model);
  if (!(arm.off() < kNearly)) {
    return std::nullopt;
  }
  return ClosedForm{arm.solve(target), arm.off() < kExact};
}

}  // namespace flexcomp::planning
