#include "simulation/machine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "simulation/history.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::simulation {
namespace {

using model::Chain;
using model::ChainJoint;
using model::wrench_torque;
using Row = JointValues;

Row row_of(const Eigen::MatrixXd& matrix, Eigen::Index row) { return matrix.row(row).transpose(); }

void move(const Machine& machine, const Scene& scene, Simulation* at) {
  at->q = scene.q.rowwise() + machine.encoder_offset.transpose();
  at->velocity = scene.velocity;
  at->acceleration = scene.acceleration;
  for (Eigen::Index joint = 0; joint < at->q.cols(); ++joint) {
    const double constant = machine.lag[joint];
    if (constant > 0 && !scene.is_static && scene.follows_command) {
      const Eigen::VectorXd command = at->q.col(joint);
      at->q.col(joint) = lag(scene.time, command, constant);
      at->velocity.col(joint) = (command - at->q.col(joint)) / constant;
      at->acceleration.col(joint) =
          (scene.velocity.col(joint) - at->velocity.col(joint)) / constant;
    }
  }
}

/// The wrench behind what the sensor shows.
void correct_wrench(const Machine& machine, const Scene& scene, Simulation* at) {
  at->wrench = machine.wrench_delay != 0 && !scene.is_static
                   ? delayed_smoothly(scene.time, scene.wrench, -machine.wrench_delay)
                   : scene.wrench;
  if (machine.sensor.empty()) {
    return;
  }
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    const Matrix3<double> tool =
        forward_kinematics(machine.robot.elastic, row_of(at->q, row)).tcp.rotation;
    Wrench<double> wrench;
    wrench << tool.transpose() * at->wrench.row(row).head<3>().transpose(),
        tool.transpose() * at->wrench.row(row).tail<3>().transpose();
    for (const auto& correct : machine.sensor) {
      wrench = correct(wrench);
    }
    at->wrench.row(row) << (tool * wrench.head<3>()).transpose(),
        (tool * wrench.tail<3>()).transpose();
  }
}

Row balance(const Machine& machine, const Row& q) {
  Row torque = Row::Zero(q.size());
  for (const auto& balancer : machine.balancers) {
    torque += balancer(q);
  }
  return torque;
}

Equilibrium settle_balanced(const Machine& machine, const Row& q, const Wrench<double>& wrench,
                            Springs* springs) {
  constexpr double kTolerance = 1e-10;  // rad, m: far below what any sensor sees
  Balance balancers;
  if (!machine.balancers.empty()) {
    balancers = [&machine](const Row& q_link) { return balance(machine, q_link); };
  }
  return settle_from(machine.robot.elastic, q, wrench, kTolerance, springs, balancers);
}

std::string place_in(const Scene& scene, Eigen::Index row) {
  const auto at = static_cast<std::size_t>(row);
  return fmt::format("{}: row {}, under {:.4g} N and {:.4g} N·m: ", scene.file,
                     (at < scene.recorded.size() ? scene.recorded[at] : row) + 1,
                     scene.wrench.row(row).head<3>().norm(),
                     scene.wrench.row(row).tail<3>().norm());
}

/// Where the robot rests, with its levers; `springs`: what they gave in a state nearby, and give in
/// this one.
void rest(const Machine& machine, const Scene& scene, bool levers, Eigen::Index row,
          Springs* springs, Simulation* at) {
  const Chain& elastic = machine.robot.elastic;
  const Wrench<double> wrench = at->wrench.row(row).transpose();
  const Equilibrium equilibrium = settle_balanced(machine, row_of(at->q, row), wrench, springs);
  if (scene.has(tcp_position)) {
    at->prediction.channel[tcp_position].row(row) = equilibrium.tcp.position.transpose();
  }
  if (levers) {
    const auto i = static_cast<std::size_t>(row);
    at->bent[i] = forward_kinematics(elastic, equilibrium.q_link);
    at->jacobian[i] = geometric_jacobian(elastic, at->bent[i]);
    at->compliance[i] = tcp_compliance(elastic, at->bent[i]);
    at->prediction.load.row(row) =
        (wrench_torque(at->jacobian[i], wrench) + weight_torque(elastic, at->bent[i]) +
         balance(machine, equilibrium.q_link))
            .transpose();
  }
}

Row rigid_torque(const Machine& machine, const Simulation& at, const Row& q, Eigen::Index row) {
  return inverse_dynamics(machine.robot, q, row_of(at.velocity, row), row_of(at.acceleration, row));
}

/// Torque that the drives must hold, of wrench and balancers beside the `rigid` one of inertia and
/// weight, at link angles `q`.
Row drive_torque(const Machine& machine, const Scene& scene, const Simulation& at, const Row& rigid,
                 const Row& q, Eigen::Index row) {
  Row held = rigid - balance(machine, q);
  if (!scene.has_wrench) {
    return held;
  }
  const Chain& elastic = machine.robot.elastic;
  const Wrench<double> wrench = at.wrench.row(row).transpose();
  return held - wrench_torque(geometric_jacobian(elastic, forward_kinematics(elastic, q)), wrench);
}

/// Torque of the motors' friction and rotors on the joints.
Row friction(const Machine& machine, const Simulation& at, Eigen::Index row) {
  const model::JointMatrix& transmission = machine.robot.transmission;
  const Row speed = transmission * at.velocity.row(row).transpose();
  const Row acceleration = transmission * at.acceleration.row(row).transpose();
  Row torque(speed.size());
  for (Eigen::Index motor = 0; motor < speed.size(); ++motor) {
    const model::JointDynamics& dynamics = machine.robot.dynamics[static_cast<std::size_t>(motor)];
    torque[motor] = dynamics.viscous * speed[motor] +
                    dynamics.coulomb * direction_of_motion(speed[motor]) +
                    dynamics.rotor_inertia * acceleration[motor];
  }
  return transmission.transpose() * torque;
}

void drive(const Machine& machine, const Scene& scene, const Wanted& wanted, Simulation* at) {
  Prediction& prediction = at->prediction;
  const bool torque = scene.has(joint_torque) && wanted.channel[joint_torque];
  const bool deflection = scene.has(joint_deflection) && wanted.channel[joint_deflection];
  const bool is_known = wanted.rigid != nullptr && wanted.rigid->holds_for(machine);
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    const Row q = row_of(at->q, row);
    const Row rigid = is_known ? wanted.rigid->at(row) : rigid_torque(machine, *at, q, row);
    const Row straight = drive_torque(machine, scene, *at, rigid, q, row);
    if (torque) {
      prediction.channel[joint_torque].row(row) =
          (straight + friction(machine, *at, row)).transpose();
    }
    if (deflection) {
      const Row first = joint_windup(machine.robot.elastic, -straight);
      const Row bent = q + first;
      const Row load =
          -drive_torque(machine, scene, *at, rigid_torque(machine, *at, bent, row), bent, row);
      prediction.dynamic_load.row(row) = load.transpose();
      prediction.channel[joint_deflection].row(row) =
          (q + joint_windup(machine.robot.elastic, load)).transpose() - scene.q.row(row);
    } else if (prediction.dynamic_load.cols() > 0) {
      prediction.dynamic_load.row(row) = -straight.transpose();
    }
  }
}

/// The parts of a scene's simulation to compute; `rigid` and `near`: of each scene, or none.
Wanted wanted_of(const Machine& machine, const Scene& scene, const std::vector<RigidTorque>& rigid,
                 const std::vector<Simulation>& near, std::size_t index, Levers levers) {
  const bool moves_robot = std::any_of(machine.terms.begin(), machine.terms.end(),
                                       [](const Term& each) { return each.moves_robot(); });
  Wanted wanted;
  wanted.levers = levers == Levers::all || machine.needs_levers ||
                  (moves_robot && (scene.has(tcp_position) || scene.has_wrench));
  wanted.rigid = rigid.empty() ? nullptr : &rigid[index];
  wanted.near = near.empty() ? nullptr : &near[index];
  return wanted;
}

}  // namespace

Machine::Machine(model::Robot of)
    : robot(std::move(of)),
      encoder_offset(Row::Zero(robot.joints())),
      lag(Row::Zero(robot.joints())) {}

RigidTorque::RigidTorque(const Machine& machine, const Scene& scene)
    : robot_(machine.robot),
      encoder_offset_(machine.encoder_offset),
      lag_(machine.lag),
      torque_(Eigen::MatrixXd::Zero(scene.rows(), scene.joints())) {
  Simulation at;
  move(machine, scene, &at);
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    torque_.row(row) = rigid_torque(machine, at, row_of(at.q, row), row).transpose();
  }
}

std::vector<RigidTorque> rigid_torques(const Machine& machine, const Scenes& scenes) {
  std::vector<RigidTorque> rigid;
  if (std::none_of(scenes.begin(), scenes.end(), [](const Scene& scene) {
        return scene.has(joint_torque) || scene.has(joint_deflection);
      })) {
    return rigid;
  }
  rigid.reserve(scenes.size());
  for (const Scene& scene : scenes) {
    rigid.emplace_back(machine, scene);
  }
  return rigid;
}

bool RigidTorque::holds_for(const Machine& machine) const {
  const Chain& own = robot_.elastic;
  const Chain& other = machine.robot.elastic;
  const auto is_same = [](const Pose<double>& a, const Pose<double>& b) {
    return a.position == b.position && a.rotation == b.rotation;
  };
  for (std::size_t i = 0; i < own.joints.size(); ++i) {
    const ChainJoint& a = own.joints[i];
    const ChainJoint& b = other.joints[i];
    if (!is_same(a.origin, b.origin) || a.axis != b.axis || a.mass != b.mass ||
        a.center_of_mass != b.center_of_mass ||
        robot_.link_inertia[i] != machine.robot.link_inertia[i]) {
      return false;
    }
  }
  return is_same(own.tool, other.tool) && own.gravity == other.gravity &&
         own.payload_mass == other.payload_mass && own.payload_center == other.payload_center &&
         encoder_offset_ == machine.encoder_offset && lag_ == machine.lag;
}

Simulation simulate(const Machine& machine, const Scene& scene, const Wanted& wanted) {
  Simulation at;
  move(machine, scene, &at);
  correct_wrench(machine, scene, &at);
  const Eigen::Index n = scene.rows();
  for (const Channel channel : {tcp_position, joint_torque, joint_deflection}) {
    at.prediction.channel[channel] = Eigen::MatrixXd::Zero(n, scene.measured[channel].cols());
  }
  const bool moves = scene.has(joint_torque) || scene.has(joint_deflection);
  at.prediction.load = Eigen::MatrixXd::Zero(n, scene.joints());
  at.prediction.dynamic_load = Eigen::MatrixXd::Zero(n, moves ? scene.joints() : 0);
  at.joint_compliance.resize(scene.joints());
  for (Eigen::Index joint = 0; joint < scene.joints(); ++joint) {
    at.joint_compliance[joint] = machine.robot.elastic.joint(joint).compliance;
  }
  if (wanted.levers) {
    at.bent.resize(static_cast<std::size_t>(n));
    at.jacobian.resize(static_cast<std::size_t>(n));
    at.compliance.resize(static_cast<std::size_t>(n));
  }
  if (wanted.levers || (wanted.channel[tcp_position] && scene.has(tcp_position))) {
    const bool has_near = wanted.near != nullptr && !wanted.near->springs.empty();
    at.springs.reserve(static_cast<std::size_t>(n));
    Springs springs(machine.robot.elastic);
    for (Eigen::Index row = 0; row < n; ++row) {
      if (has_near) {
        springs = wanted.near->springs[static_cast<std::size_t>(row)];
      }
      try {
        rest(machine, scene, wanted.levers, row, &springs, &at);
      } catch (const NoRest& error) {
        throw NoRest(place_in(scene, row) + error.what());
      }
      at.springs.push_back(springs);
    }
  }
  if (machine.shows_motor_torques) {
    at.to_shown = machine.robot.transmission.inverse().transpose();
  }
  if (moves &&
      (wanted.levers || wanted.channel[joint_torque] || wanted.channel[joint_deflection])) {
    drive(machine, scene, wanted, &at);
  }
  return at;
}

int direction_of_motion(double speed) {
  constexpr double kStanding = 1e-4;  // rad/s
  return speed > kStanding ? 1 : (speed < -kStanding ? -1 : 0);
}

Prediction with_terms(const std::vector<Term>& terms, const Scene& scene,
                      const Simulation& simulation) {
  Prediction prediction = simulation.prediction;
  for (const Term::Stage stage :
       {Term::wrench, Term::load, Term::output, Term::instrument, Term::clock}) {
    Eigen::MatrixXd& torque = prediction.channel[joint_torque];
    if (stage == Term::instrument && simulation.to_shown.rows() > 0 && torque.cols() > 0) {
      torque = (torque * simulation.to_shown.transpose()).eval();
    }
    for (const Term& term : terms) {
      if (term.stage == stage) {
        term.add(scene, simulation, &prediction);
      }
    }
  }
  return prediction;
}

std::vector<Prediction> with_terms(const std::vector<Term>& terms, const Scenes& scenes,
                                   const std::vector<Simulation>& simulations) {
  std::vector<Prediction> predictions;
  predictions.reserve(scenes.size());
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    predictions.push_back(with_terms(terms, scenes[s], simulations[s]));
  }
  return predictions;
}

std::vector<Simulation> simulate(const Machine& machine, const Scenes& scenes,
                                 const std::vector<RigidTorque>& rigid, Levers levers,
                                 const std::vector<Simulation>& near) {
  std::vector<Simulation> simulations;
  simulations.reserve(scenes.size());
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    simulations.push_back(
        simulate(machine, scenes[s], wanted_of(machine, scenes[s], rigid, near, s, levers)));
  }
  return simulations;
}

std::vector<Prediction> predict(const Machine& machine, const Scenes& scenes,
                                const std::vector<RigidTorque>& rigid,
                                const std::vector<Simulation>& near) {
  std::vector<Prediction> predictions;
  predictions.reserve(scenes.size());
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const Wanted wanted = wanted_of(machine, scenes[s], rigid, near, s, Levers::of_terms);
    predictions.push_back(
        with_terms(machine.terms, scenes[s], simulate(machine, scenes[s], wanted)));
  }
  return predictions;
}

void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     const Eigen::VectorXd& dynamic, Prediction* prediction) {
  const Eigen::Index column = joint - 1;
  Eigen::MatrixXd& position = prediction->channel[tcp_position];
  for (Eigen::Index row = 0; row < position.rows() && position.cols() > 0; ++row) {
    position.row(row) +=
        angle[row] *
        simulation.jacobian[static_cast<std::size_t>(row)].block<3, 1>(0, column).transpose();
  }
  if (prediction->channel[joint_deflection].cols() > 0) {
    prediction->channel[joint_deflection].col(column) += dynamic;
  }
}

void add_wrench(const Simulation& simulation, const Eigen::MatrixXd& change,
                Prediction* prediction) {
  for (Eigen::Index row = 0; row < change.rows(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    const Wrench<double> wrench = change.row(row).transpose();
    const Eigen::RowVectorXd load = (simulation.jacobian[i].transpose() * wrench).transpose();
    prediction->load.row(row) += load;
    if (prediction->dynamic_load.cols() > 0) {
      prediction->dynamic_load.row(row) += load;
    }
    if (prediction->channel[tcp_position].cols() > 0) {
      prediction->channel[tcp_position].row(row) +=
          (simulation.compliance[i].topRows<3>() * wrench).transpose();
    }
    if (prediction->channel[joint_torque].cols() > 0) {
      prediction->channel[joint_torque].row(row) -= load;
    }
    if (prediction->channel[joint_deflection].cols() > 0) {
      prediction->channel[joint_deflection].row(row) +=
          load.cwiseProduct(simulation.joint_compliance.transpose());
    }
  }
}

}  // namespace flexcomp::simulation
