#include "flexcomp/arc.hpp"

#include <algorithm>
#include <cmath>

#include "checked_number.hpp"
#include "instantiate.hpp"

#ifdef __FAST_MATH__
#error "flexcomp checks its inputs for NaN and infinity, which -ffast-math assumes away"
#endif

namespace flexcomp {
namespace {

template <typename Derived>
bool all_positive(const Eigen::MatrixBase<Derived>& values) {
  return values.allFinite() && values.minCoeff() > typename Derived::Scalar(0);
}

template <typename Scalar, int Joints>
bool is_finite(const ArcInput<Scalar, Joints>& input) {
  return input.link.allFinite() && input.link_velocity.allFinite() && input.motor.allFinite() &&
         input.motor_velocity.allFinite() && input.wanted.allFinite() &&
         input.wanted_velocity.allFinite() && input.wanted_acceleration.allFinite() &&
         input.external_torque.allFinite();
}

template <typename Scalar, int Joints>
bool is_valid(const ArcGains<Scalar, Joints>& gains) {
  return is_positive(gains.period) && all_positive(gains.rotor_inertia) &&
         gains.viscous.allFinite() && gains.viscous.minCoeff() >= Scalar(0) &&
         all_positive(gains.link_rate) && is_positive(gains.link_damping) &&
         all_positive(gains.motor_rate) && is_positive(gains.motor_damping) &&
         all_positive(gains.motor_stiffness) && is_positive(gains.filter_frequency) &&
         is_positive(gains.leak) && all_positive(gains.link_adaptation) &&
         all_positive(gains.motor_adaptation) && all_positive(gains.link_gain) &&
         all_positive(gains.motor_gain) && all_positive(gains.link_gain_limit) &&
         all_positive(gains.motor_gain_limit) && all_positive(gains.link_bound_limit) &&
         all_positive(gains.motor_bound_limit) && all_positive(gains.torque_limit);
}

/// Within what a sampled controller can bear; the motor's own loop is the fastest.
template <typename Scalar, int Joints>
bool is_slow_enough(const ArcGains<Scalar, Joints>& gains) {
  const Scalar fastest =
      gains.motor_damping + gains.motor_gain_limit.cwiseQuotient(gains.rotor_inertia).maxCoeff();
  return gains.filter_frequency * gains.period <= Scalar(1) &&
         fastest * gains.period <= Scalar(0.5);
}

template <typename Scalar>
Scalar clamped(Scalar value, Scalar limit) {
  return std::min(std::max(value, -limit), limit);
}

/// Torque against whatever is within `bound`: of that size outside a boundary layer, linear in the
/// surface inside it, never steeper than `limit` (N·m·s/rad), so that it cannot chatter.
template <typename Scalar>
Scalar robust_torque(Scalar surface, Scalar bound, Scalar gain, Scalar limit) {
  const Scalar power = surface * bound;
  const Scalar layer = std::max(Scalar(1) / gain, bound * bound / limit);
  return -bound * power / std::max(std::abs(power), layer);
}

/// The parameters of one bound after a period: growth along the regressor, less and less as the
/// bound nears its limit and never past it, and an implicit leak, which is stable for any period.
/// Returns whether the limit was out of the way.
template <typename Regressor, typename Rates, typename Scalar, typename Parameters>
bool adapt(const Regressor& regressor, const Rates& rates, Scalar limit, Scalar drive, Scalar kept,
           Parameters parameters) {
  const Scalar room = std::max(limit - parameters.dot(regressor), Scalar(0));
  const Scalar share = std::min(room / (Scalar(0.2) * limit), Scalar(1));
  const Scalar steepness = rates.dot(regressor.cwiseAbs2());
  const Scalar step = std::min(share * drive, room / steepness);
  parameters = kept * (parameters + step * rates.cwiseProduct(regressor.transpose()));
  return share == Scalar(1);
}

}  // namespace

template <typename Scalar, int Joints>
Result AdaptiveRobustController<Scalar, Joints>::configure(
    const RobotModel<Scalar, Joints>& model, const LinkInertia<Scalar, Joints>& inertia,
    const Gains& gains) {
  *this = AdaptiveRobustController();
  const Result result = dynamics_.configure(model, inertia);
  if (result != Result::ok) {
    return result;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(Joints); ++i) {
    compliance_[static_cast<Eigen::Index>(i)] = model.joints[i].compliance;
  }
  stiffness_ = compliance_.cwiseInverse();
  if (!all_positive(compliance_) || !stiffness_.allFinite()) {
    return Result::bad_model;
  }
  if (!is_valid(gains) || !is_slow_enough(gains)) {
    return Result::bad_config;
  }
  gains_ = gains;
  kept_ = Scalar(1) / (Scalar(1) + gains.period * gains.leak);
  decay_ = Scalar(1) + std::expm1(-gains.filter_frequency * gains.period);
  is_configured_ = true;
  return Result::ok;
}

template <typename Scalar, int Joints>
void AdaptiveRobustController<Scalar, Joints>::restart() {
  state_ = State();
  torque_.setZero();
}

template <typename Scalar, int Joints>
Result AdaptiveRobustController<Scalar, Joints>::set_parameters(const LinkParameters& link,
                                                                const MotorParameters& motor) {
  if (!link.allFinite() || !motor.allFinite() || link.minCoeff() < Scalar(0) ||
      motor.minCoeff() < Scalar(0)) {
    return Result::bad_argument;
  }
  state_.link = link;
  state_.motor = motor;
  return Result::ok;
}

template <typename Scalar, int Joints>
auto AdaptiveRobustController<Scalar, Joints>::tick(const Input& input) -> Output {
  Output output{};
  State next = state_;
  if (!is_configured_) {
    output.status = kArcNotConfigured;
  } else if (!is_finite(input)) {
    output.status = kArcInputNotFinite;
  } else {
    track(input, &next, &output);
    next.is_running = true;
    const bool computed = output.torque.allFinite() && next.elastic_torque.allFinite() &&
                          next.elastic_rate.allFinite() && next.link.allFinite() &&
                          next.motor.allFinite();
    output.status |= computed ? 0U : static_cast<std::uint32_t>(kArcNotComputable);
  }
  if ((output.status & kArcRefusedBits) != 0) {
    const std::uint32_t status = output.status & kArcRefusedBits;
    output = Output{};
    output.torque = torque_;
    output.status = status;
    return output;
  }
  state_ = next;
  torque_ = output.torque;
  return output;
}

/// The link side: what elastic torque would make the link follow; then each motor.
template <typename Scalar, int Joints>
void AdaptiveRobustController<Scalar, Joints>::track(const Input& input, State* next,
                                                     Output* output) const {
  const Angles error = input.link - input.wanted;
  const Angles error_rate = input.link_velocity - input.wanted_velocity;
  const Angles shift = gains_.link_rate.cwiseProduct(error);
  const Angles reference_velocity = input.wanted_velocity - shift;
  output->link_surface = error_rate + shift;
  const Angles reference_acceleration = input.wanted_acceleration -
                                        gains_.link_rate.cwiseProduct(error_rate) -
                                        gains_.link_damping * output->link_surface;
  const Angles feed_forward = dynamics_.torque(input.link, input.link_velocity, reference_velocity,
                                               reference_acceleration) -
                              input.external_torque;
  const Scalar motion =
      std::sqrt(reference_acceleration.squaredNorm()) +
      std::sqrt(input.link_velocity.squaredNorm() * reference_velocity.squaredNorm());
  output->status = 0;
  for (Eigen::Index joint = 0; joint < Joints; ++joint) {
    const Vector3<Scalar> regressor(Scalar(1), std::abs(feed_forward[joint]), motion);
    const Scalar bound = state_.link.row(joint).dot(regressor);
    output->link_bound[joint] = std::min(bound, gains_.link_bound_limit[joint]);
    output->wanted_elastic_torque[joint] =
        feed_forward[joint] + robust_torque(output->link_surface[joint], output->link_bound[joint],
                                            gains_.link_gain[joint], gains_.link_gain_limit[joint]);
    drive(input, joint, regressor, next, output);
  }
}

/// One motor: it follows the virtual control; then both bounds of the joint adapt.
template <typename Scalar, int Joints>
void AdaptiveRobustController<Scalar, Joints>::drive(const Input& input, Eigen::Index joint,
                                                     const Vector3<Scalar>& regressor, State* next,
                                                     Output* output) const {
  const Scalar limit = gains_.torque_limit[joint];
  const Scalar wanted = clamped(output->wanted_elastic_torque[joint], limit);
  if (!state_.is_running) {
    next->elastic_torque[joint] = wanted;
    next->elastic_rate[joint] = Scalar(0);
  }
  const Scalar frequency = gains_.filter_frequency;
  const Scalar torque = next->elastic_torque[joint];
  const Scalar rate = next->elastic_rate[joint];
  const Scalar curvature = frequency * (frequency * (wanted - torque) - Scalar(2) * rate);
  const Scalar soft = compliance_[joint];
  const Scalar error = input.motor[joint] - (input.wanted[joint] + soft * torque);
  const Scalar error_rate =
      input.motor_velocity[joint] - (input.wanted_velocity[joint] + soft * rate);
  const Scalar surface = error_rate + gains_.motor_rate[joint] * error;
  const Scalar acceleration = input.wanted_acceleration[joint] + soft * curvature -
                              gains_.motor_rate[joint] * error_rate -
                              gains_.motor_damping * surface;
  const Scalar elastic = stiffness_[joint] * (input.link[joint] - input.motor[joint]);
  const Eigen::Matrix<Scalar, 4, 1> motor_regressor(
      Scalar(1), std::abs(input.motor_velocity[joint]), std::abs(elastic), std::abs(acceleration));
  const Scalar motor_bound = state_.motor.row(joint).dot(motor_regressor);
  output->motor_bound[joint] = std::min(motor_bound, gains_.motor_bound_limit[joint]);
  const Scalar asked = gains_.rotor_inertia[joint] * acceleration +
                       gains_.viscous[joint] * input.motor_velocity[joint] - elastic -
                       gains_.motor_stiffness[joint] * error +
                       robust_torque(surface, output->motor_bound[joint], gains_.motor_gain[joint],
                                     gains_.motor_gain_limit[joint]);
  output->torque[joint] = clamped(asked, limit);
  output->motor_error[joint] = error;
  output->motor_surface[joint] = surface;

  // A joint at its torque limit tells nothing of what it is up against: it adapts no further.
  const bool is_limited =
      output->torque[joint] != asked || wanted != output->wanted_elastic_torque[joint];
  const Scalar period = is_limited ? Scalar(0) : gains_.period;
  const bool link_is_free =
      adapt(regressor, gains_.link_adaptation.row(joint), gains_.link_bound_limit[joint],
            period * std::abs(output->link_surface[joint]), kept_, next->link.row(joint));
  const bool motor_is_free =
      adapt(motor_regressor, gains_.motor_adaptation.row(joint), gains_.motor_bound_limit[joint],
            period * std::abs(surface), kept_, next->motor.row(joint));
  output->status |= is_limited ? static_cast<std::uint32_t>(kArcTorqueLimited) : 0U;
  output->status |=
      link_is_free && motor_is_free ? 0U : static_cast<std::uint32_t>(kArcBoundLimited);
  advance_filter(joint, wanted, next);
}

/// The critically damped filter over one period of constant input, exactly.
template <typename Scalar, int Joints>
void AdaptiveRobustController<Scalar, Joints>::advance_filter(Eigen::Index joint, Scalar wanted,
                                                              State* next) const {
  const Scalar period = gains_.period;
  const Scalar turn = gains_.filter_frequency * period;
  const Scalar distance = next->elastic_torque[joint] - wanted;
  const Scalar rate = next->elastic_rate[joint];
  next->elastic_torque[joint] = wanted + decay_ * ((Scalar(1) + turn) * distance + period * rate);
  next->elastic_rate[joint] =
      decay_ * ((Scalar(1) - turn) * rate - gains_.filter_frequency * turn * distance);
}

const char* describe(ArcStatusBit bit) {
  switch (bit) {
    case kArcInputNotFinite:
      return "input not finite";
    case kArcNotComputable:
      return "torque not computable";
    case kArcNotConfigured:
      return "not configured";
    case kArcTorqueLimited:
      return "limited in torque";
    case kArcBoundLimited:
      return "adapted bound at its limit";
  }
  return "unknown bit";
}

#define FLEXCOMP_ARC(Scalar, Joints) template class AdaptiveRobustController<Scalar, Joints>;
FLEXCOMP_INSTANTIATE_CONTROL(FLEXCOMP_ARC)

}  // namespace flexcomp
