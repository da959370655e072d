#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "effects/plausible_range.hpp"
#include "simulation/machine.hpp"

/// Physics that a robot's model may lack. A law knows machines, and no recording's residual.
namespace flexcomp::effects {

using simulation::Machine;
using simulation::Prediction;
using simulation::Scene;
using simulation::Simulation;
using simulation::Term;

struct BoundFormula;

/// Values of a law's parameters, SI, in their order.
using Values = std::vector<double>;

/// One number of a law.
struct Parameter {
  std::string name;
  std::string unit;
  bool is_of_recording = false;  ///< no number of the machine: it says how a recording began
};

/// A number that follows from one parameter, and is as uncertain: a spring's whole compliance.
struct Derived {
  std::string name;
  std::string unit;
  double value;
  std::size_t parameter;  ///< index
};

/// The property of a joint that a law's first parameter measures.
enum class Measures { none, stiffness, zero, friction };

/// The part of the instrument that measures the TCP which a law's parameters place: its frame, by a
/// shift (m) and then a rotation vector (rad), or the point on the tool that it follows, by a shift
/// (m).
enum class Registers { nothing, frame, point };

/// Properties of a law, for those who fit, choose and report it.
struct Traits {
  std::size_t linear_in = 0;   ///< the first so many parameters act (nearly) in proportion; all of
                               ///< these zero: no effect
  bool alters_model = false;   ///< the scene must be simulated anew; else the law adds a term
  bool is_curved = false;      ///< far from proportion: derivatives must be taken where it stands
  bool is_curve_only = false;  ///< a curve for want of the law: a law that fits as well is meant
  bool is_gradual = false;     ///< it grows with time, as fast as its last parameter tells: where a
                               ///< jump at one moment does better, it is not meant
  bool is_wave = false;  ///< its first two parameters are the amplitudes of a sine and a cosine
  bool is_body = false;  ///< mass that a link or the flange carries, simplified in its own way
  bool tells_inertia = false;    ///< it says how a mass is spread: with it the joint-space inertia
                                 ///< must stay positive definite
  bool is_clock = false;         ///< a clock of the measurement is late, by its one parameter
  bool is_model_number = false;  ///< a number that every model has: it may stand in for physics
                                 ///< that no law has
  bool is_in_family = false;    ///< every machine has a little of it: fitted together with its like
  bool joins_family = false;    ///< it is tried beside the families when these are fitted
  bool is_friction = false;     ///< one of the forms of a joint's friction: over little of a speed
                                ///< or load they share what they explain
  bool is_gain = false;         ///< it multiplies what all other laws do at its joint
  bool is_of_few = false;       ///< few machines are built so that they can have it
  bool couples_drives = false;  ///< a motor turns with another joint, so that the friction and the
                                ///< rotor that a fit has at its joint act otherwise
  bool can_be_undone =
      true;  ///< it moves the robot, so that a command can undo it; false for what
             ///< only the measurement shows, and for a vibration, which commands feed
  bool needs_temperature = false;  ///< cannot be simulated for a recording without temperatures
  Measures measures = Measures::none;
  Registers registers = Registers::nothing;
};

/// Where a law may act on a machine of so many joints: joints from 1 on, and 0 for all of it.
using Places = std::vector<int> (*)(int joints);

/// A law of physics in one form. Acts at a joint (from 1 on) or on the whole machine (joint 0).
struct Law {
  std::string effect;       ///< its name in robot.yaml and diagnosis.json
  std::string form;         ///< which of the effect's forms; may be empty
  Places joints = nullptr;  ///< where it may act
  Traits traits;
  /// Its parameters; their names may depend on the direction of the joint's axis.
  std::function<std::vector<Parameter>(const model::Robot&, int joint)> parameters;
  /// Ranges of its parameters, each with its source; a parameter without one may be anything.
  std::vector<ParameterRange> ranges;
  /// Excess of the robot that a model became by the law at a joint, given the model's size: how far
  /// it is beyond a body that can be, over the body's own size, counted from `margin` before the
  /// edge. One or more numbers that change smoothly; all are zero where it can be. May be left out.
  std::function<Eigen::VectorXd(const model::Robot& model, const model::Robot& altered,
                                const MachineSize&, int joint, double margin)>
      excess;
  std::string no_body;  ///< why what has an excess cannot be
  /// Why this robot cannot have it at a joint; empty where it can. May be left out.
  std::function<std::string(const model::Robot&, int joint)> impossible;
  /// Gives the machine the effect, beside the effects it has.
  std::function<void(const Values&, int joint, Machine*)> apply;
  /// A term that acts to first order as `apply` does where that alters the model; may be left out.
  std::function<Term(const Values&, int joint)> sketch;
  /// Numbers that follow from the parameters; may be left out.
  std::function<std::vector<Derived>(const model::Robot&, int joint, const Values&)> derived;
  /// Adds the effect to the keys of the robot's file; left out where only the list `effects` says
  /// it.
  std::function<void(const Values&, int joint, model::Robot*)> write_keys;
  bool keys_say_all = false;  ///< the keys need no entry in the list `effects` beside them
  /// The formula, of a law that a person wrote as one (formula_law.hpp), as written and as bound to
  /// the robot; null for all others.
  std::shared_ptr<const model::WrittenLaw> written;
  std::shared_ptr<const BoundFormula> bound;
  std::string words;  ///< what people call the effect; empty where its name says it
  /// One plain clause: what the machine has that the model lacks.
  std::function<std::string(int joint)> statement;
};

using LawPointer = std::shared_ptr<const Law>;

/// An effect by the name that robot.yaml and diagnosis.json have for it, with a law for each form.
struct Effect {
  std::string name;
  std::string words;  ///< of its first law that has them
  std::vector<LawPointer> forms;
  /// Adds what a key of the robot's file says of a joint and only terms can simulate; may be left
  /// out. Not called for a joint of which the list `effects` says more.
  std::function<void(const model::Robot&, int joint, Machine*)> apply_keys;
};

/// Range of a law's parameter at a joint; endless, without a source, where the law does not say.
Range plausible_range(const Law& law, const model::Robot& robot, const MachineSize& size, int joint,
                      const std::string& parameter);

/// Every effect that is known (effects/catalogue.inc).
const std::vector<Effect>& catalogue();

/// A law by its effect and form; null where there is none.
LawPointer find_law(const std::string& effect, const std::string& form);

}  // namespace flexcomp::effects
