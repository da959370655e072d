#include <cmath>

#include "error.hpp"
#include "study/milling_force.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::study;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// An aluminium alloy, a 16 mm end mill; nothing hangs on the numbers.
EndMilling some_milling(MillingMode mode, double helix) {
  EndMilling milling;
  milling.diameter = 0.016;
  milling.teeth = 4;
  milling.helix = helix;
  milling.depth = 0.006;
  milling.width = 0.005;
  milling.feed_per_tooth = 8e-5;
  milling.mode = mode;
  milling.coefficients = {700e6, 210e6, 110e6, 24e3, 28e3, 3e3};
  return milling;
}

void assert_mean_is(const Vector3<double>& expected, const EndMilling& milling, int steps,
                    double relative) {
  const Wrench<double> got = mean_wrench(milling, steps);
  for (int i = 0; i < 3; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(relative * expected.norm(), expected[i], got[i]);
  }
}

/// Altintas, ch. 2: the closed form for slots.
void slots_have_the_published_mean_force() {
  const EndMilling milling = some_milling(MillingMode::slot, 0);
  const CuttingCoefficients& k = milling.coefficients;
  const double na = milling.teeth * milling.depth;
  const double c = milling.feed_per_tooth;
  const Vector3<double> expected(-na / 4 * k.radial * c - na / kPi * k.radial_edge,
                                 na / 4 * k.tangential * c + na / kPi * k.tangential_edge,
                                 na / kPi * k.axial * c + na / 2 * k.axial_edge);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12 * expected.norm(), 0, (mean_force(milling) - expected).norm());
  assert_mean_is(expected, milling, 7200, 1e-6);
}

void every_mode_has_its_closed_mean_force() {
  for (const MillingMode mode : {MillingMode::slot, MillingMode::up, MillingMode::down}) {
    const EndMilling milling = some_milling(mode, 0.5);
    assert_mean_is(mean_force(milling), milling, 36000, 1e-6);
  }
}

/// Long teeth that wind around the tool several times.
void a_steep_helix_changes_no_mean() {
  EndMilling milling = some_milling(MillingMode::up, 1.4);
  milling.depth = 0.04;
  assert_mean_is(mean_force(milling), milling, 36000, 1e-6);
}

/// A rectangle rule over the edge, written here once more.
void the_helix_is_integrated_along_the_edge() {
  const EndMilling milling = some_milling(MillingMode::down, 0.6);
  const Engagement cut = engagement(milling);
  const CuttingCoefficients& k = milling.coefficients;
  constexpr int kSlices = 200000;
  for (const double angle : {0.3, 1.9, 2.8, 4.4}) {
    double x = 0;
    double y = 0;
    for (int tooth = 0; tooth < milling.teeth; ++tooth) {
      for (int i = 0; i < kSlices; ++i) {
        const double z = milling.depth * (i + 0.5) / kSlices;
        double phi = angle - tooth * kPi / 2 - 2 * std::tan(milling.helix) / milling.diameter * z;
        phi -= 2 * kPi * std::floor(phi / (2 * kPi));
        if (phi >= cut.entry && phi <= cut.exit) {
          const double chip = milling.feed_per_tooth * std::sin(phi);
          const double t = k.tangential * chip + k.tangential_edge;
          const double r = k.radial * chip + k.radial_edge;
          x += (-t * std::cos(phi) - r * std::sin(phi)) * milling.depth / kSlices;
          y += (t * std::sin(phi) - r * std::cos(phi)) * milling.depth / kSlices;
        }
      }
    }
    const Wrench<double> got = instantaneous_wrench(milling, angle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, x, got[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, y, got[1]);
  }
}

/// The power of the spindle is the force times its way.
void the_torque_is_the_tangential_force_at_the_radius() {
  EndMilling milling = some_milling(MillingMode::up, 0);
  milling.coefficients.radial = milling.coefficients.radial_edge = 0;
  const Engagement cut = engagement(milling);
  const double angle = cut.exit / 2;  // one tooth is in the cut
  const Wrench<double> got = instantaneous_wrench(milling, angle);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, got.head<2>().norm() * milling.diameter / 2, got[5]);
}

void runout_moves_chip_from_tooth_to_tooth_and_keeps_the_volume() {
  EndMilling milling = some_milling(MillingMode::slot, 0);
  milling.coefficients.tangential_edge = milling.coefficients.radial_edge = 0;
  milling.coefficients.axial_edge = 0;
  milling.runout = 1e-5;
  milling.runout_angle = 0.4;
  const Wrench<double> with = mean_wrench(milling, 36000);
  const Vector3<double> without = mean_force(milling);
  // Thin chips at the ends of the cut are lost to some teeth: the mean is kept but for that.
  TEST_ASSERT_DOUBLE_WITHIN(0.02 * without.norm(), 0, (with.head<3>() - without).norm());
  double least = 1e9;
  double most = 0;
  for (int tooth = 0; tooth < milling.teeth; ++tooth) {
    const double force = instantaneous_wrench(milling, kPi / 2 + tooth * kPi / 2).head<3>().norm();
    least = std::min(least, force);
    most = std::max(most, force);
  }
  TEST_ASSERT_TRUE(most > 1.1 * least);
}

void without_runout_all_teeth_are_alike() {
  const EndMilling milling = some_milling(MillingMode::up, 0.3);
  for (const double angle : {0.1, 0.7, 1.3}) {
    const Wrench<double> one = instantaneous_wrench(milling, angle);
    const Wrench<double> next = instantaneous_wrench(milling, angle + kPi / 2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * one.norm(), 0, (one - next).norm());
  }
}

void impossible_milling_is_refused() {
  const auto is_refused = [](void (*spoil)(EndMilling*)) {
    EndMilling milling = some_milling(MillingMode::up, 0.3);
    spoil(&milling);
    try {
      check(milling);
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  TEST_ASSERT_FALSE(is_refused([](EndMilling*) {}));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->diameter = 0; }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->teeth = 0; }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->width = 0.1; }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->helix = 1.6; }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->coefficients.radial = -1; }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->feed_per_tooth = std::nan(""); }));
  TEST_ASSERT_TRUE(is_refused([](EndMilling* m) { m->runout = 1; }));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(slots_have_the_published_mean_force);
  RUN_TEST(every_mode_has_its_closed_mean_force);
  RUN_TEST(a_steep_helix_changes_no_mean);
  RUN_TEST(the_helix_is_integrated_along_the_edge);
  RUN_TEST(the_torque_is_the_tangential_force_at_the_radius);
  RUN_TEST(runout_moves_chip_from_tooth_to_tooth_and_keeps_the_volume);
  RUN_TEST(without_runout_all_teeth_are_alike);
  RUN_TEST(impossible_milling_is_refused);
  return UNITY_END();
}
