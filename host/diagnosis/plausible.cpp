#include "diagnosis/plausible.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "diagnosis/fit.hpp"
#include "simulation/inverse_dynamics.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kGravity = 9.81;         // m/s²
constexpr double kLargestPayload = 2300;  // kg, of the strongest arm that is sold (data sheet)
constexpr double kAluminium = 23e-6;      // 1/K, growth of the lightest material of arms
constexpr double kSpringTurn = 0.1;       // rad, under the load that it bore
constexpr double kLinkTurn = 0.02;        // rad, under the load that it bore
constexpr double kShiftOfReach = 0.05;    // of the reach, under the load that it bore
constexpr double kMostTurn = 0.1;         // rad/(N·m), of springs that are made soft on purpose
constexpr double kMostShift = 0.01;       // m/N, ten times as soft as rubber feet
constexpr double kSmallestShare = 0.01;   // of a spring's compliance, of one in the other
constexpr double kLostMass = 0.8;         // of a link's mass
constexpr double kAddedMass = 2;          // times a link's mass
constexpr double kLeastLink = 0.2;        // of the reach, about a joint: the size of a link there
constexpr double kRestTolerance = 1e-3;   // of a parameter's step
constexpr double kFullyPositive = 1e-9;   // of the largest eigenvalue
constexpr Eigen::Index kPostures = 10;    // of a scene in which the inertia matrix is looked at

/// A parameter of an effect at a place on a robot.
struct Subject {
  const model::Robot& robot;
  const MachineSize& size;
  const Hypothesis& hypothesis;
  const std::string& parameter;

  std::size_t index() const { return static_cast<std::size_t>(std::max(hypothesis.joint, 1) - 1); }
  const Joint<double>& joint() const { return robot.elastic.joints[index()]; }
  const model::JointDynamics& dynamics() const { return robot.dynamics[index()]; }
  double effort() const { return size.effort[index()]; }
  double velocity() const { return size.velocity[index()]; }
  double load() const { return size.load[index()]; }
  double largest_load() const { return *std::max_element(size.load.begin(), size.load.end()); }
};

/// Endless where either is not known.
double over(double value, double divisor) {
  return divisor > 0 && std::isfinite(value) && std::isfinite(divisor) ? value / divisor : kEndless;
}

/// Compliance with which a spring gives by `most` under a load, or the softest of any where that is
/// less.
double softest(double of_any, double most, double load) {
  return std::min(over(most, load), of_any);
}

Range within(double size) { return {-size, size}; }
Range up_to(double most) { return {0, most, Rest::below}; }
Range change(double known, double most) { return {-known, most - known, Rest::below}; }

Range base_shift(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(of.parameter.back() - 'x');
  return change(
      of.robot.elastic.base_compliance[axis],
      softest(kMostShift, kShiftOfReach * of.size.reach, std::max(of.size.weight, of.size.force)));
}

Range base_turn(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(3 + of.parameter.back() - 'x');
  return change(
      of.robot.elastic.base_compliance[axis],
      softest(kMostTurn, kSpringTurn, std::max(0.5 * of.size.weight_torque, of.largest_load())));
}

Range tool_shift(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(of.parameter.back() - 'x');
  return change(of.robot.elastic.tool_compliance[axis],
                softest(kMostShift, kShiftOfReach * of.size.reach, of.size.force));
}

Range joint_spring(const Subject& of) {
  const double known = of.joint().compliance;
  const double most = softest(kMostTurn, kSpringTurn, of.load());
  if (!(known > 0)) {
    return up_to(most);
  }
  return {(kSmallestShare - 1) * known, std::min(most, known / kSmallestShare) - known};
}

/// Wind-up c1 τ + c3 τ³ that does not turn back, nor is beyond tenfold, under the largest load.
Range cubic_spring(const Subject& of) {
  const double load = std::max(of.load(), 1.0);
  const double straight = of.joint().compliance / (load * load);
  const double known = of.joint().cubic_compliance;
  return {-straight / 3 - known, std::min(10 * straight, kMostTurn) - known};
}

double largest_mounted(const Subject& of) {
  return std::max(kAddedMass * of.joint().mass, of.size.payload);
}

double link_size(const model::Robot& robot, const MachineSize& size, std::size_t index) {
  const RobotModel<double, 6>& elastic = robot.elastic;
  const Pose<double>& end =
      index + 1 < elastic.joints.size() ? elastic.joints[index + 1].origin : elastic.tool;
  return std::max({end.position.norm(), kLeastLink * size.reach,
                   1.5 * elastic.joints[index].center_of_mass.norm()});
}

Range link_length(const Subject& of) {
  const double length =
      of.robot.elastic.joints[std::min<std::size_t>(of.index() + 1, 5)].origin.position.norm();
  return within(std::max(0.5 * length, 0.02 * of.size.reach));
}

/// A range for parameters of an effect.
struct Row {
  const char* effect;
  const char* parameters;  ///< names, each with a space before and behind it
  Range (*range)(const Subject&);
  const char* source;
};

constexpr const char* kXyz = " x y z ";

const Row kTable[] = {
    {"backlash", " gap ", [](const Subject&) { return up_to(0.01); },
     "gears' data sheets: 1 arcmin (cycloidal) to 20 arcmin (spur gears of servos), and wear"},
    {"backlash", " hold ", [](const Subject& of) { return up_to(of.effort()); },
     "a drag beyond the drive's largest torque would hold the joint"},
    {"base_compliance", kXyz, base_shift,
     "a foundation that gives by a twentieth of the reach under the arm's weight holds no robot"},
    {"base_compliance", " rx ry rz ", base_turn,
     "a foundation that tips by 0.1 rad under the arm's weight holds no robot"},
    {"base_frame", kXyz, [](const Subject&) { return within(80); },
     "laser trackers' data sheets: they reach 80 m"},
    {"base_frame", " rx ry rz ", [](const Subject&) { return within(M_PI); },
     "any turn is one by at most half a revolution"},
    {"coulomb_friction", " torque ",
     [](const Subject& of) { return change(of.dynamics().coulomb, of.effort()); },
     "friction does not drive, and a joint moves that its drive can move"},
    {"friction_hysteresis", " torque ", [](const Subject& of) { return up_to(of.effort()); },
     "friction does not drive, and a joint moves that its drive can move"},
    {"friction_hysteresis", " slip ", [](const Subject&) { return up_to(0.1); },
     "friction of contacts and belts is built up within some degrees of turning back (Al-Bender "
     "and Swevers 2008); built up at once it is dry friction"},
    {"friction_hysteresis", " gap ", [](const Subject&) { return up_to(0.1); },
     "brakes, belts and seals grip within some degrees of turning back; no gear's teeth are meant"},
    {"gravity_compensator", " stiffness_torque pull_torque ",
     [](const Subject& of) { return within(10 * of.size.weight_torque); },
     "a balancer holds about the arm's weight; its preload and rate may work against each other"},
    {"gravity_compensator", " sine_torque cosine_torque ",
     [](const Subject& of) { return within(3 * of.size.weight_torque); },
     "a balancer holds about the arm's weight"},
    {"gravity_compensator", " anchor_ratio ",
     [](const Subject&) {
       return Range{0, 1, Rest::below};
     },
     "anchored at the same distance twice it would fold; near the axis its torque is a sine"},
    {"gravity_compensator", " zero_angle ",
     [](const Subject&) {
       return Range{-4, 4, Rest::both};
     },
     "any angle is one of half a revolution either way"},
    {"hysteresis", " amplitude ", [](const Subject&) { return up_to(0.01); },
     "as the gap of backlash: gears' data sheets give both as lost motion"},
    {"hysteresis", " yield_torque ",
     [](const Subject& of) {
       return Range{0, of.effort()};
     },
     "friction beyond the drive's largest torque would hold the joint"},
    {"joint_axis", " tilt_x tilt_y tilt_z ", [](const Subject&) { return within(0.1); },
     "an axis 6° askew is another machine; castings are machined to minutes of arc"},
    {"joint_offset", " offset ", [](const Subject&) { return within(M_PI); },
     "an encoder may be set to zero anywhere"},
    {"joint_stiffness", " compliance_change ", joint_spring,
     "no gear is rigid, none a hundred times softer than was measured of its kind, and none winds "
     "up "
     "by 0.1 rad under what it bears (series elastic actuators do, Pratt and Williamson 1995)"},
    {"link_flexibility", " bending_x bending_y bending_z beam ",
     [](const Subject& of) { return up_to(softest(kMostTurn, kLinkTurn, of.largest_load())); },
     "a slender aluminium link that bends by 0.02 rad is strained to half of what it yields at "
     "(yield "
     "strain 0.4 %, five times as long as high): no arm is built so"},
    {"link_length", " length ", link_length,
     "with half of its length more or less a link is that of another robot"},
    {"nonlinear_stiffness", " cubic_compliance ", cubic_spring,
     "more torque winds up more: a curve that turns back stores no energy"},
    {"payload", " mass ",
     [](const Subject& of) {
       const double known = of.robot.elastic.payload_mass;
       return Range{-known, of.size.payload - known};
     },
     "data sheets: no arm carries more than it moves of itself, and no mass is negative"},
    {"payload", " mx my mz ",
     [](const Subject& of) { return within(0.5 * of.size.payload * of.size.reach); },
     "what the flange carries lies within half of the arm's reach from it"},
    {"resonance", " frequency ",
     [](const Subject&) {
       return Range{1, 300};
     },
     "arms' lowest modes are at 2 to 60 Hz (Abele, Weigold and Rothenbuecher 2007)"},
    {"resonance", " stiffness ",
     [](const Subject&) {
       return Range{0, kEndless};
     },
     "a spring pulls back; its size follows from the frequencies above"},
    {"resonance", " damping ",
     [](const Subject&) {
       return Range{0, 0.5};
     },
     "steel and gears damp by 0.002 to 0.2; beyond 0.5 nothing swings"},
    {"rotor_inertia", " inertia ",
     [](const Subject& of) { return change(of.dynamics().rotor_inertia, of.effort()); },
     "a drive whose largest torque moves its own rotor by 1 rad/s² moves no arm"},
    {"servo_lag", " time_constant ", [](const Subject&) { return up_to(1); },
     "position loops close at 1 to 20 Hz; none is slower than a second"},
    {"stribeck_friction", " excess ", [](const Subject& of) { return up_to(of.effort()); },
     "a joint starts that its drive can move"},
    {"stribeck_friction", " speed ",
     [](const Subject& of) {
       return Range{0, of.velocity()};
     },
     "friction falls within the joint's speeds"},
    {"tcp_offset", kXyz, [](const Subject& of) { return within(0.5 * of.size.reach); },
     "no tool is longer than half of the arm's reach"},
    {"time_offset", " delay ", [](const Subject&) { return within(10); },
     "loggers' clocks are set by hand or by a network: to seconds, or far better"},
    {"tool_compliance", kXyz, tool_shift,
     "a tool that gives by a twentieth of the arm's reach under the force it bore is broken"},
    {"torque_offset", " torque ", [](const Subject& of) { return within(of.effort()); },
     "a current sensor's zero lies within what it is made to measure"},
    {"torque_ripple", " sine cosine ", [](const Subject& of) { return within(of.effort()); },
     "a joint turns past a ripple that its drive can move"},
    {"transmission_ripple", " sine cosine ", [](const Subject&) { return within(0.01); },
     "gears' data sheets: transmission errors of 0.3 to 5 arcmin; 10 mrad are 34"},
    {"torque_ripple", " order ",
     [](const Subject&) {
       return Range{0, 1e4};
     },
     "pole pairs times slots times a gear ratio of some hundred"},
    {"transmission_ripple", " order ",
     [](const Subject&) {
       return Range{0, 1e4};
     },
     "teeth times a gear ratio of some hundred"},
    {"viscous_friction", " coefficient forward backward ",
     [](const Subject& of) {
       return change(of.dynamics().viscous, over(of.effort(), 0.1 * of.velocity()));
     },
     "friction does not drive, nor take the drive's largest torque at a tenth of its speed"},
    {"wrench_bias", " fx fy fz ",
     [](const Subject& of) { return within(2 * of.size.payload * kGravity); },
     "force sensors' data sheets: ranges of once to twice the weight that their robots carry"},
    {"wrench_bias", " mx my mz ",
     [](const Subject& of) {
       const double wrist = std::max({of.size.effort[3], of.size.effort[4], of.size.effort[5]});
       return within(std::min(wrist, 0.5 * of.size.payload * kGravity * of.size.reach));
     },
     "force sensors' data sheets: ranges of about the torques that their robots' wrists bear"},
    {"wrench_frame", " rx ry rz ",
     [](const Subject&) {
       return Range{-3.2, 3.2, Rest::both};
     },
     "any turn is one by at most half a revolution"},
    {"wrench_scale", " gain_error ",
     [](const Subject&) {
       return Range{-0.95, 10};
     },
     "the farthest unit of force is the kilogram-force, 9.81 N"},
};

/// What depends on the form of an effect.
const Row kTableOfForms[] = {
    {"link_mass body", " mass ",
     [](const Subject& of) {
       return Range{-kLostMass * of.joint().mass, kAddedMass * of.joint().mass};
     },
     "models' masses are estimates to a half (Gaz et al. 2019); none is off fivefold"},
    {"link_mass mounted", " mass ",
     [](const Subject& of) {
       return Range{-kLostMass * of.joint().mass, largest_mounted(of)};
     },
     "no more is mounted on a link than twice its mass or what the flange could carry"},
    {"link_mass mounted", " mx my mz ",
     [](const Subject& of) {
       return within((of.joint().mass + largest_mounted(of)) * of.size.reach);
     },
     "what is mounted on a link lies within the arm's reach"},
    {"thermal_drift temperature", kXyz,
     [](const Subject& of) { return within(10 * kAluminium * of.size.reach); },
     "aluminium grows by 23e-6 a kelvin; up and forward, and five times as warm as the sensor"},
    {"thermal_drift time", kXyz,
     [](const Subject& of) { return within(100 * kAluminium * of.size.reach); },
     "aluminium grows by 23e-6 a kelvin; up and forward, by 50 K (ISO 230-3)"},
    {"thermal_drift time", " time_constant ",
     [](const Subject&) {
       return Range{60, kEndless, Rest::above};
     },
     "housings and castings warm within minutes to hours (ISO 230-3), slowly like a straight line"},
};

const Row* find_row(const std::string& effect, const std::string& parameter) {
  const auto holds = [&](const Row& row) {
    return effect == row.effect && std::strstr(row.parameters, (" " + parameter + " ").c_str());
  };
  const auto* const plain = std::find_if(std::begin(kTable), std::end(kTable), holds);
  if (plain != std::end(kTable)) {
    return plain;
  }
  const auto* const of_form =
      std::find_if(std::begin(kTableOfForms), std::end(kTableOfForms), holds);
  return of_form != std::end(kTableOfForms) ? of_form : nullptr;
}

/// Why a number cannot be; empty if it can.
std::string why_not(const Parameter& parameter, const Range& range, double value) {
  const double tolerance = kRestTolerance * parameter.step;
  if (!std::isfinite(value) || value < range.lower - tolerance || value > range.upper + tolerance) {
    return fmt::format("{} of {:.3g} {} cannot be: {}", parameter.name, value, parameter.unit,
                       range.source);
  }
  const bool below = range.rest == Rest::below || range.rest == Rest::both;
  const bool above = range.rest == Rest::above || range.rest == Rest::both;
  if ((value <= parameter.lower + tolerance && !below) ||
      (value >= parameter.upper - tolerance && !above)) {
    return fmt::format("{} rests on its bound of {:.3g} {}", parameter.name, value, parameter.unit);
  }
  return "";
}

/// Of the arm's own motion, with the rotors; kg·m².
Eigen::Matrix<double, 6, 6> inertia_matrix(const model::Robot& robot,
                                           const JointVector<double, 6>& q) {
  model::Robot weightless = robot;
  weightless.elastic.gravity.setZero();
  const JointVector<double, 6> at_rest = JointVector<double, 6>::Zero();
  Eigen::Matrix<double, 6, 6> inertia;
  for (Eigen::Index joint = 0; joint < 6; ++joint) {
    inertia.col(joint) =
        simulation::inverse_dynamics(weightless, q, at_rest, JointVector<double, 6>::Unit(joint));
    inertia(joint, joint) += robot.dynamics[static_cast<std::size_t>(joint)].rotor_inertia;
  }
  return inertia;
}

bool is_positive(const Eigen::Matrix<double, 6, 6>& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(inertia,
                                                                          Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] > kFullyPositive * solver.eigenvalues()[5];
}

bool can_move(const Observations& observations, const model::Robot& learned) {
  for (const Scene& scene : observations.scenes) {
    const Eigen::Index step = std::max<Eigen::Index>(scene.rows() / kPostures, 1);
    for (Eigen::Index row = 0; row < scene.rows(); row += step) {
      const JointVector<double, 6> q = scene.q.row(row).transpose();
      if (!is_positive(inertia_matrix(learned, q)) &&
          is_positive(inertia_matrix(observations.machine.robot, q))) {
        return false;
      }
    }
  }
  return true;
}

/// Why masses cannot be so, of a machine in which an effect that changes them acts; empty if they
/// can.
std::string why_no_body(const Observations& observations, const MachineSize& size,
                        const Hypothesis& hypothesis, const model::Robot& learned) {
  const RobotModel<double, 6>& elastic = learned.elastic;
  if (hypothesis.effect() == "payload") {
    if (elastic.payload_mass < 0 || elastic.payload_center.norm() > 0.5 * size.reach) {
      return "a payload without mass or farther from the flange than half of the reach cannot be";
    }
  } else if (hypothesis.effect() == "link_mass") {
    const auto index = static_cast<std::size_t>(hypothesis.joint - 1);
    const Joint<double>& link = elastic.joints[index];
    if (!(link.mass > 0) ||
        link.center_of_mass.norm() > link_size(observations.machine.robot, size, index)) {
      return "a link whose centre of mass lies outside of it cannot be";
    }
  } else if (hypothesis.effect() != "rotor_inertia") {
    return "";
  }
  // Of what is mounted mass and place are fitted, not its own inertia: some always makes it a body.
  const bool tells_inertia = hypothesis.law->form != "mounted";
  return !tells_inertia || can_move(observations, learned) ? ""
                                                           : "an arm of negative inertia cannot be";
}

}  // namespace

MachineSize size_of(const model::Robot& robot) {
  MachineSize size;
  double mass = 0;
  for (std::size_t i = 0; i < robot.elastic.joints.size(); ++i) {
    const model::JointDynamics& limits = robot.dynamics[i];
    mass += robot.elastic.joints[i].mass;
    // The first joint's distance from the base lies below all that moves.
    size.reach += i > 0 ? robot.elastic.joints[i].origin.position.norm() : 0;
    size.effort[i] = limits.effort > 0 ? limits.effort : kEndless;
    size.velocity[i] = limits.velocity > 0 ? limits.velocity : kEndless;
  }
  size.reach += robot.elastic.tool.position.norm();
  size.payload = mass > 0 ? std::max(mass, robot.elastic.payload_mass) : kLargestPayload;
  size.weight = kGravity * mass;
  size.weight_torque = mass > 0 ? 0.5 * size.weight * size.reach : kEndless;
  return size;
}

MachineSize size_of(const Observations& observations) {
  MachineSize size = size_of(observations.machine.robot);
  for (int joint = 1; joint <= 6; ++joint) {
    size.load[static_cast<std::size_t>(joint - 1)] = observations.largest_load(joint);
  }
  for (const Scene& scene : observations.scenes) {
    size.force = std::max(size.force, scene.wrench.leftCols<3>().rowwise().norm().maxCoeff());
  }
  return size;
}

Range plausible_range(const model::Robot& robot, const MachineSize& size,
                      const Hypothesis& hypothesis, const std::string& parameter) {
  const Row* row = find_row(hypothesis.effect(), parameter);
  if (row == nullptr) {
    row = find_row(hypothesis.effect() + " " + hypothesis.law->form, parameter);
  }
  if (row == nullptr) {
    return {-kEndless, kEndless, Rest::nowhere, ""};
  }
  Range range = row->range({robot, size, hypothesis, parameter});
  range.source = row->source;
  return range;
}

void keep_plausible(const model::Robot& robot, const MachineSize& size, Hypothesis* hypothesis) {
  for (std::size_t i = 0; i < hypothesis->parameters.size(); ++i) {
    Parameter& parameter = hypothesis->parameters[i];
    Range range = plausible_range(robot, size, *hypothesis, parameter.name);
    if (i < hypothesis->linear) {  // the model as it is, is believed to be
      range.lower = std::min(range.lower, 0.0);
      range.upper = std::max(range.upper, 0.0);
    }
    const double lower = std::max(parameter.lower, range.lower);
    const double upper = std::min(parameter.upper, range.upper);
    if (lower > upper) {
      hypothesis->starts.clear();
      continue;
    }
    parameter.lower = lower;
    parameter.upper = upper;
  }
}

std::string why_impossible(const Observations& observations, const Fit& fit, std::size_t index) {
  const Chosen& chosen = fit.chosen[index];
  const Hypothesis& hypothesis = chosen.hypothesis;
  const MachineSize size = size_of(observations);
  for (std::size_t i = 0; i < chosen.values.size(); ++i) {
    const Parameter& parameter = hypothesis.parameters[i];
    const Range range =
        plausible_range(observations.machine.robot, size, hypothesis, parameter.name);
    std::string why = why_not(parameter, range, chosen.values[i]);
    if (!why.empty()) {
      return why;
    }
  }
  return why_no_body(observations, size, hypothesis, fit.machine.robot);
}

}  // namespace flexcomp::diagnosis
