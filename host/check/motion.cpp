#include "check/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "statistics/quantile.hpp"

namespace flexcomp::check {

bool moves_smoothly(const recording::Samples& q) {
  constexpr Eigen::Index kMost = 1500;  // rows that are looked at
  constexpr double kSmooth = 0.35;      // of a step, by which the next one differs
  constexpr double kMoves = 1e-4;       // of the range, a row
  constexpr double kMoving = 0.2;       // of the quick steps
  const Eigen::Index stride = std::max<Eigen::Index>(1, q.rows() / kMost);
  const Eigen::RowVectorXd range = ranges(q);
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    std::vector<double> first;
    std::vector<double> second;
    for (Eigen::Index row = 2 * stride; row < q.rows(); row += stride) {
      const double step = q(row, joint) - q(row - stride, joint);
      const double before = q(row - stride, joint) - q(row - 2 * stride, joint);
      if (std::isfinite(step) && std::isfinite(before)) {
        first.push_back(std::abs(step));
        second.push_back(std::abs(step - before));
      }
    }
    const double quick = statistics::quantile(first, 0.95);
    std::vector<double> change;  // of the step, over it, where the joint moves
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] > kMoving * quick) {
        change.push_back(second[i] / first[i]);
      }
    }
    if (change.size() > 20 && quick > kMoves * range[joint] &&
        statistics::quantile(change, 0.5) < kSmooth) {
      return true;
    }
  }
  return false;
}

Eigen::RowVectorXd usual_top_speed(const Eigen::VectorXd& time, const recording::Samples& q) {
  const Eigen::Index window = std::clamp<Eigen::Index>(q.rows() / 200, 1, 20);
  Eigen::RowVectorXd speeds = Eigen::RowVectorXd::Zero(q.cols());
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    std::vector<double> all;
    for (Eigen::Index row = window; row < q.rows(); ++row) {
      const double speed =
          std::abs(q(row, joint) - q(row - window, joint)) / (time[row] - time[row - window]);
      if (std::isfinite(speed)) {
        all.push_back(speed);
      }
    }
    speeds[joint] = statistics::quantile(std::move(all), 0.95);
  }
  return speeds;
}

Eigen::RowVectorXd ranges(const recording::Samples& samples) {
  Eigen::RowVectorXd range = Eigen::RowVectorXd::Zero(samples.cols());
  for (Eigen::Index column = 0; column < samples.cols(); ++column) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (Eigen::Index row = 0; row < samples.rows(); ++row) {
      if (std::isfinite(samples(row, column))) {
        least = std::min(least, samples(row, column));
        most = std::max(most, samples(row, column));
      }
    }
    range[column] = most >= least ? most - least : 0;
  }
  return range;
}

}  // namespace flexcomp::check
