// Velocities and accelerations of recorded angles against closed forms, by exact and by coarse
// encoders.
#include <algorithm>
#include <cmath>

#include "recording/noise.hpp"
#include "simulation/windows.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using flexcomp::recording::encoder_noise;
using namespace flexcomp::simulation;

namespace {

constexpr Index kRows = 1000;
constexpr double kStep = 0.01;   // s
constexpr double kCount = 4e-4;  // rad, of a coarse encoder
constexpr double kSwing = 0.3;   // rad
constexpr double kOmega = 3;     // rad/s

VectorXd times() { return VectorXd::LinSpaced(kRows, 0, kStep * (kRows - 1)); }

VectorXd swing() { return kSwing * (kOmega * times().array()).sin(); }

VectorXd in_counts(const VectorXd& angle) { return kCount * (angle / kCount).array().round(); }

/// One joint by its readings.
struct Encoder {
  explicit Encoder(const VectorXd& angle)
      : time(times()),
        q(angle),
        noise(RowVectorXd::Constant(1, encoder_noise(time, angle))),
        suited(best_polynomials(time, q, noise).front()) {}

  std::size_t window() const {
    const auto* const all = kHalfWindows.data();
    return static_cast<std::size_t>(
        std::find(all, all + kHalfWindows.size(), suited.inner.half_window) - all);
  }
  LocalMotion motion(std::size_t window, Index row) const {
    return local_motion(time, q, noise, {{kHalfWindows[window]}, suited.end}, row);
  }

  /// Root mean square errors of velocity and acceleration, away from the ends, of the swing and of
  /// a ripple beside it of so many radians at an angular frequency.
  Eigen::Vector2d errors(std::size_t window, double ripple = 0, double frequency = 1) const {
    constexpr Index kEnds = 60;
    Eigen::Vector2d squares = Eigen::Vector2d::Zero();
    for (Index row = kEnds; row < kRows - kEnds; ++row) {
      const Eigen::Vector2d exact = motion_of(kSwing, kOmega * time[row], kOmega) +
                                    motion_of(ripple, frequency * time[row], frequency);
      squares += (motion(window, row).values.col(0) - exact).cwiseAbs2();
    }
    return (squares / static_cast<double>(kRows - 2 * kEnds)).cwiseSqrt();
  }

  /// Velocity and acceleration of a sine.
  static Eigen::Vector2d motion_of(double size, double phase, double frequency) {
    return {size * frequency * std::cos(phase), -size * frequency * frequency * std::sin(phase)};
  }

  VectorXd time;
  flexcomp::recording::Samples q;
  RowVectorXd noise;
  JointPolynomials suited;
};

void a_swing_by_an_exact_encoder_keeps_the_shortest_window() {
  const Encoder exact(swing());
  TEST_ASSERT_EQUAL_UINT64(0, exact.window());
  // Three neighbours either side: the seventh derivative over seven factorial cuts the velocity by
  // 36 h^6, the eighth over eight factorial the acceleration by 2 × 49 h^6 at most.
  const Eigen::Vector2d errors = exact.errors(0);
  TEST_ASSERT_TRUE(errors[0] < 1e-6 * kSwing * kOmega);
  TEST_ASSERT_TRUE(errors[1] < 1e-4 * kSwing * kOmega * kOmega);
}

void a_swing_by_a_coarse_encoder_takes_a_longer_window_and_errs_by_much_less() {
  const Encoder coarse(in_counts(swing()));
  const std::size_t window = coarse.window();
  TEST_ASSERT_TRUE(window > 0);
  TEST_ASSERT_TRUE(coarse.errors(window)[1] < 0.05 * coarse.errors(0)[1]);
  TEST_ASSERT_TRUE(coarse.errors(window)[1] < 0.05 * kSwing * kOmega * kOmega);
  TEST_ASSERT_TRUE(coarse.errors(window)[0] < 0.01 * kSwing * kOmega);
}

void the_window_taken_errs_little_more_than_the_best_one() {
  constexpr double kRipple = 2e-3;     // rad
  constexpr double kLittleMore = 1.7;  // what a window cuts of 10 s, noise hides up to its own size
  for (const double hertz : {0.8, 1.5, 2.5, 4.0}) {
    const double frequency = 2 * M_PI * hertz;
    const VectorXd ripple = kRipple * (frequency * times().array()).sin();
    const Encoder coarse(in_counts(swing() + ripple));
    double least = coarse.errors(0, kRipple, frequency)[1];
    for (std::size_t window = 1; window < kHalfWindows.size(); ++window) {
      least = std::min(least, coarse.errors(window, kRipple, frequency)[1]);
    }
    TEST_ASSERT_TRUE(coarse.errors(coarse.window(), kRipple, frequency)[1] < kLittleMore * least);
  }
}

double half_window_of(const VectorXd& time, const VectorXd& angle) {
  const VectorXd read = in_counts(angle);
  const RowVectorXd noise = RowVectorXd::Constant(1, encoder_noise(time, read));
  return best_polynomials(time, read, noise).front().inner.half_window;
}

/// A joint swings for three seconds, comes to a creep in another three, and creeps for four. Its
/// encoder counts at an even pace then, which no polynomial may take for motion.
void a_joint_that_creeps_for_a_while_has_the_window_of_its_motion() {
  const VectorXd time = VectorXd::LinSpaced(10 * kRows, 0, 10);
  const VectorXd swings = kSwing * (kOmega * time.array()).sin();
  const VectorXd fade = ((6 - time.array()) / 3).max(0).min(1);
  const VectorXd fades = swings.array() * (M_PI / 2 * fade.array()).sin().pow(4);
  for (const double counts : {10, 12, 15, 20, 25, 30, 40}) {  // 1/s
    TEST_ASSERT_TRUE(half_window_of(time, fades + kCount * counts * time) >=
                     0.7 * half_window_of(time, swings));
  }
}

/// Largest error of the acceleration within the window of an end.
double error_near_ends(const Encoder& encoder, std::size_t window) {
  double most = 0;
  for (Index i = 0; i < 20; ++i) {
    for (const Index row : {i, kRows - 1 - i}) {
      const double exact = -kSwing * kOmega * kOmega * std::sin(kOmega * encoder.time[row]);
      most = std::max(most, std::abs(encoder.motion(window, row).values(1, 0) - exact));
    }
  }
  return most;
}

void a_coarse_encoder_tells_the_acceleration_at_the_ends_nearly_as_well() {
  const Encoder coarse(in_counts(swing()));
  // A polynomial of fifth order errs by 5 rad/s² there, twice as much as the whole acceleration.
  TEST_ASSERT_TRUE(error_near_ends(coarse, coarse.window()) < 0.2 * kSwing * kOmega * kOmega);
}

void what_the_ends_cut_of_a_motion_is_doubted() {
  const Encoder forward(swing());
  const Encoder backward(swing().reverse());
  const Polynomials abrupt{0.2, 2};
  for (const Index row : {0, 2, 4}) {
    const double exact = -kSwing * kOmega * kOmega * std::sin(kOmega * forward.time[row]);
    for (const LocalMotion& motion :
         {local_motion(forward.time, forward.q, forward.noise, {{0.2}, abrupt}, row),
          local_motion(backward.time, backward.q, backward.noise, {{0.2}, abrupt},
                       kRows - 1 - row)}) {
      const double error = exact - motion.values(1, 0);
      TEST_ASSERT_TRUE(std::abs(error) > 0.2 * kSwing * kOmega * kOmega);
      TEST_ASSERT_DOUBLE_WITHIN(0.1 * std::abs(error), error, motion.doubt[0]);
    }
  }
}

void a_window_is_no_longer_than_the_motion_bears_though_noise_hides_what_it_cuts() {
  // A ripple of 6 Hz: beside the noise of the shortest window, 13 rad/s², nothing shows of what a
  // longer one cuts of it.
  constexpr double kRipple = 2 * M_PI * 6;  // rad/s
  const VectorXd ripple = 1.5e-3 * (kRipple * times().array()).sin();
  const Encoder coarse(in_counts(swing() + ripple));
  const std::size_t window = coarse.window();
  TEST_ASSERT_TRUE(window > 0);
  TEST_ASSERT_TRUE(kHalfWindows[window] < 0.14);
  TEST_ASSERT_TRUE(kHalfWindows[Encoder(in_counts(swing())).window()] > kHalfWindows[window]);
}

/// Of readings that flicker by a count, as an encoder's do between two counts, from `row` on.
VectorXd flickering() {
  VectorXd angle(kRows);
  for (Index row = 0; row < kRows; ++row) {
    angle[row] = row * row % 7 < 3 ? 0 : kCount;
  }
  return angle;
}

void a_joint_that_stands_is_said_to_stand_whatever_its_encoder() {
  for (const VectorXd& angle : {VectorXd(VectorXd::Constant(kRows, 0.7)), flickering()}) {
    const Encoder encoder(angle);
    for (const std::size_t window : {encoder.window(), kHalfWindows.size() - 1}) {
      const LocalMotion motion = encoder.motion(window, kRows / 2);
      TEST_ASSERT_EQUAL_INT(1, motion.stands[0]);
      TEST_ASSERT_TRUE(motion.values.isZero(0));
    }
  }
}

void a_joint_that_moves_by_a_count_a_row_and_less_does_not_stand() {
  for (const double speed : {0.04, 0.02, 0.01}) {  // rad/s
    const Encoder coarse(in_counts(speed * times()));
    const LocalMotion motion = coarse.motion(coarse.window(), kRows / 2);
    TEST_ASSERT_EQUAL_INT(0, motion.stands[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.2 * speed, speed, motion.values(0, 0));
  }
}

void a_joint_that_starts_is_said_to_stand_where_it_starts() {
  const VectorXd moved = 0.2 * (times().array() - 5).max(0);  // from 5 s on
  const Encoder coarse(in_counts(moved));
  const std::size_t longest = kHalfWindows.size() - 1;
  TEST_ASSERT_EQUAL_INT(1, coarse.motion(longest, 500).stands[0]);
  TEST_ASSERT_EQUAL_INT(0, coarse.motion(longest, 600).stands[0]);
}

/// Power that polynomials pass of a sine (Hz), away from the ends.
double passed_power(double frequency, double half_window) {
  constexpr Eigen::Index kSamples = 2000;
  constexpr double kRate = 2000;  // Hz
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(kSamples, 0, (kSamples - 1) / kRate);
  const Eigen::VectorXd sine = (2 * M_PI * frequency * time.array()).sin();
  const Eigen::VectorXd smooth = smoothed(time, sine, half_window);
  return smooth.segment(500, 1000).squaredNorm() / sine.segment(500, 1000).squaredNorm();
}

void polynomials_pass_what_is_slow_and_half_of_the_power_where_they_say() {
  for (const double half_window : {0.025, 0.07}) {
    const double frequency = half_power_frequency(half_window);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1, passed_power(0.3 * frequency, half_window));
    TEST_ASSERT_DOUBLE_WITHIN(0.03, 0.5, passed_power(frequency, half_window));
    TEST_ASSERT_TRUE(passed_power(4 * frequency, half_window) < 0.05);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_swing_by_an_exact_encoder_keeps_the_shortest_window);
  RUN_TEST(a_swing_by_a_coarse_encoder_takes_a_longer_window_and_errs_by_much_less);
  RUN_TEST(the_window_taken_errs_little_more_than_the_best_one);
  RUN_TEST(a_joint_that_creeps_for_a_while_has_the_window_of_its_motion);
  RUN_TEST(a_coarse_encoder_tells_the_acceleration_at_the_ends_nearly_as_well);
  RUN_TEST(what_the_ends_cut_of_a_motion_is_doubted);
  RUN_TEST(a_window_is_no_longer_than_the_motion_bears_though_noise_hides_what_it_cuts);
  RUN_TEST(a_joint_that_stands_is_said_to_stand_whatever_its_encoder);
  RUN_TEST(a_joint_that_moves_by_a_count_a_row_and_less_does_not_stand);
  RUN_TEST(a_joint_that_starts_is_said_to_stand_where_it_starts);
  RUN_TEST(polynomials_pass_what_is_slow_and_half_of_the_power_where_they_say);
  return UNITY_END();
}
