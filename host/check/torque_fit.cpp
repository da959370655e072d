#include "check/torque_fit.hpp"

#include <cmath>

#include "check/arm.hpp"

namespace flexcomp::check {
namespace {

using simulation::Scene;

/// Rows, chosen by judgement: ten for each number that is fitted to them.
constexpr Eigen::Index kFewestTorqueRows = 60;

/// Torques of all joints as the model has them, row by row.
struct ModelTorques {
  Eigen::MatrixXd weight, inertia;  ///< n×joints, N·m
};

ModelTorques model_torques(const model::Robot& robot, const Scene& scene) {
  ModelTorques torques;
  torques.weight.resize(scene.rows(), scene.q.cols());
  torques.inertia.resize(scene.rows(), scene.q.cols());
  const Eigen::RowVectorXd rest = Eigen::RowVectorXd::Zero(scene.q.cols());
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    torques.weight.row(row) = torque_at(robot, scene.q.row(row), rest, rest);
    torques.inertia.row(row) =
        torque_at(robot, scene.q.row(row), scene.velocity.row(row), scene.acceleration.row(row)) -
        torques.weight.row(row);
    for (Eigen::Index joint = 0; joint < scene.q.cols(); ++joint) {
      torques.inertia(row, joint) += robot.dynamics[static_cast<std::size_t>(joint)].rotor_inertia *
                                     scene.acceleration(row, joint);
    }
  }
  return torques;
}

Eigen::MatrixXd wrench_torques(const model::Robot& robot, const Scene& scene) {
  Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(scene.rows(), scene.q.cols());
  for (Eigen::Index row = 0; scene.has_wrench && row < scene.rows(); ++row) {
    torques.row(row) =
        -(jacobian_at(robot, scene.q.row(row)).transpose() * scene.wrench.row(row).transpose())
             .transpose();
  }
  return torques;
}

/// Torques, or where there are none the joints' deflections, which go with them.
simulation::Channel shown_by(const Scene& scene) {
  return scene.has(simulation::joint_torque) ? simulation::joint_torque
                                             : simulation::joint_deflection;
}

TorqueFit fit_torque(const Scene& scene, const ModelTorques& torques,
                     const Eigen::MatrixXd& of_wrench, Eigen::Index joint) {
  const Eigen::MatrixXd& shown = scene.measured[shown_by(scene)];
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    if (std::isfinite(shown(row, joint)) && (scene.is_static || scene.stands(row, joint) == 0)) {
      rows.push_back(row);
    }
  }
  TorqueFit found;
  const auto count = static_cast<Eigen::Index>(rows.size());
  if (count < kFewestTorqueRows) {
    return found;
  }
  Eigen::MatrixXd columns(count, kParts);
  Eigen::VectorXd measured(count);
  double speed = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = rows[static_cast<std::size_t>(i)];
    const double velocity = scene.velocity(row, joint);
    columns.row(i) << torques.weight(row, joint), torques.inertia(row, joint),
        velocity > 0   ? 1
        : velocity < 0 ? -1
                       : 0,
        velocity, 1, of_wrench(row, joint);
    measured[i] = shown(row, joint);
    speed += std::abs(velocity) / static_cast<double>(count);
  }
  found.is_there = true;
  found.fit = regress(columns, measured);
  found.rms = std::sqrt(measured.squaredNorm() / static_cast<double>(count));
  found.friction = found.fit.value[kDry] + speed * found.fit.value[kViscous];
  found.friction_noise =
      std::hypot(found.fit.deviation[kDry], speed * found.fit.deviation[kViscous]);
  return found;
}

}  // namespace

Witnesses witnesses_of(const TorqueFit& torque) {
  // Chosen by judgement: a sign is told of what is a part of the torque at all, of about the size
  // that the model gives it.
  constexpr double kLeastPartial = 0.3;
  constexpr double kLeastSlope = 0.2;
  constexpr double kSure = 8;             // deviations
  constexpr double kLeastFriction = 0.1;  // of the torque
  const auto sign_of = [&](Part part) {
    const double value = torque.fit.value[part];
    return torque.fit.is_told(part, kLeastPartial) && std::abs(value) > kLeastSlope
               ? (value > 0 ? 1 : -1)
               : 0;
  };
  Witnesses witnesses;
  witnesses.weight = sign_of(kWeight);
  witnesses.inertia = sign_of(kInertia);
  const bool is_friction_told = std::abs(torque.friction) > kSure * torque.friction_noise &&
                                std::abs(torque.friction) > kLeastFriction * torque.rms;
  witnesses.friction = is_friction_told ? (torque.friction > 0 ? 1 : -1) : 0;
  return witnesses;
}

double scale_of(const TorqueFit& torque) {
  // Chosen by judgement: weight and inertia agree on a scale better than a factor of 2.5, which
  // masses may be off by; one alone is believed where it is plainer, and off by a unit's size.
  constexpr double kBothTold = 0.6;
  constexpr double kOneTold = 0.7;
  constexpr double kAgree = 2.5;
  constexpr double kFarSmaller = 1.0 / 20;
  const auto value_of = [&](Part part, double least_partial) {
    return torque.fit.is_told(part, least_partial) ? std::abs(torque.fit.value[part]) : 0;
  };
  const double weight = value_of(kWeight, kBothTold);
  const double inertia = value_of(kInertia, kBothTold);
  if (weight > 0 && inertia > 0 && weight < kAgree * inertia && inertia < kAgree * weight) {
    return std::sqrt(weight * inertia);
  }
  for (const Part part : {kInertia, kWeight}) {
    const double one = value_of(part, kOneTold);
    if (one > 0 && one < kFarSmaller) {
      return one;
    }
  }
  return 0;
}

std::vector<TorqueFit> fit_torques(const model::Robot& robot, const Scene& scene) {
  const ModelTorques torques = model_torques(robot, scene);
  const Eigen::MatrixXd of_wrench = wrench_torques(robot, scene);
  std::vector<TorqueFit> fits;
  for (Eigen::Index joint = 0; joint < scene.q.cols(); ++joint) {
    fits.push_back(fit_torque(scene, torques, of_wrench, joint));
  }
  return fits;
}

}  // namespace flexcomp::check
