#pragma once

#include <functional>
#include <vector>

#include "model/chain_kinematics.hpp"
#include "model/robot.hpp"
#include "simulation/quasi_static.hpp"
#include "simulation/scene.hpp"

namespace flexcomp::simulation {

using model::JointValues;

/// The recording that should be, by channel (n×3 m; N·m and rad, a column a joint), and the loads
/// behind it.
struct Prediction {
  std::array<Eigen::MatrixXd, 3> channel;  ///< no columns where the scene does not have it
  Eigen::MatrixXd load;          ///< N·m, torque of wrench and weight on each joint's spring
  Eigen::MatrixXd dynamic_load;  ///< the same with inertia; no columns without that channel
};

/// A machine along a scene: motion, levers and springs at every row, and what follows from them.
/// Where there is one number a joint, a joint that slides has m and N.
struct Simulation {
  Eigen::MatrixXd q;             ///< a column a joint, motors as the machine has them, rad
  Eigen::MatrixXd velocity;      ///< rad/s
  Eigen::MatrixXd acceleration;  ///< rad/s²
  Eigen::MatrixXd wrench;        ///< n×6, on the tool, as the machine's sensor is believed
  std::vector<model::ChainKinematics> bent;    ///< links and TCP of the robot at rest under load
  std::vector<model::ChainJacobian> jacobian;  ///< of the TCP, bent
  std::vector<Compliance<double>> compliance;  ///< at the TCP, bent
  std::vector<Springs> springs;                ///< what they give at rest, where that was sought
  JointValues joint_compliance;                ///< rad/(N·m)
  model::JointMatrix to_shown;                 ///< torques of the joints to those that are shown;
                                               ///< no rows where they are the joints'
  Prediction prediction;                       ///< of everything but the terms
};

/// Physics that adds to what a rigid robot on springs does, in the order in which it acts.
struct Term {
  enum Stage { wrench, load, output, instrument, clock };
  Stage stage;
  std::function<void(const Scene&, const Simulation&, Prediction*)> add;

  /// What only an instrument or a clock shows needs no levers.
  bool moves_robot() const { return stage < instrument; }
};

/// A machine as it is believed to be: its model, and physics that the model has no keys for.
struct Machine {
  Machine() = default;
  explicit Machine(model::Robot of);

  model::Robot robot;
  JointValues encoder_offset;  ///< rad, q = reading + it
  JointValues lag;             ///< s, behind the command
  double wrench_delay = 0;     ///< s, by which the force sensor is late
  /// The wrench that the force sensor's readings stand for, tool frame, one correction after
  /// another.
  std::vector<std::function<Wrench<double>(const Wrench<double>& read)>> sensor;
  /// Torques (N·m) in parallel to the drives, by the joint angles: gravity compensators.
  std::vector<std::function<JointValues(const JointValues& q)>> balancers;
  std::vector<Term> terms;
  /// The torques shown are the motors', (transmission⁻¹)ᵀ times the joints'.
  bool shows_motor_torques = false;
  bool needs_levers = false;  ///< a term follows where the TCP is, or the loads at rest
};

/// Torques (N·m) of inertia and weight in a scene, with straight springs: what of a simulation
/// costs most, and stays while geometry, masses and motion do.
class RigidTorque {
 public:
  RigidTorque(const Machine& machine, const Scene& scene);

  bool holds_for(const Machine& machine) const;
  JointValues at(Eigen::Index row) const { return torque_.row(row).transpose(); }

 private:
  model::Robot robot_;
  JointValues encoder_offset_;
  JointValues lag_;
  Eigen::MatrixXd torque_;
};

/// The rigid-body torques of each scene; none where no scene shows torques or deflections of
/// joints.
std::vector<RigidTorque> rigid_torques(const Machine& machine, const Scenes& scenes);

/// Which channels to simulate; levers and springs are kept only with `levers`.
struct Wanted {
  std::array<bool, 3> channel = {true, true, true};
  bool levers = true;
  const RigidTorque* rigid = nullptr;  ///< of the same scene; used where it holds for the machine
  /// Of the same scene by a machine not far off: where its springs rest, theirs are sought first.
  const Simulation* near = nullptr;
};

/// Simulates a scene of as many joints without the machine's terms. TCP position: forward
/// kinematics and the elastic deflection under wrench and weight (Klimchik et al. 2017). Torque:
/// rigid-body inverse dynamics (recursive Newton–Euler), friction and rotor inertia, less
/// Jᵀ·wrench. Joint deflection: wind-up under the torque at the link, inertia included.
Simulation simulate(const Machine& machine, const Scene& scene, const Wanted& wanted = {});

/// The simulation's prediction with terms added in the order of their stages. What instruments show
/// of torques is what is shown of them, the joints' or the motors'.
Prediction with_terms(const std::vector<Term>& terms, const Scene& scene,
                      const Simulation& simulation);

/// Predictions of the simulations of scenes, each with the terms added.
std::vector<Prediction> with_terms(const std::vector<Term>& terms, const Scenes& scenes,
                                   const std::vector<Simulation>& simulations);

/// Levers that simulations of scenes keep: all, or only those that the machine's terms need to move
/// a TCP or a wrench.
enum class Levers { all, of_terms };

/// Simulates scenes without the machine's terms. `rigid` and `near`: of these scenes and perhaps
/// others behind them, or none, as in Wanted.
std::vector<Simulation> simulate(const Machine& machine, const Scenes& scenes,
                                 const std::vector<RigidTorque>& rigid, Levers levers,
                                 const std::vector<Simulation>& near = {});

/// Predictions of a machine for scenes, with its terms; `rigid` and `near` as above. Keeps no
/// simulation.
std::vector<Prediction> predict(const Machine& machine, const Scenes& scenes,
                                const std::vector<RigidTorque>& rigid = {},
                                const std::vector<Simulation>& near = {});

/// 1, −1, or 0 at speeds (rad/s) below any programmed motion, where only noise has a sign.
int direction_of_motion(double speed);

/// Adds an angle (n, rad) by which a joint stands elsewhere on its link side, to first order.
/// `dynamic` is what the link encoder sees of it.
void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     const Eigen::VectorXd& dynamic, Prediction* prediction);

/// Adds a change of the wrench (n×6, base frame), to first order.
void add_wrench(const Simulation& simulation, const Eigen::MatrixXd& change,
                Prediction* prediction);

}  // namespace flexcomp::simulation
