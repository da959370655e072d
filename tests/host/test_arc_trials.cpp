// Trials of adaptive robust control: simulated time is the controller's time.
#include "control/arc_trials.hpp"
#include "control/dynamic_milling.hpp"
#include "core/arc_arms.hpp"
#include "error.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::control;

namespace {

void a_trial_runs_at_the_period_of_its_gains() {
  Trial<2> trial = two_link_trial();
  trial.design.gains.period = 5e-4;
  trial.duration = 0.1;
  for (const TrialRun<2>& run : run_trial(trial)) {
    // A sample is kept every 20 ticks.
    TEST_ASSERT_EQUAL(10, run.time.size());
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20 * 5e-4, run.time[1] - run.time[0]);
  }
}

/// Counts ticks of the controller between setpoints, and refusals.
int ticks_in(double period, double control_period) {
  const auto links = flexcomp::test::skew_arm<double>();
  simulation::FlexibleArm<6> arm{links.model, links.inertia};
  arm.rotor_inertia.setConstant(10);
  int ticks = 0;
  const auto count = [&ticks](const ArcInput<double, 6>&) -> JointVector<double, 6> {
    ++ticks;
    return JointVector<double, 6>::Zero();
  };
  try {
    DynamicMillingRobot robot(arm, simulation::Process(), count, period, control_period);
    robot.stand(JointVector<double, 6>::Zero(), simulation::Contour::Point(), 0);
  } catch (const InputError&) {
    return -1;
  }
  return ticks;
}

void the_controller_runs_at_its_own_period_between_setpoints() {
  TEST_ASSERT_EQUAL(4, ticks_in(0.004, 0.001));
  TEST_ASSERT_EQUAL(8, ticks_in(0.004, 0.0005));
  TEST_ASSERT_EQUAL(3, ticks_in(0.0003, 0.0001));
  TEST_ASSERT_EQUAL(1, ticks_in(0.001, 0.001));
}

void setpoints_out_of_step_with_the_controller_are_refused() {
  TEST_ASSERT_EQUAL(-1, ticks_in(0.0015, 0.001));
  TEST_ASSERT_EQUAL(-1, ticks_in(0.0005, 0.001));
  TEST_ASSERT_EQUAL(-1, ticks_in(0.0041, 0.001));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_trial_runs_at_the_period_of_its_gains);
  RUN_TEST(the_controller_runs_at_its_own_period_between_setpoints);
  RUN_TEST(setpoints_out_of_step_with_the_controller_are_refused);
  return UNITY_END();
}
