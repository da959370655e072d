#include "diagnosis/search/search.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::diagnosis {

bool sees_angles(const Observations& observations) {
  return observations.has(simulation::tcp_position) ||
         observations.has(simulation::joint_deflection);
}

bool sees_moving_torques(const Observations& observations) {
  return observations.has(simulation::joint_torque) && !observations.is_static;
}

bool is_loaded(const Observations& observations) {
  return observations.has_wrench() || observations.has_weight();
}

double torque_step(const Observations& observations, int joint, double least) {
  return std::max(0.02 * observations.largest_torque(joint), least);
}

std::vector<Values> starts_at(const std::vector<double>& shares, double size) {
  std::vector<Values> starts;
  for (const double share : shares) {
    starts.push_back({share * size});
  }
  return starts;
}

std::vector<Values> ripple_orders(const Observations& observations, int joint,
                                  const std::vector<JointResidual>& residual) {
  // Periods a turn, chosen by judgement: a strain-wave gear errs twice a turn of its motor, and
  // usual ones reduce by 160 at most. tools/score-diagnosis draws orders up to 200.
  constexpr double kMostOrder = 330;
  constexpr std::size_t kMost = 3;  // starts: an effect beside may hide the highest peak
  const double range = observations.range(joint);
  if (range < 0.02) {
    return {};
  }
  const double spacing = std::max(0.5, M_PI / 3 / range);
  std::vector<std::pair<double, double>> found;  // sum of squares left, order
  for (double order = std::max(3.0, 2 * 2 * M_PI / range); order < kMostOrder; order += spacing) {
    // Least squares of sine, cosine and a constant (Lomb 1976, with weights).
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < residual.size(); ++s) {
      const auto q = observations.simulations[s].q.col(joint - 1);
      for (Eigen::Index row = 0; row < q.size(); ++row) {
        const double weight = residual[s].weight[row];
        if (weight > 0) {
          const Eigen::Vector3d basis(std::sin(order * q[row]), std::cos(order * q[row]), 1);
          gram += weight * basis * basis.transpose();
          moment += residual[s].product[row] * basis;
        }
      }
    }
    const double level = gram(2, 2) > 0 ? moment[2] * moment[2] / gram(2, 2) : 0;
    found.emplace_back(level - moment.dot(gram.ldlt().solve(moment)), order);
  }
  std::sort(found.begin(), found.end());
  std::vector<Values> orders;
  for (const std::pair<double, double>& each : found) {
    const double order = each.second;
    const bool is_new = std::all_of(orders.begin(), orders.end(), [&](const Values& other) {
      return std::abs(other[0] - order) > 2.5 * spacing;
    });
    if (is_new && orders.size() < kMost && std::isfinite(each.first)) {
      orders.push_back({order});
    }
  }
  return orders;
}

}  // namespace flexcomp::diagnosis
