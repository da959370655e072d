// The arm with flexible joints against conservation of energy, its equilibrium, the frequencies of
// a two-mass oscillator, and a second rigid-body algorithm.
#include <algorithm>
#include <cmath>

#include "simulation/flexible_joint_plant.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "simulation/sample_arms.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::simulation;

namespace {

using Two = JointVector<double, 2>;
using Six = JointVector<double, 6>;

FlexibleArm<6> kr360() {
  const model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr360/robot.yaml");
  FlexibleArm<6> arm;
  arm.model = six_axis_model(robot);
  std::copy(robot.link_inertia.begin(), robot.link_inertia.end(), arm.inertia.begin());
  arm.model.gravity = {0.2, -0.4, -9.7};
  arm.model.payload_mass = 150;
  arm.model.payload_center = {0.1, -0.05, 0.2};
  arm.rotor_inertia << 400, 450, 300, 60, 50, 25;
  return arm;
}

void energy_stays_without_friction() {
  FlexibleArm<2> arm = two_link_arm();
  arm.viscous.setZero();
  arm.coulomb.setZero();
  arm.model.payload_mass = 3;
  FlexibleJointPlant<2> plant(arm);
  plant.rest(Two(0.4, -0.9));
  const double before = plant.energy();
  for (int i = 0; i < 200; ++i) {
    plant.advance(Two::Zero(), Two::Zero(), 0.01, 50);  // falls freely
  }
  TEST_ASSERT_TRUE((plant.state().link - Two(0.4, -0.9)).norm() > 1);
  TEST_ASSERT_DOUBLE_WITHIN(1e-4, before, plant.energy());
}

void a_motor_that_carries_the_weight_keeps_it_at_rest() {
  const FlexibleArm<2> arm = two_link_arm();
  FlexibleJointPlant<2> plant(arm);
  const Two q(0.3, 0.5);
  const Two push(20, -5);
  plant.rest(q, push);
  InverseDynamics<double, 2> dynamics;
  TEST_ASSERT_EQUAL(Result::ok, dynamics.configure(arm.model, arm.inertia));
  const Two weight = dynamics.torque(q, Two::Zero(), Two::Zero(), Two::Zero()) - push;
  for (int i = 0; i < 100; ++i) {
    plant.advance(weight, push, 0.01, 20);
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (plant.state().link - q).norm());
}

/// Rotor and link on a spring, no weight: one mode at √(K (1/I + 1/J)).
void one_joint_rings_at_the_frequency_of_two_masses() {
  FlexibleArm<1> arm = one_link_arm();
  arm.viscous.setZero();
  arm.coulomb.setZero();
  arm.model.gravity.setZero();
  FlexibleJointPlant<1> plant(arm);
  using One = JointVector<double, 1>;
  FlexibleJointPlant<1>::State wound;
  wound.link[0] = 0.01 / 4;
  wound.motor[0] = -0.01;
  plant.set_state(wound);
  const double frequency = std::sqrt(1e4 * (1 / 4.0 + 1));
  const double period = 2 * std::acos(-1.0) / frequency;
  plant.advance(One::Zero(), One::Zero(), 3 * period, 3000);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.01 / 4, plant.state().link[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, -0.01, plant.state().motor[0]);
}

/// The links' acceleration, put into the controller's inverse dynamics, gives the spring
/// torques.
void plant_and_controller_agree_on_six_axes() {
  const FlexibleArm<6> arm = kr360();
  InverseDynamics<double, 6> dynamics;
  TEST_ASSERT_EQUAL(Result::ok, dynamics.configure(arm.model, arm.inertia));
  FlexibleJointPlant<6> plant(arm);
  FlexibleJointPlant<6>::State state;
  state.link << 0.3, -1.1, 0.8, 0.4, -0.7, 1.2;
  state.link_velocity << 0.5, -0.3, 0.4, 1.0, -0.8, 0.6;
  state.motor = state.link;
  state.motor += (Six() << 1e-3, -2e-3, 1e-3, 3e-3, -1e-3, 2e-3).finished();
  plant.set_state(state);
  constexpr double kStep = 1e-6;
  plant.advance(Six::Zero(), Six::Zero(), kStep, 1);
  const Six acceleration = (plant.state().link_velocity - state.link_velocity) / kStep;
  const Six elastic = arm.stiffness().cwiseProduct(state.motor - state.link);
  const Six torque =
      dynamics.torque(state.link, state.link_velocity, state.link_velocity, acceleration);
  TEST_ASSERT_DOUBLE_WITHIN(1e-4 * elastic.norm(), 0, (torque - elastic).norm());
}

void the_core_and_the_host_have_one_inverse_dynamics() {
  const FlexibleArm<6> arm = kr360();
  model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr360/robot.yaml");
  robot.elastic = model::chain_of(arm.model);
  InverseDynamics<double, 6> dynamics;
  TEST_ASSERT_EQUAL(Result::ok, dynamics.configure(arm.model, arm.inertia));
  InverseDynamics<float, 6> coarse;
  LinkInertia<float, 6> inertia;
  for (std::size_t i = 0; i < 6; ++i) {
    inertia[i] = arm.inertia[i].cast<float>();
  }
  TEST_ASSERT_EQUAL(Result::ok, coarse.configure(arm.model.cast<float>(), inertia));
  for (int i = 0; i < 20; ++i) {
    const Six q = Six::Random() * 3;
    const Six velocity = Six::Random() * 2;
    const Six acceleration = Six::Random() * 5;
    const Six expected = inverse_dynamics(robot, q, velocity, acceleration);
    const Six actual = dynamics.torque(q, velocity, velocity, acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12 * expected.norm(), 0, (actual - expected).norm());
    const Six single = coarse
                           .torque(q.cast<float>(), velocity.cast<float>(), velocity.cast<float>(),
                                   acceleration.cast<float>())
                           .cast<double>();
    TEST_ASSERT_DOUBLE_WITHIN(2e-6 * expected.norm(), 0, (single - expected).norm());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(energy_stays_without_friction);
  RUN_TEST(a_motor_that_carries_the_weight_keeps_it_at_rest);
  RUN_TEST(one_joint_rings_at_the_frequency_of_two_masses);
  RUN_TEST(plant_and_controller_agree_on_six_axes);
  RUN_TEST(the_core_and_the_host_have_one_inverse_dynamics);
  return UNITY_END();
}
