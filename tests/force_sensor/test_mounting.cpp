#include <cmath>
#include <limits>
#include <random>

#include "core/test_robots.hpp"
#include "force_sensor/mounting.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::loop_angles;

namespace {

using Vector = Vector3<double>;
using Six = Eigen::Matrix<double, 6, 1>;

JointAngles posture(double phase) {
  JointAngles q{};
  Eigen::Map<JointVector<double, 6>>(q.data()) = loop_angles<double>(phase);
  return q;
}

/// A sensor askew between the flange and a heavy spindle.
SensorMounting askew() {
  SensorMounting mounting;
  mounting.arm = kr270<double>();
  mounting.arm.tool.position = {0.05, -0.02, 0.4};
  mounting.arm.gravity = {0.1, -0.2, -9.7};
  mounting.frame.position = {0.01, 0.02, 0.1};
  mounting.frame.rotation = axis_rotation<double>(Vector(1, 2, 3).normalized(), 0.7);
  mounting.mass = 25;
  mounting.center_of_mass = {0.03, 0.01, 0.22};
  return mounting;
}

/// What the sensor feels of a force and a moment that act at a point, both in the base frame.
std::array<double, 6> felt(const SensorMounting& mounting, const JointAngles& q,
                           const Vector& point, const Vector& force, const Vector& moment) {
  const auto where = forward_kinematics<double, 6>(mounting.arm, JointVector<double, 6>(q.data()));
  const Pose<double> sensor = where.links.back() * mounting.frame;
  std::array<double, 6> load{};
  Eigen::Map<Vector>(load.data()) = sensor.rotation.transpose() * force;
  Eigen::Map<Vector>(load.data() + 3) =
      sensor.rotation.transpose() * (moment + (point - sensor.position).cross(force));
  return load;
}

Six sum(const std::array<double, 6>& a, const std::array<double, 6>& b) {
  return Six(a.data()) + Six(b.data());
}

/// Of the weight alone, at the centre of mass.
std::array<double, 6> weight_felt(const SensorMounting& mounting, const JointAngles& q) {
  const auto where = forward_kinematics<double, 6>(mounting.arm, JointVector<double, 6>(q.data()));
  const Pose<double>& link = where.links.back();
  return felt(mounting, q, link.position + link.rotation * mounting.center_of_mass,
              mounting.mass * mounting.arm.gravity, Vector::Zero());
}

void a_tool_in_the_air_is_no_wrench() {
  const SensorMounting mounting = askew();
  for (double phase = 0; phase < 6; phase += 0.7) {
    const JointAngles q = posture(phase);
    const auto wrench = wrench_at_tcp(mounting, q, weight_felt(mounting, q));
    TEST_ASSERT_TRUE(Six(wrench.data()).cwiseAbs().maxCoeff() < 1e-10);
  }
}

/// Whatever a wrench is called at, it loads the joints with the same torques.
void the_wrench_at_the_tcp_loads_the_joints_as_the_sensor_says() {
  SensorMounting mounting = askew();
  mounting.mass = 0;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    const JointAngles q = posture(i);
    std::array<double, 6> load{};
    for (double& each : load) {
      each = 100 * normal(random);
    }
    const auto where =
        forward_kinematics<double, 6>(mounting.arm, JointVector<double, 6>(q.data()));
    const Pose<double> sensor = where.links.back() * mounting.frame;
    Six at_sensor;
    at_sensor << sensor.rotation * Vector(load.data()), sensor.rotation * Vector(load.data() + 3);
    const Six expected =
        geometric_jacobian<double, 6>(where, sensor.position).transpose() * at_sensor;
    const Six torques = geometric_jacobian<double, 6>(where).transpose() *
                        Six(wrench_at_tcp(mounting, q, load).data());
    TEST_ASSERT_TRUE((torques - expected).norm() < 1e-9 * expected.norm());
  }
}

void a_cut_is_told_apart_from_the_weight() {
  const SensorMounting mounting = askew();
  const Vector force(440, 1370, 635);
  const Vector moment(3, -8, 10.5);
  for (double phase = 0; phase < 6; phase += 0.7) {
    const JointAngles q = posture(phase);
    const auto where =
        forward_kinematics<double, 6>(mounting.arm, JointVector<double, 6>(q.data()));
    const Six load =
        sum(felt(mounting, q, where.tcp.position, force, moment), weight_felt(mounting, q));
    std::array<double, 6> all{};
    Eigen::Map<Six>(all.data()) = load;
    const Six wrench(wrench_at_tcp(mounting, q, all).data());
    TEST_ASSERT_TRUE((wrench.head<3>() - force).norm() < 1e-9);
    TEST_ASSERT_TRUE((wrench.tail<3>() - moment).norm() < 1e-9);
  }
}

/// With nothing turned, by hand: 100 N along the flange's axis, 0.1 m beside the TCP's.
void a_push_beside_the_tcp_is_a_moment_about_it() {
  SensorMounting mounting;
  mounting.arm.tool.position = {0.1, 0, 0.3};
  const auto wrench = wrench_at_tcp(mounting, {}, {0, 0, -100, 0, 0, 0});
  const std::array<double, 6> expected = {0, 0, -100, 0, -10, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected[i], wrench[i]);
  }
}

void an_angle_that_is_no_number_gives_none() {
  JointAngles q{};
  q[2] = std::numeric_limits<double>::quiet_NaN();
  const auto wrench = wrench_at_tcp(askew(), q, {1, 2, 3, 4, 5, 6});
  TEST_ASSERT_FALSE(Six(wrench.data()).allFinite());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_tool_in_the_air_is_no_wrench);
  RUN_TEST(the_wrench_at_the_tcp_loads_the_joints_as_the_sensor_says);
  RUN_TEST(a_cut_is_told_apart_from_the_weight);
  RUN_TEST(a_push_beside_the_tcp_is_a_moment_about_it);
  RUN_TEST(an_angle_that_is_no_number_gives_none);
  return UNITY_END();
}
