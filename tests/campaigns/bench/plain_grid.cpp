#include "plain_grid.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace flexcomp::bench {
namespace {

using Angles = JointVector<double, 6>;

constexpr std::size_t kEvery = 5;  // of the setpoints is looked at

Compliance<double> compliance_at(const RobotModel<double, 6>& robot, const Angles& q) {
  return tcp_compliance(robot, forward_kinematics(robot, q));
}

double largest_stretch(const Matrix3<double>& m) {
  return Eigen::JacobiSVD<Matrix3<double>>(m).singularValues()[0];
}

/// Error of a deflection, for the worst wrench: the larger of m and rad.
double worst_case(const Compliance<double>& error) {
  const auto block = [&](Eigen::Index row, Eigen::Index column) {
    return largest_stretch(error.block<3, 3>(row, column));
  };
  return std::max(block(0, 0) * kForceBound + block(0, 3) * kMomentBound,
                  block(3, 0) * kForceBound + block(3, 3) * kMomentBound);
}

class Trial {
 public:
  Trial(const RobotModel<double, 6>& robot, const GridRange<double> (&ranges)[4], double step)
      : robot_(robot), ranges_(ranges), step_(step) {}

  /// Joint 1 stays where it is: it turns nodes and blend alike.
  Compliance<double> blend(const Angles& q) const {
    std::array<double, 4> corner{};
    std::array<double, 4> share{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const double place = (q[static_cast<Eigen::Index>(axis) + 1] - ranges_[axis].lower) / step_;
      corner[axis] = std::floor(place);
      share[axis] = place - corner[axis];
    }
    Compliance<double> sum = Compliance<double>::Zero();
    for (unsigned which = 0; which < 16; ++which) {
      Angles node = q;
      double weight = 1;
      for (std::size_t axis = 0; axis < 4; ++axis) {
        const bool upper = ((which >> axis) & 1U) != 0;
        weight *= upper ? share[axis] : 1 - share[axis];
        node[static_cast<Eigen::Index>(axis) + 1] =
            ranges_[axis].lower + (corner[axis] + (upper ? 1 : 0)) * step_;
      }
      sum += weight * compliance_at(robot_, node);
    }
    return sum;
  }

  double nodes() const {
    double count = 1;
    for (const GridRange<double>& range : ranges_) {
      count *= std::ceil((range.upper - range.lower) / step_) + 1;
    }
    return count;
  }

 private:
  const RobotModel<double, 6>& robot_;
  const GridRange<double> (&ranges_)[4];
  double step_;
};

bool holds(const MilledCircle& circle, const Trial& grid, double error) {
  for (std::size_t i = 0; i < circle.setpoints.size(); i += kEvery) {
    const Angles& q = circle.setpoints.q[i];
    if (worst_case(grid.blend(q) - compliance_at(circle.robot, q)) > error) {
      return false;
    }
  }
  return true;
}

}  // namespace

void joint_ranges(const MilledCircle& circle, GridRange<double> (*ranges)[4]) {
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const auto joint = static_cast<Eigen::Index>(axis) + 1;
    GridRange<double>& range = (*ranges)[axis];
    range = {circle.program.front()[joint], circle.program.front()[joint]};
    for (const Angles& q : circle.program) {
      range = {std::min(range.lower, q[joint]), std::max(range.upper, q[joint])};
    }
  }
}

PlainGrid coarsest_plain_grid(const MilledCircle& circle, double error) {
  GridRange<double> ranges[4];
  joint_ranges(circle, &ranges);
  constexpr double kFloats = 21;
  for (double step = 0.5;; step *= 0.95) {
    const Trial grid(circle.robot, ranges, step);
    if (holds(circle, grid, error)) {
      return {step, 4 * kFloats * grid.nodes()};
    }
  }
}

}  // namespace flexcomp::bench
