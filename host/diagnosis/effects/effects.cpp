#include "diagnosis/effects/effects.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::diagnosis {

bool sees_angles(const Observations& observations) {
  return observations.has(simulation::tcp_position) ||
         observations.has(simulation::joint_deflection);
}

void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     Prediction* prediction) {
  simulation::add_joint_angle(simulation, joint, angle, angle, prediction);
}

void add_load_driven(const Simulation& simulation, int joint,
                     const std::function<Eigen::VectorXd(const Eigen::VectorXd& load)>& series,
                     Prediction* prediction) {
  const Eigen::VectorXd at_rest = series(prediction->load.col(joint - 1));
  const bool by_motion = prediction->channel[simulation::joint_deflection].cols() > 0;
  simulation::add_joint_angle(simulation, joint, at_rest,
                              by_motion ? series(prediction->dynamic_load.col(joint - 1)) : at_rest,
                              prediction);
}

Eigen::VectorXd ripple(const Simulation& simulation, int joint, const Values& values) {
  const Eigen::ArrayXd wave = values[2] * simulation.q.col(joint - 1).array();
  return values[0] * wave.sin() + values[1] * wave.cos();
}

void add_torque(int joint, const Eigen::VectorXd& torque, Prediction* prediction) {
  if (prediction->channel[simulation::joint_torque].cols() > 0) {
    prediction->channel[simulation::joint_torque].col(joint - 1) += torque;
  }
}

void set_sensor(SensorModel truth, Hypothesis* hypothesis) {
  hypothesis->alters_model = true;
  hypothesis->apply = [truth](const Values& values, Machine* machine) {
    machine->sensor.emplace_back([=](const Wrench<double>& read) { return truth(values, read); });
  };
  hypothesis->sketch = [truth](const Values& values) {
    return simulation::Term{
        simulation::Term::wrench, [=](const Scene&, const Simulation& at, Prediction* prediction) {
          Eigen::MatrixXd change(at.wrench.rows(), 6);
          for (Eigen::Index row = 0; row < change.rows(); ++row) {
            const Matrix3<double>& tool = at.bent[static_cast<std::size_t>(row)].tcp.rotation;
            Wrench<double> read;
            read << tool.transpose() * at.wrench.row(row).head<3>().transpose(),
                tool.transpose() * at.wrench.row(row).tail<3>().transpose();
            const Wrench<double> gap = truth(values, read) - read;
            change.row(row) << (tool * gap.head<3>()).transpose(),
                (tool * gap.tail<3>()).transpose();
          }
          add_wrench(at, change, prediction);
        }};
  };
}

std::vector<Values> ripple_orders(const Observations& observations, int joint,
                                  const std::vector<JointResidual>& residual) {
  constexpr double kMostOrder = 330;
  constexpr std::size_t kMost = 3;
  const double range = observations.range(joint);
  if (range < 0.02) {
    return {};
  }
  const double spacing = std::max(0.5, M_PI / 3 / range);
  std::vector<std::pair<double, double>> found;  // less what is explained, order
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
