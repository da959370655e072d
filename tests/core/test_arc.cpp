// Adaptive robust control: a worked example tick by tick, and what must hold whatever comes in.
#include <cmath>
#include <limits>
#include <random>
#include <string_view>

#include "core/arc_arms.hpp"
#include "flexcomp/arc.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::test;

namespace {

template <typename Scalar>
AdaptiveRobustController<Scalar, 1> make_controller() {
  const Arm<Scalar, 1> arm = pendulum<Scalar>();
  AdaptiveRobustController<Scalar, 1> controller;
  TEST_ASSERT_EQUAL(Result::ok,
                    controller.configure(arm.model, arm.inertia, pendulum_gains<Scalar>()));
  return controller;
}

void the_worked_example_comes_out_tick_by_tick() {
  auto controller = make_controller<double>();
  for (int k = 0; k < 500; ++k) {
    const auto output = controller.tick(pendulum_input<double>(1e-3 * k));
    TEST_ASSERT_EQUAL_UINT32(0, output.status);
    if (k == 0) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 80.5355675876, output.torque[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.02, output.link_surface[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0519947747082, output.motor_surface[0]);
    } else if (k == 1) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 80.3870333681, output.torque[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-11, 0.135046868254, output.link_bound[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-11, 0.441178493914, output.motor_bound[0]);
    } else if (k == 10) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 80.5962922195, output.torque[0]);
    } else if (k == 499) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 93.6213469383, output.torque[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 28.8296662409, output.link_bound[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 16.6356376432, output.motor_bound[0]);
    }
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-10, 4.47239759229, controller.link_parameters()(0, 0));
  TEST_ASSERT_DOUBLE_WITHIN(1e-10, 0.313978705942, controller.link_parameters()(0, 1));
  TEST_ASSERT_DOUBLE_WITHIN(1e-10, 0.147141986083, controller.link_parameters()(0, 2));
}

void single_precision_gives_the_same_torque() {
  auto fine = make_controller<double>();
  auto coarse = make_controller<float>();
  for (int k = 0; k < 500; ++k) {
    const double expected = fine.tick(pendulum_input<double>(1e-3 * k)).torque[0];
    const double actual = coarse.tick(pendulum_input<float>(1e-3 * k)).torque[0];
    TEST_ASSERT_DOUBLE_WITHIN(0.1, expected, actual);
  }
}

void inputs_that_are_no_numbers_are_refused_and_leave_no_trace() {
  using Angles = JointVector<double, 1>;
  using Input = ArcInput<double, 1>;
  auto controller = make_controller<double>();
  auto undisturbed = make_controller<double>();
  int k = 0;
  for (Angles Input::*const part :
       {&Input::link, &Input::link_velocity, &Input::motor, &Input::motor_velocity, &Input::wanted,
        &Input::wanted_velocity, &Input::wanted_acceleration, &Input::external_torque}) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      const Input good = pendulum_input<double>(1e-3 * k++);
      const double torque = controller.tick(good).torque[0];
      const double expected = undisturbed.tick(good).torque[0];
      TEST_ASSERT_EQUAL_DOUBLE(expected, torque);
      Input input = good;
      (input.*part)[0] = bad;
      const auto refused = controller.tick(input);
      TEST_ASSERT_EQUAL_UINT32(kArcInputNotFinite, refused.status);
      TEST_ASSERT_EQUAL_DOUBLE(torque, refused.torque[0]);
    }
  }
}

void input_too_large_to_compute_with_is_refused_by_name() {
  auto controller = make_controller<float>();
  controller.tick(pendulum_input<float>(0));
  ArcInput<float, 1> input = pendulum_input<float>(0);
  input.link_velocity[0] = std::numeric_limits<float>::max();
  TEST_ASSERT_EQUAL_UINT32(kArcNotComputable, controller.tick(input).status);
  TEST_ASSERT_EQUAL_UINT32(0, controller.tick(pendulum_input<float>(0)).status);
}

template <typename Scalar>
void hostile_inputs_leave_torque_and_state_bounded() {
  auto controller = make_controller<Scalar>();
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  // The constant parameter never passes the bound. Another grows by ½ √(Γ/Γ of the constant) of the
  // bound in a tick at most, where its regressor is most favourable, and the leak takes 1/200.
  const auto largest = static_cast<Scalar>(0.5 * std::sqrt(160.0 / 360) * 80 * 201);
  for (int k = 0; k < 20000; ++k) {
    const double size = std::pow(10.0, 20 * uniform(random));
    const auto draw = [&] {
      return JointVector<Scalar, 1>(static_cast<Scalar>(size * uniform(random)));
    };
    const ArcInput<Scalar, 1> input = {draw(), draw(), draw(), draw(),
                                       draw(), draw(), draw(), draw()};
    const auto output = controller.tick(input);
    TEST_ASSERT_TRUE(std::isfinite(output.torque[0]) && std::abs(output.torque[0]) <= Scalar(400));
    TEST_ASSERT_TRUE(output.link_bound[0] >= Scalar(0) && output.link_bound[0] <= Scalar(80));
    TEST_ASSERT_TRUE(output.motor_bound[0] >= Scalar(0) && output.motor_bound[0] <= Scalar(60));
    TEST_ASSERT_TRUE(controller.link_parameters().allFinite());
    TEST_ASSERT_TRUE(controller.motor_parameters().allFinite());
    TEST_ASSERT_TRUE(controller.link_parameters().minCoeff() >= Scalar(0));
    TEST_ASSERT_TRUE(controller.motor_parameters().minCoeff() >= Scalar(0));
    TEST_ASSERT_TRUE(controller.link_parameters().maxCoeff() <= largest);
    TEST_ASSERT_TRUE(controller.motor_parameters().maxCoeff() <= largest);
  }
}

/// A joint held fast: the surface stays away from zero, and nothing may wind up.
void adaptation_stops_at_its_limit_and_at_the_torque_limit() {
  const Arm<double, 1> arm = pendulum<double>();
  ArcGains<double, 1> gains = pendulum_gains<double>();
  gains.torque_limit[0] = 2000;
  AdaptiveRobustController<double, 1> controller;
  TEST_ASSERT_EQUAL(Result::ok, controller.configure(arm.model, arm.inertia, gains));
  ArcInput<double, 1> input = pendulum_input<double>(0);
  input.wanted_velocity.setZero();
  input.link_velocity.setZero();
  input.motor_velocity.setZero();
  input.motor = input.link;
  input.wanted = input.link;
  controller.tick(input);
  input.wanted[0] += 0.02;
  std::uint32_t status = 0;
  for (int k = 0; k < 5000; ++k) {
    const auto output = controller.tick(input);
    status |= output.status;
    TEST_ASSERT_TRUE(output.link_bound[0] <= 80);
  }
  TEST_ASSERT_TRUE((status & kArcBoundLimited) != 0);
  input.wanted[0] += 1;  // asks for far more torque than there is
  const auto before = controller.link_parameters();
  TEST_ASSERT_TRUE((controller.tick(input).status & kArcTorqueLimited) != 0);
  TEST_ASSERT_TRUE(controller.link_parameters().norm() < before.norm());
}

/// The robust term is continuous and no steeper than its limit: a small change of the surface never
/// makes a jump of the torque.
void the_torque_is_smooth_across_the_surface() {
  auto adapted = make_controller<double>();
  for (int k = 0; k < 500; ++k) {
    adapted.tick(pendulum_input<double>(1e-3 * k));
  }
  const ArcInput<double, 1> base = pendulum_input<double>(0.5);
  double before = 0;
  for (int i = -1000; i <= 1000; ++i) {
    auto controller = adapted;
    ArcInput<double, 1> input = base;
    input.link_velocity[0] += 1e-4 * i;
    const double wanted = controller.tick(input).wanted_elastic_torque[0];
    // Slope: D (S₁ + k_v) = 220 and the limit of 160 N·m·s/rad, and little from the bound itself.
    TEST_ASSERT_TRUE(i == -1000 || std::abs(wanted - before) < 1e-4 * 440);
    before = wanted;
  }
}

void a_measured_load_is_carried_by_the_feed_forward() {
  auto with = make_controller<double>();
  auto without = make_controller<double>();
  ArcInput<double, 1> input = pendulum_input<double>(0);
  const double before = without.tick(input).wanted_elastic_torque[0];
  input.external_torque[0] = 30;
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, before - 30, with.tick(input).wanted_elastic_torque[0]);
}

void a_configuration_that_cannot_work_is_refused() {
  using Gains = ArcGains<double, 1>;
  const Arm<double, 1> arm = pendulum<double>();
  AdaptiveRobustController<double, 1> controller;
  const auto refused = [&](const Gains& gains) {
    return controller.configure(arm.model, arm.inertia, gains) == Result::bad_config;
  };
  for (double Gains::*const part : {&Gains::period, &Gains::link_damping, &Gains::motor_damping,
                                    &Gains::filter_frequency, &Gains::leak}) {
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      Gains gains = pendulum_gains<double>();
      gains.*part = bad;
      TEST_ASSERT_TRUE(refused(gains));
    }
  }
  using Angles = JointVector<double, 1>;
  for (Angles Gains::*const part :
       {&Gains::rotor_inertia, &Gains::viscous, &Gains::link_rate, &Gains::motor_rate,
        &Gains::motor_stiffness, &Gains::link_gain, &Gains::motor_gain, &Gains::link_gain_limit,
        &Gains::motor_gain_limit, &Gains::link_bound_limit, &Gains::motor_bound_limit,
        &Gains::torque_limit}) {
    for (const double bad : {-1.0, std::nan("")}) {
      Gains gains = pendulum_gains<double>();
      (gains.*part)[0] = bad;
      TEST_ASSERT_TRUE(refused(gains));
    }
  }
  Gains gains = pendulum_gains<double>();
  gains.link_adaptation(0, 1) = 0;
  TEST_ASSERT_TRUE(refused(gains));
  gains = pendulum_gains<double>();
  gains.motor_adaptation(0, 2) = std::nan("");
  TEST_ASSERT_TRUE(refused(gains));
  gains = pendulum_gains<double>();
  gains.filter_frequency = 1001;
  TEST_ASSERT_TRUE(refused(gains));
  gains = pendulum_gains<double>();
  gains.motor_gain_limit[0] = 251;
  TEST_ASSERT_TRUE(refused(gains));
  gains = pendulum_gains<double>();
  gains.link_gain[0] = 0;
  TEST_ASSERT_TRUE(refused(gains));
  Arm<double, 1> stiff = arm;
  stiff.model.joints[0].compliance = 0;
  TEST_ASSERT_EQUAL(Result::bad_model,
                    controller.configure(stiff.model, stiff.inertia, pendulum_gains<double>()));
  const auto output = controller.tick(pendulum_input<double>(0));
  TEST_ASSERT_EQUAL_UINT32(kArcNotConfigured, output.status);
  TEST_ASSERT_EQUAL_DOUBLE(0, output.torque[0]);
}

void it_goes_on_with_what_was_adapted_before() {
  auto before = make_controller<double>();
  for (int k = 0; k < 500; ++k) {
    before.tick(pendulum_input<double>(1e-3 * k));
  }
  auto again = make_controller<double>();
  TEST_ASSERT_EQUAL(Result::ok,
                    again.set_parameters(before.link_parameters(), before.motor_parameters()));
  const auto input = pendulum_input<double>(0.5);
  const double expected = before.tick(input).link_bound[0];
  const double actual = again.tick(input).link_bound[0];
  TEST_ASSERT_EQUAL_DOUBLE(expected, actual);
  again.restart();
  TEST_ASSERT_EQUAL_DOUBLE(0, again.link_parameters().norm());
  auto refused = input;
  refused.link[0] = std::nan("");
  TEST_ASSERT_EQUAL_DOUBLE(0, again.tick(refused).torque[0]);
  TEST_ASSERT_EQUAL(Result::bad_argument,
                    again.set_parameters(-before.link_parameters(), before.motor_parameters()));
  TEST_ASSERT_EQUAL(
      Result::bad_argument,
      again.set_parameters(before.link_parameters() * std::nan(""), before.motor_parameters()));
}

void every_status_has_a_name() {
  for (const ArcStatusBit bit : {kArcInputNotFinite, kArcNotComputable, kArcNotConfigured,
                                 kArcTorqueLimited, kArcBoundLimited}) {
    TEST_ASSERT_TRUE(std::string_view(describe(bit)) != "unknown bit");
  }
  TEST_ASSERT_EQUAL_STRING("unknown bit", describe(static_cast<ArcStatusBit>(1U << 30)));
}

template <int Joints>
void arms_at_rest_are_held_up() {
  const Arm<float, Joints> arm = skew_arm<float, Joints>();
  AdaptiveRobustController<float, Joints> controller;
  TEST_ASSERT_EQUAL(Result::ok,
                    controller.configure(arm.model, arm.inertia, plain_gains<Joints>()));
  ArcInput<float, Joints> input;
  InverseDynamics<float, Joints> dynamics;
  TEST_ASSERT_EQUAL(Result::ok, dynamics.configure(arm.model, arm.inertia));
  const auto weight = dynamics.torque(input.link, input.link, input.link, input.link);
  input.motor = weight * 1e-6F;  // at rest, springs holding the weight
  const auto output = controller.tick(input);
  TEST_ASSERT_EQUAL_UINT32(0, output.status);
  TEST_ASSERT_TRUE((output.torque - weight).norm() < 1e-3F * weight.norm());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_worked_example_comes_out_tick_by_tick);
  RUN_TEST(single_precision_gives_the_same_torque);
  RUN_TEST(inputs_that_are_no_numbers_are_refused_and_leave_no_trace);
  RUN_TEST(input_too_large_to_compute_with_is_refused_by_name);
  RUN_TEST(hostile_inputs_leave_torque_and_state_bounded<float>);
  RUN_TEST(hostile_inputs_leave_torque_and_state_bounded<double>);
  RUN_TEST(adaptation_stops_at_its_limit_and_at_the_torque_limit);
  RUN_TEST(the_torque_is_smooth_across_the_surface);
  RUN_TEST(a_measured_load_is_carried_by_the_feed_forward);
  RUN_TEST(a_configuration_that_cannot_work_is_refused);
  RUN_TEST(it_goes_on_with_what_was_adapted_before);
  RUN_TEST(every_status_has_a_name);
  RUN_TEST(arms_at_rest_are_held_up<6>);
  RUN_TEST(arms_at_rest_are_held_up<7>);
  return UNITY_END();
}
