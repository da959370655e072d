#include <array>
#include <cmath>
#include <complex>
#include <string>

#include "flexcomp/compliance.hpp"
#include "geometry/circularity.hpp"
#include "model/chain_kinematics.hpp"
#include "model/robot.hpp"
#include "recording/csv.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

using Complex = std::complex<double>;
constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 0.1;
const Complex kForce(440, 1370);

/// A robot as the study uses it: the wrist straight, the force at the wrist centre.
model::Robot study_robot(const std::string& name) {
  model::Robot robot = model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml");
  // The wrist centre is the origin of joint 5: no way from there to the TCP.
  robot.elastic.joints[5].origin.position.setZero();
  robot.elastic.tool.position.setZero();
  return robot;
}

/// Angles of joints 2 and 3, elbow up, that put the wrist centre at x + iz.
JointVector<double, 6> posture(const model::Robot& robot, Complex point) {
  const auto& joints = robot.elastic.joints;
  const Complex shoulder(joints[1].origin.position.x(), joints[0].origin.position.z());
  const double upper = joints[2].origin.position.x();
  const Complex forearm(joints[4].origin.position.x(), joints[3].origin.position.z());
  const Complex reach = point - shoulder;
  const double distance = std::abs(reach);
  const double elbow = std::acos((upper * upper + distance * distance - std::norm(forearm)) /
                                 (2 * upper * distance));
  const double arm = std::arg(reach) + elbow;
  const Complex rest = point - shoulder - std::polar(upper, arm);
  JointVector<double, 6> q = JointVector<double, 6>::Zero();
  // Joints 2 and 3 turn about +y, which is clockwise in the x, z plane.
  q[1] = -arm;
  q[2] = -(std::arg(rest) - std::arg(forearm)) + arm;
  return q;
}

/// Deflected points of the circle (Klimchik et al. 2017, eq. 15), relative to its centre.
geometry::Points deflected_circle(const model::Robot& robot, Complex center, int count,
                                  double sense) {
  geometry::Points points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count;
    const Complex point = center + std::polar(kRadius, angle);
    const Complex force = kForce * std::polar(1.0, sense * angle);
    Wrench<double> wrench = Wrench<double>::Zero();
    wrench[0] = force.real();
    wrench[2] = force.imag();
    const auto q = posture(robot, point);
    const auto kinematics = forward_kinematics(robot.elastic, q);
    const Twist<double> shift = tcp_compliance(robot.elastic, kinematics) * wrench;
    points.emplace_back(kinematics.tcp.position.x() + shift[0] - center.real(),
                        kinematics.tcp.position.z() + shift[2] - center.imag());
  }
  return points;
}

/// First-order circularity with the wrench turning with the path: |F| times the difference of the
/// principal compliances in the plane, taken at the circle's centre.
double closed_form(const model::Robot& robot, Complex center) {
  const auto kinematics = forward_kinematics(robot.elastic, posture(robot, center));
  const Compliance<double> c = tcp_compliance(robot.elastic, kinematics);
  const double half_difference = (c(0, 0) - c(2, 2)) / 2;
  return std::abs(kForce) * 2 * std::hypot(half_difference, c(0, 2));
}

bool reachable(const model::Robot& robot, Complex center) {
  for (int i = 0; i < 72; ++i) {
    const auto q = posture(robot, center + std::polar(kRadius, 2 * kPi * i / 72));
    for (std::size_t joint = 1; joint < 3; ++joint) {
      const double angle = q[static_cast<Eigen::Index>(joint)];
      const model::ChainJoint& limits = robot.elastic.joints[joint];
      if (!(angle >= limits.lower && angle <= limits.upper)) {
        return false;
      }
    }
  }
  return true;
}

struct Bound {
  const char* robot;
  double difference;  ///< m, of the exact path from the closed form, as published with the study
};

void exact_paths_stay_within_the_bound_of_the_closed_form() {
  const Bound bounds[] = {
      {"kr100", 0.12e-3}, {"kr270", 0.12e-3}, {"kr360", 0.12e-3}, {"kr500", 0.04e-3}};
  for (const Bound& bound : bounds) {
    const model::Robot robot = study_robot(bound.robot);
    int centers = 0;
    for (double x = 0.2; x < 3.4; x += 0.15) {
      for (double z = -1.0; z < 3.6; z += 0.15) {
        const Complex center(x, z);
        if (!reachable(robot, center)) {
          continue;
        }
        ++centers;
        const double exact =
            geometry::least_squares_circularity(deflected_circle(robot, center, 72, 1)).value();
        TEST_ASSERT_TRUE_MESSAGE(std::abs(exact - closed_form(robot, center)) <= bound.difference,
                                 bound.robot);
      }
    }
    TEST_ASSERT_TRUE_MESSAGE(centers > 50, bound.robot);
  }
}

/// The reference circles whose point is the wrist centre, deflected by the shipped robots.
void shipped_robots_bend_the_reference_circles_as_given() {
  struct Case {
    const char* file;
    const char* robot;
    Complex center;
    double sense;
  };
  const Case cases[] = {{"KR270_S", "kr270", {1.5, 1.0}, 1}, {"KR500_C", "kr500", {1.6, 1.2}, -1}};
  for (const Case& one : cases) {
    const auto table =
        recording::read_csv(std::string(FLEXCOMP_TEST_DATA) + "/circle_" + one.file + ".csv");
    const geometry::Points points =
        deflected_circle(study_robot(one.robot), one.center, 36, one.sense);
    for (std::size_t i = 0; i < points.size(); ++i) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, table.rows[i][0], points[i].x());
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, table.rows[i][1], points[i].y());
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(exact_paths_stay_within_the_bound_of_the_closed_form);
  RUN_TEST(shipped_robots_bend_the_reference_circles_as_given);
  return UNITY_END();
}
