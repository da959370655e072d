#include "control/arc_design.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::control {
namespace {

constexpr double kTrace = 1e-3;        // of the bound, that every parameter counts for at least
constexpr double kBoundMargin = 1.25;  // of ρ_max above the largest physical bound
constexpr double kRateMargin = 2;      // of |w*'| above the nominal arm's, for feedback and loads

template <int Joints>
using Angles = JointVector<double, Joints>;

FuzzyNumber off_one(const FuzzyNumber& factor) {
  return (factor - FuzzyNumber::crisp(1)).magnitude();
}

void refuse_impossible(const ArmUncertainty& uncertainty) {
  for (const FuzzyNumber* factor :
       {&uncertainty.stiffness, &uncertainty.link_mass, &uncertainty.rotor_inertia}) {
    if (!(factor->support().lower > 0)) {
      throw InputError("factors of masses, stiffness and rotor inertia must be above zero");
    }
  }
  for (const FuzzyNumber* size : {&uncertainty.payload, &uncertainty.viscous, &uncertainty.coulomb,
                                  &uncertainty.tool_force, &uncertainty.joint_load}) {
    if (!(size->support().lower >= 0)) {
      throw InputError("payload, friction factors, tool force and joint load cannot be below zero");
    }
  }
}

/// Sets what follows from the parameters of a bound and how large its regressor becomes.
template <int Count>
void size_part(const Eigen::Matrix<double, Count, 1>& regressor, double gain_limit,
               ArcPart<Count>* part) {
  double largest = 0;
  for (Eigen::Index m = 0; m < Count; ++m) {
    largest += part->parameters[static_cast<std::size_t>(m)].support().upper * regressor[m];
  }
  if (!(largest > 0)) {
    throw InputError(
        "nothing is uncertain of one side of a joint: give it a coulomb, viscous, stiffness or "
        "load set");
  }
  for (Eigen::Index m = 0; m < Count; ++m) {
    part->typical[m] = std::max(part->parameters[static_cast<std::size_t>(m)].mean(),
                                kTrace * largest / regressor[m]);
  }
  part->bound_limit = kBoundMargin * largest;
  part->gain_limit = gain_limit;
}

/// Σ α²/Γ as a fuzzy number.
template <int Count>
FuzzyNumber parameter_energy(const ArcPart<Count>& part,
                             const Eigen::Matrix<double, Count, 1>& rates) {
  FuzzyNumber sum = FuzzyNumber::crisp(0);
  for (Eigen::Index m = 0; m < Count; ++m) {
    sum = sum + part.parameters[static_cast<std::size_t>(m)].squared() / rates[m];
  }
  return sum;
}

/// The quartic of one part; `motion` is the rest of V₀ (J), `damping` (N·m·s/rad) the loop's own.
template <int Count>
void solve_part(double share, double decay, double damping, const ArcBandwidth& bandwidth,
                const FuzzyNumber& motion, const Eigen::Matrix<double, Count, 1>& rates,
                ArcPart<Count>* part) {
  const FuzzyNumber energy = parameter_energy(*part, rates) * (share / 2);
  part->problem.decay = decay;
  part->problem.residual_time = bandwidth.residual_time;
  part->problem.share = share;
  part->problem.start = energy + motion;
  part->problem.drift = energy * bandwidth.leak;
  // γ ρ² is what the robust term adds to the loop's damping: effort counts in units of that, and of
  // κ₃, so that a weight means the same for a small arm and a large one.
  const double bound = part->bound_limit / kBoundMargin;
  part->problem.effort =
      bandwidth.effort * gain_cost(part->problem).square * std::pow(bound * bound / damping, 4);
  part->cost = gain_cost(part->problem);
  part->root = part->cost.best();
  part->gain = std::min(part->root, part->gain_limit / (part->bound_limit * part->bound_limit));
}

/// W, what one robust term and the adaptation of its bound add to δ at the far ends of the
/// supports.
template <int Count>
double drift_of(const ArcPart<Count>& part, const Eigen::Matrix<double, Count, 1>& rates,
                double leak, double weight) {
  Eigen::Matrix<double, Count, 1> parameters;
  for (Eigen::Index m = 0; m < Count; ++m) {
    parameters[m] = part.parameters[static_cast<std::size_t>(m)].support().upper;
  }
  return layer_drift(weight, 1 / part.gain) + leak_drift(weight, leak, parameters, rates);
}

/// Γ so that at a surface speed of `speed` adaptation against the leak gives the typical bound.
template <int Count>
Eigen::Matrix<double, Count, 1> adaptation(const ArcPart<Count>& part,
                                           const ArcBandwidth& bandwidth) {
  const double reference = part.bound_limit / kBoundMargin;
  return bandwidth.leak / (bandwidth.surface_speed * reference) * part.typical.cwiseAbs2();
}

/// Sets the bound function of one joint's link: |h₁| ≤ κ_ α·[1, |τ₀|, ‖a_r‖ + ‖q₁'‖‖q_r'‖].
template <int Joints>
void bound_link(const simulation::FlexibleArm<Joints>& arm, const ArmUncertainty& uncertainty,
                const ArmExtremes<Joints>& extremes, Eigen::Index joint, double share,
                ArcPart<3>* part) {
  const FuzzyNumber payload =
      (uncertainty.payload - FuzzyNumber::crisp(arm.model.payload_mass)).magnitude();
  const FuzzyNumber links = off_one(uncertainty.link_mass);
  const auto both = [&](const auto& of) {
    return links * of(extremes.links) + payload * of(extremes.payload);
  };
  using Unit = typename ArmExtremes<Joints>::Unit;
  part->parameters[0] = (both([joint](const Unit& unit) { return unit.weight[joint]; }) +
                         uncertainty.tool_force * extremes.lever[joint] + uncertainty.joint_load) /
                        share;
  part->parameters[1] = off_one(uncertainty.stiffness) / share;
  part->parameters[2] = both([joint](const Unit& unit) {
                          return std::max(unit.inertia[joint], unit.velocity[joint]);
                        }) /
                        share;
}

/// Sets the bound function of one motor: |h₂| ≤ α·[1, |q₂'|, |K₀ (q₁ − q₂)|, |a₂|].
template <int Joints>
void bound_motor(const simulation::FlexibleArm<Joints>& arm, const ArmUncertainty& uncertainty,
                 Eigen::Index joint, ArcPart<4>* part) {
  part->parameters[0] = uncertainty.coulomb * arm.coulomb[joint];
  part->parameters[1] = off_one(uncertainty.viscous) * arm.viscous[joint];
  part->parameters[2] = off_one(uncertainty.stiffness);
  part->parameters[3] = off_one(uncertainty.rotor_inertia) * arm.rotor_inertia[joint];
}

/// Typical largest feed-forward torque of a joint: weight and inertia of the nominal arm.
template <int Joints>
double largest_torque(const simulation::FlexibleArm<Joints>& arm,
                      const ArmExtremes<Joints>& extremes, double motion, Eigen::Index joint) {
  const auto sum = [&](const auto& unit) {
    return unit.weight[joint] + unit.inertia[joint] * motion;
  };
  const double asked = sum(extremes.links) + arm.model.payload_mass * sum(extremes.payload);
  return std::min(asked, arm.torque_limit[joint]);
}

/// rad, |x₃| at most at the start: the arm at rest off its setpoint by the start error e, its
/// springs carrying the true weight, the virtual control what the nominal arm would. The link's
/// bound contains what K⁻¹ G and K₀⁻¹ G₀ differ by; feedback asks for D₀ (q_d'' − k_v S₁ e) more.
template <int Joints>
FuzzyNumber start_motor_error(const simulation::FlexibleArm<Joints>& arm,
                              const ArmUncertainty& uncertainty,
                              const ArmExtremes<Joints>& extremes, const MotionLimits& motion,
                              const ArcBandwidth& bandwidth, const ArcPart<3>& link,
                              Eigen::Index joint) {
  const FuzzyNumber off = uncertainty.start_error.magnitude();
  const double weight =
      extremes.links.weight[joint] + arm.model.payload_mass * extremes.payload.weight[joint];
  const double row = std::sqrt(Joints) * (extremes.links.inertia[joint] +
                                          arm.model.payload_mass * extremes.payload.inertia[joint]);
  const FuzzyNumber acceleration = off * (bandwidth.link_damping * bandwidth.link_rate) +
                                   FuzzyNumber::crisp(motion.acceleration);
  const FuzzyNumber torque = link.parameters[0] + link.parameters[1] * weight + acceleration * row;
  return off + torque * arm.model.joints[static_cast<std::size_t>(joint)].compliance;
}

template <int Joints>
void set_bandwidth(const simulation::FlexibleArm<Joints>& arm, const ArcBandwidth& bandwidth,
                   ArcGains<double, Joints>* gains) {
  gains->period = bandwidth.period;
  gains->rotor_inertia = arm.rotor_inertia;
  gains->viscous = arm.viscous;
  gains->link_rate.setConstant(bandwidth.link_rate);
  gains->link_damping = bandwidth.link_damping;
  gains->motor_rate.setConstant(bandwidth.motor_rate);
  gains->motor_damping = bandwidth.motor_damping;
  gains->motor_stiffness = bandwidth.motor_stiffness * arm.rotor_inertia;
  gains->filter_frequency = bandwidth.filter_frequency;
  gains->leak = bandwidth.leak;
  gains->torque_limit = arm.torque_limit;
}

/// δ at the far ends of the supports, and V₀.
template <int Joints>
void guarantee(const simulation::FlexibleArm<Joints>& arm, const ArmUncertainty& uncertainty,
               const ArmExtremes<Joints>& extremes, const ArcBandwidth& bandwidth,
               ArcDesign<Joints>* design) {
  ArcGuarantee& made = design->guarantee;
  const double stiffest = uncertainty.stiffness.support().upper;
  made.least_inertia = extremes.least_inertia;
  made.least_stiffness = made.stiffness_share * arm.stiffness().minCoeff();
  made.least_motor_stiffness = design->gains.motor_stiffness.minCoeff();
  made.coupling = 2 / bandwidth.link_damping * extremes.coupling;
  double drift = 0;
  double start = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(Joints); ++i) {
    const ArcPart<3>& link = design->link[i];
    const ArcPart<4>& motor = design->motor[i];
    const auto joint = static_cast<Eigen::Index>(i);
    drift += drift_of<3>(link, design->gains.link_adaptation.row(joint).transpose(), bandwidth.leak,
                         made.stiffness_share) +
             drift_of<4>(motor, design->gains.motor_adaptation.row(joint).transpose(),
                         bandwidth.leak, made.coupling);
    start +=
        link.problem.start.support().upper + made.coupling * motor.problem.start.support().upper;
  }
  // y' κ D⁻¹ κ y / k_v with |y| ≤ 2/ω_f sup|w*'|.
  const Angles<Joints> lag = 2 / bandwidth.filter_frequency * design->elastic_rate;
  made.filter_drift =
      filter_drift(stiffest, lag.squaredNorm(), bandwidth.link_damping, extremes.least_inertia);
  made.bound.drift = drift + made.filter_drift;
  made.start = start;
}

}  // namespace

template <int Count>
ArcPart<Count>::ArcPart() {
  parameters.fill(FuzzyNumber::crisp(0));
  typical.setZero();
}
template struct ArcPart<3>;
template struct ArcPart<4>;

double ArcGuarantee::tracking_error(double level) const {
  return std::sqrt(2 * level / least_stiffness);
}
double ArcGuarantee::link_surface(double level) const {
  return std::sqrt(2 * level / least_inertia);
}
double ArcGuarantee::motor_error(double level) const {
  return std::sqrt(2 * level / (coupling * least_motor_stiffness));
}
double ArcGuarantee::link_parameters(double level) const {
  return std::sqrt(2 * level / stiffness_share);
}
double ArcGuarantee::motor_parameters(double level) const {
  return std::sqrt(2 * level / coupling);
}

template <int Joints>
ArcDesign<Joints> design_arc(const simulation::FlexibleArm<Joints>& arm,
                             const ArmUncertainty& uncertainty, const MotionLimits& motion,
                             const ArcBandwidth& bandwidth) {
  refuse_impossible(uncertainty);
  ArcDesign<Joints> design;
  set_bandwidth(arm, bandwidth, &design.gains);
  const Angles<Joints> stiffest = uncertainty.stiffness.support().upper * arm.stiffness();
  const ArmExtremes<Joints> extremes = sample_extremes<Joints>(
      arm, uncertainty,
      stiffest.cwiseAbs2().cwiseQuotient(bandwidth.motor_rate * design.gains.motor_stiffness));
  const double share = uncertainty.stiffness.support().lower;
  design.guarantee.stiffness_share = share;
  design.guarantee.bound.decay =
      std::min({bandwidth.link_damping, 2 * bandwidth.link_rate, bandwidth.motor_rate,
                2 * bandwidth.motor_damping, bandwidth.leak});
  const double decay = design.guarantee.bound.decay;
  const double speed = std::sqrt(Joints) * motion.velocity;
  const double moved = std::sqrt(Joints) * motion.acceleration + speed * speed;
  for (Eigen::Index joint = 0; joint < Joints; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    ArcPart<3>& link = design.link[i];
    ArcPart<4>& motor = design.motor[i];
    bound_link(arm, uncertainty, extremes, joint, share, &link);
    bound_motor(arm, uncertainty, joint, &motor);
    const double torque = largest_torque(arm, extremes, moved, joint);
    size_part<3>({1, torque, moved}, bandwidth.link_gain_limit * extremes.effective[joint], &link);
    size_part<4>({1, motion.velocity, torque, motion.acceleration},
                 bandwidth.motor_gain_limit * arm.rotor_inertia[joint], &motor);
    const auto link_rates = adaptation(link, bandwidth);
    const auto motor_rates = adaptation(motor, bandwidth);
    const FuzzyNumber error = uncertainty.start_error.squared();
    const FuzzyNumber motor_error =
        start_motor_error(arm, uncertainty, extremes, motion, bandwidth, link, joint);
    const double surface = bandwidth.link_rate * bandwidth.link_rate;
    const double motor_surface = bandwidth.motor_rate * bandwidth.motor_rate;
    solve_part<3>(share, decay, bandwidth.link_damping * extremes.effective[joint], bandwidth,
                  error * ((extremes.largest_inertia * surface + stiffest[joint]) / 2), link_rates,
                  &link);
    solve_part<4>(1, decay, bandwidth.motor_damping * arm.rotor_inertia[joint], bandwidth,
                  motor_error.squared() * ((uncertainty.rotor_inertia.support().upper *
                                                arm.rotor_inertia[joint] * motor_surface +
                                            design.gains.motor_stiffness[joint]) /
                                           2),
                  motor_rates, &motor);
    design.gains.link_adaptation.row(joint) = link_rates.transpose();
    design.gains.motor_adaptation.row(joint) = motor_rates.transpose();
    design.gains.link_gain[joint] = link.gain;
    design.gains.motor_gain[joint] = motor.gain;
    design.gains.link_gain_limit[joint] = link.gain_limit;
    design.gains.motor_gain_limit[joint] = motor.gain_limit;
    design.gains.link_bound_limit[joint] = link.bound_limit;
    design.gains.motor_bound_limit[joint] = motor.bound_limit;
    const auto rate = [&](const auto& unit) {
      return unit.weight[joint] * speed + unit.inertia[joint] * std::sqrt(Joints) * motion.jerk +
             3 * unit.velocity[joint] * speed * std::sqrt(Joints) * motion.acceleration;
    };
    design.elastic_rate[joint] =
        kRateMargin * (rate(extremes.links) + arm.model.payload_mass * rate(extremes.payload));
  }
  guarantee(arm, uncertainty, extremes, bandwidth, &design);
  return design;
}

#define FLEXCOMP_DESIGN(Joints)                                                     \
  template ArcDesign<Joints> design_arc(const simulation::FlexibleArm<Joints>&,     \
                                        const ArmUncertainty&, const MotionLimits&, \
                                        const ArcBandwidth&);
FLEXCOMP_DESIGN(1)
FLEXCOMP_DESIGN(2)
FLEXCOMP_DESIGN(6)

}  // namespace flexcomp::control
