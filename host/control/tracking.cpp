#include "control/tracking.hpp"

#include <stdexcept>
#include <utility>

namespace flexcomp::control {
namespace {

template <int Joints>
using Plant = simulation::FlexibleJointPlant<Joints>;

template <int Joints>
ArcInput<double, Joints> sensed(const typename Plant<Joints>::State& state,
                                const Reference<Joints>& reference) {
  ArcInput<double, Joints> input;
  input.link = state.link;
  input.link_velocity = state.link_velocity;
  input.motor = state.motor;
  input.motor_velocity = state.motor_velocity;
  input.wanted = reference.position;
  input.wanted_velocity = reference.velocity;
  input.wanted_acceleration = reference.acceleration;
  return input;
}

}  // namespace

template <int Joints>
TrackingFigures<Joints> track(const TrackingJob<Joints>& job, const Controller<Joints>& controller,
                              const Observer<Joints>& observer) {
  using Angles = JointVector<double, Joints>;
  Plant<Joints> plant(job.arm);
  plant.rest(job.reference(0).position + job.start_error);
  TrackingFigures<Joints> figures;
  Angles before = Angles::Zero();
  int counted = 0;
  bool changed = false;
  const auto periods = static_cast<int>(job.duration / job.period);
  for (int i = 0; i < periods; ++i) {
    const double time = i * job.period;
    if (job.later_arm && !changed && time >= job.change_time) {
      plant.change_arm(*job.later_arm);
      changed = true;
    }
    const ArcInput<double, Joints> input = sensed<Joints>(plant.state(), job.reference(time));
    const Angles torque = controller(input);
    if (observer) {
      observer(time, input, torque);
    }
    if (time >= job.settled) {
      const Angles error = input.link - input.wanted;
      figures.largest_error = figures.largest_error.cwiseMax(error.cwiseAbs());
      figures.error += error.cwiseAbs2();
      figures.torque += torque.cwiseAbs2();
      figures.torque_change += (torque - before).cwiseAbs2();
      ++counted;
    }
    before = torque;
    const Angles load = job.load ? job.load(time, input.link) : Angles(Angles::Zero());
    plant.advance(torque, load, job.period, job.steps);
  }
  for (Angles* const figure : {&figures.error, &figures.torque, &figures.torque_change}) {
    *figure = (*figure / counted).cwiseSqrt();
  }
  return figures;
}

template <int Joints>
Controller<Joints> pd_controller(const PdGains<Joints>& gains) {
  return [gains](const ArcInput<double, Joints>& input) -> JointVector<double, Joints> {
    const JointVector<double, Joints> asked =
        -gains.proportional.cwiseProduct(input.motor - input.wanted) -
        gains.derivative.cwiseProduct(input.motor_velocity - input.wanted_velocity);
    return asked.cwiseMin(gains.torque_limit).cwiseMax(-gains.torque_limit);
  };
}

template <int Joints>
Controller<Joints> with_feed_forward(const simulation::FlexibleArm<Joints>& nominal,
                                     Controller<Joints> controller) {
  InverseDynamics<double, Joints> dynamics;
  if (dynamics.configure(nominal.model, nominal.inertia) != Result::ok) {
    throw std::invalid_argument("an arm that cannot be");
  }
  return [dynamics, controller = std::move(controller), rotor = nominal.rotor_inertia,
          viscous = nominal.viscous](
             const ArcInput<double, Joints>& input) -> JointVector<double, Joints> {
    return controller(input) +
           dynamics.torque(input.wanted, input.wanted_velocity, input.wanted_velocity,
                           input.wanted_acceleration) +
           rotor.cwiseProduct(input.wanted_acceleration) +
           viscous.cwiseProduct(input.wanted_velocity);
  };
}

template <int Joints>
PdGains<Joints> matching_pd(const ArcGains<double, Joints>& gains) {
  // u = J (−S₂ x₄ − k₂ (x₄ + S₂ x₃)) − K_p2 x₃ + …
  const JointVector<double, Joints> rate = gains.motor_rate;
  return {gains.motor_stiffness + gains.motor_damping * gains.rotor_inertia.cwiseProduct(rate),
          gains.rotor_inertia.cwiseProduct(
              rate + JointVector<double, Joints>::Constant(gains.motor_damping)),
          gains.torque_limit};
}

template <int Joints>
DrawnArm<Joints> draw_arm(const simulation::FlexibleArm<Joints>& nominal,
                          const ArmUncertainty& uncertainty, std::mt19937_64* random) {
  const auto drawn = [random](const FuzzyNumber& number) {
    const Interval support = number.support();
    return support.lower +
           (support.upper - support.lower) * std::uniform_real_distribution<double>(0, 1)(*random);
  };
  DrawnArm<Joints> made{nominal};
  simulation::FlexibleArm<Joints>& arm = made.arm;
  const double mass = drawn(uncertainty.link_mass);
  arm.model.payload_mass = drawn(uncertainty.payload);
  for (std::size_t i = 0; i < static_cast<std::size_t>(Joints); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    arm.model.joints[i].mass *= mass;
    arm.inertia[i] *= mass;
    arm.model.joints[i].compliance /= drawn(uncertainty.stiffness);
    arm.rotor_inertia[joint] *= drawn(uncertainty.rotor_inertia);
    arm.viscous[joint] *= drawn(uncertainty.viscous);
    arm.coulomb[joint] *= drawn(uncertainty.coulomb);
  }
  made.tool_force = drawn(uncertainty.tool_force);
  made.joint_load = drawn(uncertainty.joint_load);
  return made;
}

#define FLEXCOMP_TRACKING(Joints)                                                               \
  template TrackingFigures<Joints> track(const TrackingJob<Joints>&, const Controller<Joints>&, \
                                         const Observer<Joints>&);                              \
  template Controller<Joints> pd_controller(const PdGains<Joints>&);                            \
  template Controller<Joints> with_feed_forward(const simulation::FlexibleArm<Joints>&,         \
                                                Controller<Joints>);                            \
  template PdGains<Joints> matching_pd(const ArcGains<double, Joints>&);                        \
  template DrawnArm<Joints> draw_arm(const simulation::FlexibleArm<Joints>&,                    \
                                     const ArmUncertainty&, std::mt19937_64*);
FLEXCOMP_TRACKING(1)
FLEXCOMP_TRACKING(2)
FLEXCOMP_TRACKING(6)

}  // namespace flexcomp::control
