#pragma once

#include <optional>
#include <string>

#include "simulation/machine.hpp"

/// Signals of a machine that a law's formula may name.
namespace flexcomp::effects {

using simulation::Prediction;
using simulation::Scene;
using simulation::Simulation;

enum class SignalKind {
  angle,         ///< q1…: joint angle, motor side
  speed,         ///< v1…
  acceleration,  ///< a1…
  torque,        ///< tau1…: of the drive, without friction
  load,          ///< load1…: of wrench and weight on the joint's spring, at rest
  wrench,        ///< fx fy fz mx my mz: on the tool, at the TCP, base frame
  tool_wrench,   ///< fx_tool … mz_tool: the same, tool frame
  position,      ///< x y z: the TCP of the bent robot, base frame
  temperature,   ///< temp_c
  time,          ///< t: since the recording's first row
};

/// A signal of one robot.
struct Signal {
  SignalKind kind;
  int index = 0;  ///< of the joint (from 1 on), or of the component (from 0 on)
  std::string unit;
  std::string words;  ///< "the speed of joint 5"
};

/// A signal by its name; nothing where this robot has none of it.
std::optional<Signal> find_signal(const model::Robot& robot, const std::string& name);

/// The names of all, for messages.
std::string signal_names(const model::Robot& robot);

/// The load that signals of load show: at rest, or with inertia as far as it is known.
enum class Loads { at_rest, with_inertia };

/// A signal's values, one a row. `prediction` holds the loads so far; `since`: the time (s) that
/// counts as zero. Needs the scene's levers for loads and positions.
Eigen::VectorXd values_of(const Signal& signal, const Scene& scene, const Simulation& at,
                          const Prediction& prediction, Loads loads, double since);

}  // namespace flexcomp::effects
