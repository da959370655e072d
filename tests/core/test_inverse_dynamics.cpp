// Modified Newton–Euler against Lagrange's equations and the Christoffel symbols of its own inertia
// matrix, and one closed form. The ordinary case stands against KDL in tests/host.
#include <random>

#include "core/arc_arms.hpp"
#include "flexcomp/chain.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::Arm;
using flexcomp::test::pendulum;
using flexcomp::test::skew_arm;

namespace {

using Angles = JointVector<double, 6>;
using Square = Eigen::Matrix<double, 6, 6>;

InverseDynamics<double, 6> dynamics(bool weight) {
  Arm<double, 6> arm = skew_arm<double>();
  arm.model.gravity *= weight ? 1 : 0;
  InverseDynamics<double, 6> made;
  TEST_ASSERT_EQUAL(Result::ok, made.configure(arm.model, arm.inertia));
  return made;
}

Angles drawn(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-2, 2);
  return Angles::NullaryExpr([&] { return uniform(*random); });
}

Square inertia_matrix(const InverseDynamics<double, 6>& arm, const Angles& q) {
  Square d;
  for (Eigen::Index i = 0; i < 6; ++i) {
    d.col(i) = arm.torque(q, Angles::Zero(), Angles::Zero(), Angles::Unit(i));
  }
  return d;
}

/// ∂D/∂q_k by central differences.
Square slope(const InverseDynamics<double, 6>& arm, const Angles& q, Eigen::Index k) {
  constexpr double kStep = 1e-5;
  return (inertia_matrix(arm, q + kStep * Angles::Unit(k)) -
          inertia_matrix(arm, q - kStep * Angles::Unit(k))) /
         (2 * kStep);
}

void the_velocity_terms_are_those_of_the_christoffel_symbols() {
  const InverseDynamics<double, 6> arm = dynamics(false);
  std::mt19937 random(3);
  for (int trial = 0; trial < 3; ++trial) {
    const Angles q = drawn(&random);
    const Angles velocity = drawn(&random);
    const Angles reference = drawn(&random);
    std::array<Square, 6> slopes;
    for (Eigen::Index k = 0; k < 6; ++k) {
      slopes[static_cast<std::size_t>(k)] = slope(arm, q, k);
    }
    const auto d = [&](Eigen::Index i, Eigen::Index j, Eigen::Index k) {
      return slopes[static_cast<std::size_t>(k)](i, j);
    };
    Angles expected = Angles::Zero();
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = 0; j < 6; ++j) {
        for (Eigen::Index k = 0; k < 6; ++k) {
          expected[i] += (d(i, j, k) + d(i, k, j) - d(j, k, i)) / 2 * velocity[k] * reference[j];
        }
      }
    }
    const Angles actual = arm.torque(q, velocity, reference, Angles::Zero());
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * expected.norm(), 0, (actual - expected).norm());
  }
}

void the_inertia_matrix_is_symmetric_and_positive() {
  const InverseDynamics<double, 6> arm = dynamics(false);
  std::mt19937 random(4);
  const Square d = inertia_matrix(arm, drawn(&random));
  TEST_ASSERT_DOUBLE_WITHIN(1e-12 * d.norm(), 0, (d - d.transpose()).norm());
  for (int i = 0; i < 50; ++i) {
    const Angles x = drawn(&random);
    TEST_ASSERT_TRUE(x.dot(d * x) > 0);
  }
}

/// Weight is the slope of the height of all masses.
void weight_is_the_slope_of_potential_energy() {
  const Arm<double, 6> arm = skew_arm<double>();
  const InverseDynamics<double, 6> with_weight = dynamics(true);
  const auto energy = [&](const Angles& q) {
    const Kinematics<double, 6> at = forward_kinematics<double, 6>(arm.model, q);
    double sum =
        -arm.model.payload_mass *
        arm.model.gravity.dot(at.tcp.position + at.tcp.rotation * arm.model.payload_center);
    for (std::size_t i = 0; i < 6; ++i) {
      const Joint<double>& joint = arm.model.joints[i];
      sum -= joint.mass * arm.model.gravity.dot(at.links[i].position +
                                                at.links[i].rotation * joint.center_of_mass);
    }
    return sum;
  };
  std::mt19937 random(5);
  const Angles q = drawn(&random);
  const Angles actual = with_weight.torque(q, Angles::Zero(), Angles::Zero(), Angles::Zero());
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Angles step = 1e-5 * Angles::Unit(i);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, (energy(q + step) - energy(q - step)) / 2e-5, actual[i]);
  }
}

void a_pendulum_has_its_closed_form_in_single_precision_too() {
  const Arm<float, 1> arm = pendulum<float>();
  InverseDynamics<float, 1> dynamics;
  TEST_ASSERT_EQUAL(Result::ok, dynamics.configure(arm.model, arm.inertia));
  using One = JointVector<float, 1>;
  for (const float q : {-2.5F, -0.3F, 0.0F, 1.1F}) {
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 4 * 1.5F + 80 * std::cos(q),
                             dynamics.torque(One(q), One(2.0F), One(1.0F), One(1.5F))[0]);
  }
}

void an_impossible_body_is_refused() {
  Arm<double, 6> arm = skew_arm<double>();
  InverseDynamics<double, 6> made;
  arm.inertia[3](0, 0) = std::nan("");
  TEST_ASSERT_EQUAL(Result::bad_model, made.configure(arm.model, arm.inertia));
  arm.inertia[3] = Vector3<double>(1, 1, 3).asDiagonal();  // a plate has at most the sum of the two
  TEST_ASSERT_EQUAL(Result::bad_model, made.configure(arm.model, arm.inertia));
  arm.inertia[3] = Matrix3<double>::Identity();
  arm.inertia[3](0, 1) = arm.inertia[3](1, 0) = 5;  // more than the moments along x and y allow
  TEST_ASSERT_EQUAL(Result::bad_model, made.configure(arm.model, arm.inertia));
  // Each pair of axes allows these products of inertia, all three together do not.
  arm.inertia[3] = Matrix3<double>::Constant(0.4) + 0.6 * Matrix3<double>::Identity();
  TEST_ASSERT_EQUAL(Result::bad_model, made.configure(arm.model, arm.inertia));
  arm.inertia[3] = Matrix3<double>::Identity();
  arm.model.joints[2].mass = -1;
  TEST_ASSERT_EQUAL(Result::bad_model, made.configure(arm.model, arm.inertia));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_velocity_terms_are_those_of_the_christoffel_symbols);
  RUN_TEST(the_inertia_matrix_is_symmetric_and_positive);
  RUN_TEST(weight_is_the_slope_of_potential_energy);
  RUN_TEST(a_pendulum_has_its_closed_form_in_single_precision_too);
  RUN_TEST(an_impossible_body_is_refused);
  return UNITY_END();
}
