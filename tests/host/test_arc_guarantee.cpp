// Adaptive robust control on arms drawn from the fuzzy sets' supports: its guarantee, and what it
// is worth against the motors' own servo.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "control/arc_design.hpp"
#include "control/tracking.hpp"
#include "error.hpp"
#include "simulation/sample_arms.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::control;
using namespace flexcomp::simulation;

namespace {

constexpr unsigned kArms = 1000;  // half of one link, half of two
constexpr unsigned kRivals = 50;
constexpr double kStartError = 0.03;                 // rad
constexpr double kAmplitude = 0.4;                   // rad
constexpr double kFrequency = 2 * 3.14159265 * 0.4;  // rad/s

ArmUncertainty uncertainty() {
  ArmUncertainty set;
  set.link_mass = FuzzyNumber::triangular(0.8, 1, 1.3);
  set.stiffness = FuzzyNumber::trapezoidal(0.7, 0.9, 1.05, 1.2);
  set.rotor_inertia = FuzzyNumber::triangular(0.85, 1, 1.15);
  set.viscous = FuzzyNumber::triangular(0.5, 1, 2);
  set.coulomb = FuzzyNumber::tabulated({{0, 0}, {0.5, 0.8}, {1, 1}, {1.5, 0}});
  set.joint_load = FuzzyNumber::triangular(0, 4, 8);
  set.start_error = FuzzyNumber::triangular(-kStartError, 0, kStartError);
  return set;
}

ArmUncertainty uncertainty_with_payload() {
  ArmUncertainty set = uncertainty();
  set.payload = FuzzyNumber::triangular(0, 1, 3);
  return set;
}

MotionLimits motion() {
  return {kAmplitude * kFrequency, kAmplitude * kFrequency * kFrequency,
          kAmplitude * kFrequency * kFrequency * kFrequency};
}

/// Every joint swings, the outer ones less; the load swings at 3 Hz.
template <int Joints>
TrackingJob<Joints> swing(const DrawnArm<Joints>& drawn, std::mt19937_64* random) {
  using Angles = JointVector<double, Joints>;
  TrackingJob<Joints> job;
  job.arm = drawn.arm;
  Angles size;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    size[i] = kAmplitude / static_cast<double>(i + 1);
    job.start_error[i] = std::uniform_real_distribution<double>(-kStartError, kStartError)(*random);
  }
  job.reference = [size](double time) {
    const double phase = kFrequency * time;
    return Reference<Joints>{size * (0.5 - std::cos(phase)), size * kFrequency * std::sin(phase),
                             size * kFrequency * kFrequency * std::cos(phase)};
  };
  job.load = [load = drawn.joint_load](double time, const Angles&) -> Angles {
    return Angles::Constant(load * std::sin(6 * 3.14159265 * time));
  };
  return job;
}

/// Σ (α̂ − α)ᵀ Γ⁻¹ (α̂ − α), with α at the far ends of the supports.
template <int Count, int Joints, typename Parts>
double parameter_error(const Eigen::Matrix<double, Joints, Count>& parameters, const Parts& parts,
                       const Eigen::Matrix<double, Joints, Count>& rates) {
  double sum = 0;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    for (Eigen::Index m = 0; m < Count; ++m) {
      const double off = parameters(i, m) - parts[static_cast<std::size_t>(i)]
                                                .parameters[static_cast<std::size_t>(m)]
                                                .support()
                                                .upper;
      sum += off * off / rates(i, m);
    }
  }
  return sum;
}

/// J, the Lyapunov function itself, with the true arm's inertia and springs.
template <int Joints>
double lyapunov(const FlexibleArm<Joints>& drawn, const InverseDynamics<double, Joints>& weightless,
                const ArcDesign<Joints>& design, const ArcInput<double, Joints>& input,
                const ArcOutput<double, Joints>& output, double link_parameters,
                double motor_parameters) {
  using Angles = JointVector<double, Joints>;
  const ArcGuarantee& promise = design.guarantee;
  const Angles momentum =  // D s₁
      weightless.torque(input.link, Angles::Zero(), Angles::Zero(), output.link_surface);
  const Angles error = input.link - input.wanted;
  const double link = output.link_surface.dot(momentum) +
                      error.dot(drawn.stiffness().cwiseProduct(error)) +
                      promise.stiffness_share * link_parameters;
  const double motor =
      output.motor_surface.dot(drawn.rotor_inertia.cwiseProduct(output.motor_surface)) +
      output.motor_error.dot(design.gains.motor_stiffness.cwiseProduct(output.motor_error)) +
      motor_parameters;
  return (link + promise.coupling * motor) / 2;
}

/// How near one run comes to the guarantee: the largest share of any radius that is reached.
struct Reached {
  double before = 0;    ///< of the uniform bound, until the ultimate one holds
  double after = 0;     ///< of the ultimate bound
  double function = 0;  ///< of what bounds the Lyapunov function at each moment
};

template <int Joints>
void hold_to_guarantee(const FlexibleArm<Joints>& arm, const ArmUncertainty& set,
                       const ArcDesign<Joints>& design, std::mt19937_64* random, Reached* reached) {
  const ArcGuarantee& promise = design.guarantee;
  const double ultimate = 1.05 * promise.bound.residual();
  const double from = promise.bound.time_to(ultimate, promise.start);
  AdaptiveRobustController<double, Joints> controller;
  TEST_ASSERT_EQUAL(Result::ok, controller.configure(arm.model, arm.inertia, design.gains));
  const DrawnArm<Joints> drawn = draw_arm(arm, set, random);
  FlexibleArm<Joints> floating = drawn.arm;
  floating.model.gravity.setZero();
  InverseDynamics<double, Joints> weightless;
  TEST_ASSERT_EQUAL(Result::ok, weightless.configure(floating.model, floating.inertia));
  TrackingJob<Joints> job = swing(drawn, random);
  job.duration = from + 1.5;
  job.settled = from;
  ArcOutput<double, Joints> output;
  JointVector<double, Joints> before = JointVector<double, Joints>::Zero();
  const auto control = [&](const ArcInput<double, Joints>& input) {
    output = controller.tick(input);
    return output.torque;
  };
  const auto check = [&](double time, const ArcInput<double, Joints>& input, const auto&) {
    // The guarantee presupposes no clamped torque, and as slow a w* as it reckons with.
    TEST_ASSERT_EQUAL_UINT32(0, output.status & kArcTorqueLimited);
    if (time >= from && time > 0) {
      const auto rate = ((output.wanted_elastic_torque - before) / job.period).cwiseAbs().eval();
      TEST_ASSERT_TRUE((rate.array() <= design.elastic_rate.array()).all());
    }
    before = output.wanted_elastic_torque;
    const double level = time < from ? promise.bound.most(promise.start) : ultimate;
    const double link_parameters = parameter_error<3, Joints>(
        controller.link_parameters(), design.link, design.gains.link_adaptation);
    const double motor_parameters = parameter_error<4, Joints>(
        controller.motor_parameters(), design.motor, design.gains.motor_adaptation);
    const double function =
        lyapunov(drawn.arm, weightless, design, input, output, link_parameters, motor_parameters) /
        promise.bound.at(promise.start, time);
    TEST_ASSERT_TRUE(function <= 1);
    reached->function = std::max(reached->function, function);
    const double share =
        std::max({(input.link - input.wanted).norm() / promise.tracking_error(level),
                  output.link_surface.norm() / promise.link_surface(level),
                  output.motor_error.norm() / promise.motor_error(level),
                  std::sqrt(link_parameters) / promise.link_parameters(level),
                  std::sqrt(motor_parameters) / promise.motor_parameters(level)});
    TEST_ASSERT_TRUE(share <= 1);
    double& most = time < from ? reached->before : reached->after;
    most = std::max(most, share);
  };
  track<Joints>(job, control, check);
}

template <int Joints>
void try_guarantee(FlexibleArm<Joints> arm, const ArmUncertainty& set) {
  arm.torque_limit *= 20;  // to begin far off without a clamp, under which nothing is promised
  const ArcDesign<Joints> design = design_arc<Joints>(arm, set, motion(), ArcBandwidth());
  Reached reached;
  for (unsigned seed = 0; seed < kArms / 2; ++seed) {
    std::mt19937_64 random(seed);
    hold_to_guarantee(arm, set, design, &random, &reached);
  }
  std::printf(
      "%d joints, %d arms: at most %.3f of the uniform, %.3f of the ultimate bounds, %.3f of the "
      "one on V\n",
      Joints, static_cast<int>(kArms / 2), reached.before, reached.after, reached.function);
}

void errors_and_parameters_of_one_link_stay_in_the_computed_balls() {
  try_guarantee(one_link_arm(), uncertainty());
}

void errors_and_parameters_of_two_links_stay_in_the_computed_balls() {
  try_guarantee(two_link_arm(), uncertainty_with_payload());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// The servo has the stiffness and damping of the controller's own motor loop, so what tells the
/// two apart is what each knows of the springs; and it spends the same torque.
template <int Joints>
void race_against_the_servo(const FlexibleArm<Joints>& arm, const ArmUncertainty& set) {
  const ArcDesign<Joints> design = design_arc<Joints>(arm, set, motion(), ArcBandwidth());
  std::vector<double> error;
  std::vector<double> effort;
  for (unsigned seed = 0; seed < kRivals; ++seed) {
    std::mt19937_64 random(seed);
    TrackingJob<Joints> job = swing(draw_arm(arm, set, &random), &random);
    job.duration = 5;
    job.settled = 2.5;
    AdaptiveRobustController<double, Joints> controller;
    TEST_ASSERT_EQUAL(Result::ok, controller.configure(arm.model, arm.inertia, design.gains));
    const auto robust = track<Joints>(
        job, [&](const ArcInput<double, Joints>& input) { return controller.tick(input).torque; });
    const auto servo = track<Joints>(job, pd_controller<Joints>(matching_pd<Joints>(design.gains)));
    error.push_back(robust.largest_error.norm() / servo.largest_error.norm());
    effort.push_back(robust.torque.norm() / servo.torque.norm());
  }
  std::printf(
      "%d joints: error %.1f %% of the servo's in the median, %.1f %% at most; torque %.1f %%\n",
      Joints, 100 * median(error), 100 * *std::max_element(error.begin(), error.end()),
      100 * median(effort));
  TEST_ASSERT_TRUE(median(error) <= 0.2);
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 1, median(effort));
}

void one_link_tracks_five_times_as_well_as_its_servo_at_the_same_effort() {
  race_against_the_servo(one_link_arm(), uncertainty());
}

void two_links_track_five_times_as_well_as_their_servo_at_the_same_effort() {
  race_against_the_servo(two_link_arm(), uncertainty_with_payload());
}

/// Springs half as stiff as believed, and the tip loaded far beyond what was designed for.
void an_arm_outside_the_sets_stays_in_hand() {
  const FlexibleArm<2> arm = two_link_arm();
  const ArcDesign<2> design =
      design_arc<2>(arm, uncertainty_with_payload(), motion(), ArcBandwidth());
  std::mt19937_64 random(1);
  DrawnArm<2> drawn{arm};
  drawn.arm.model.payload_mass = 8;
  drawn.arm.model.joints[0].compliance *= 2;
  drawn.arm.model.joints[1].compliance *= 2;
  AdaptiveRobustController<double, 2> controller;
  TEST_ASSERT_EQUAL(Result::ok, controller.configure(arm.model, arm.inertia, design.gains));
  TrackingJob<2> job = swing(drawn, &random);
  const auto figures = track<2>(
      job, [&](const ArcInput<double, 2>& input) { return controller.tick(input).torque; });
  TEST_ASSERT_TRUE(figures.largest_error.maxCoeff() < 0.03);
}

/// Each rate of the proof can be the slowest one.
void the_slowest_rate_decides_how_fast_the_bound_decays() {
  const auto decay = [](double ArcBandwidth::*rate, double value) {
    ArcBandwidth bandwidth;
    bandwidth.*rate = value;
    return design_arc<1>(one_link_arm(), uncertainty(), motion(), bandwidth).guarantee.bound.decay;
  };
  TEST_ASSERT_EQUAL_DOUBLE(4, decay(&ArcBandwidth::link_damping, 4));
  TEST_ASSERT_EQUAL_DOUBLE(4, decay(&ArcBandwidth::link_rate, 2));
  TEST_ASSERT_EQUAL_DOUBLE(4, decay(&ArcBandwidth::motor_rate, 4));
  TEST_ASSERT_EQUAL_DOUBLE(4, decay(&ArcBandwidth::motor_damping, 2));
  TEST_ASSERT_EQUAL_DOUBLE(4, decay(&ArcBandwidth::leak, 4));
}

void an_uncertainty_that_cannot_be_is_refused() {
  int refused = 0;
  const auto attempt = [&](const ArmUncertainty& set) {
    try {
      design_arc<1>(one_link_arm(), set, motion(), ArcBandwidth());
    } catch (const InputError&) {
      ++refused;
    }
  };
  ArmUncertainty set = uncertainty();
  set.stiffness = FuzzyNumber::triangular(0, 1, 2);
  attempt(set);
  set = uncertainty();
  set.joint_load = FuzzyNumber::triangular(-1, 0, 1);
  attempt(set);
  TEST_ASSERT_EQUAL(2, refused);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(errors_and_parameters_of_one_link_stay_in_the_computed_balls);
  RUN_TEST(errors_and_parameters_of_two_links_stay_in_the_computed_balls);
  RUN_TEST(one_link_tracks_five_times_as_well_as_its_servo_at_the_same_effort);
  RUN_TEST(two_links_track_five_times_as_well_as_their_servo_at_the_same_effort);
  RUN_TEST(an_arm_outside_the_sets_stays_in_hand);
  RUN_TEST(the_slowest_rate_decides_how_fast_the_bound_decays);
  RUN_TEST(an_uncertainty_that_cannot_be_is_refused);
  return UNITY_END();
}
