#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <string>

#include "flexcomp/chain.hpp"
#include "model/robot.hpp"
#include "recording/csv.hpp"
#include "unity_main.hpp"

using flexcomp::forward_kinematics;
using flexcomp::geometric_jacobian;
using flexcomp::JointVector;
using flexcomp::Vector3;
using flexcomp::model::load_robot;
using flexcomp::model::Robot;
using Angles = JointVector<double, 6>;
using Complex = std::complex<double>;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kForearmOffset = -0.055;  ///< m, of the forearm's axis above that of A3

/// Numbers of the study (Klimchik et al. 2017, table 2) and of the robots' data sheets.
struct Figures {
  const char* folder;
  double shoulder_x, shoulder_z, arm, forearm, flange;  ///< m
  double springs[6];                                    ///< 1e-6 rad/(N·m)
  double limits[6][2];                                  ///< degrees
  double reach;  ///< m, to the wrist centre, as the study rounds it
  double mass;   ///< kg, with the base
};

constexpr Figures kRobots[] = {
    {"kr100",
     0.350,
     0.750,
     1.250,
     1.000,
     0.21,
     {1.92, 0.34, 0.56, 3.31, 3.83, 5.42},
     {{-185, 185}, {-146, 0}, {-119, 155}, {-350, 350}, {-125, 125}, {-350, 350}},
     2.6,
     1200},
    {"kr270",
     0.350,
     0.750,
     1.250,
     1.100,
     0.23,
     {0.54, 0.29, 0.42, 2.79, 3.48, 2.07},
     {{-185, 185}, {-146, 0}, {-119, 155}, {-350, 350}, {-125, 125}, {-350, 350}},
     2.7,
     1250},
    {"kr360",
     0.500,
     1.045,
     1.300,
     1.525,
     0.29,
     {0.86, 0.17, 0.25, 2.17, 1.47, 2.96},
     {{-185, 185}, {-130, 20}, {-100, 144}, {-350, 350}, {-120, 120}, {-350, 350}},
     3.3,
     2450},
    {"kr500",
     0.500,
     1.045,
     1.300,
     1.025,
     0.29,
     {0.47, 0.14, 0.19, 0.72, 0.95, 1.44},
     {{-185, 185}, {-130, 20}, {-100, 144}, {-350, 350}, {-120, 120}, {-350, 350}},
     2.8,
     2400},
};

Robot robot_of(const std::string& folder) {
  return load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + folder + "/robot.yaml");
}

Angles planar_angles(double q2, double q3) {
  Angles q = Angles::Zero();
  q[1] = q2;
  q[2] = q3;
  return q;
}

void assert_point(const Vector3<double>& expected, const Vector3<double>& actual, double tolerance,
                  const char* message) {
  for (int i = 0; i < 3; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(tolerance, expected[i], actual[i], message);
  }
}

void springs_are_those_of_the_study() {
  for (const Figures& figures : kRobots) {
    const Robot robot = robot_of(figures.folder);
    for (std::size_t i = 0; i < 6; ++i) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-20, figures.springs[i] * 1e-6,
                                robot.elastic.joints[i].compliance);
    }
    TEST_ASSERT_FALSE(has_structure_springs(robot.elastic));
    TEST_ASSERT_FALSE(has_weight(six_axis_model(robot)));
  }
}

void joints_have_the_published_limits() {
  for (const Figures& figures : kRobots) {
    const Robot robot = robot_of(figures.folder);
    for (std::size_t i = 0; i < 6; ++i) {
      TEST_ASSERT_EQUAL_STRING(("joint_a" + std::to_string(i + 1)).c_str(),
                               robot.joint_names[i].c_str());
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, figures.limits[i][0] * kDegree,
                                robot.elastic.joints[i].lower);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, figures.limits[i][1] * kDegree,
                                robot.elastic.joints[i].upper);
      TEST_ASSERT_TRUE(robot.dynamics[i].velocity > 1 && robot.dynamics[i].velocity < 5);
      TEST_ASSERT_TRUE(robot.dynamics[i].effort > 0);
    }
  }
}

void at_zero_the_arm_lies_along_x_and_the_flange_looks_along_x() {
  for (const Figures& figures : kRobots) {
    const auto at_zero =
        forward_kinematics<double, 6>(six_axis_model(robot_of(figures.folder)), Angles::Zero());
    assert_point({figures.shoulder_x + figures.arm + figures.forearm + figures.flange, 0,
                  figures.shoulder_z + kForearmOffset},
                 at_zero.tcp.position, 1e-14, figures.folder);
    assert_point(Vector3<double>::UnitX(), at_zero.tcp.rotation.col(2), 1e-15, figures.folder);
    assert_point(-Vector3<double>::UnitZ(), at_zero.tcp.rotation.col(0), 1e-15, figures.folder);
  }
}

void at_minus_90_degrees_of_a2_the_arm_stands_upright() {
  for (const Figures& figures : kRobots) {
    const auto upright = forward_kinematics<double, 6>(six_axis_model(robot_of(figures.folder)),
                                                       planar_angles(-90 * kDegree, 0));
    assert_point({figures.shoulder_x - kForearmOffset, 0,
                  figures.shoulder_z + figures.arm + figures.forearm + figures.flange},
                 upright.tcp.position, 1e-14, figures.folder);
  }
}

void stretched_out_the_wrist_is_at_the_published_reach() {
  for (const Figures& figures : kRobots) {
    const double q3 = std::atan2(kForearmOffset, figures.forearm);
    const auto stretched = forward_kinematics<double, 6>(six_axis_model(robot_of(figures.folder)),
                                                         planar_angles(0, q3));
    const Vector3<double> wrist = stretched.links[4].position;
    const double reach =
        figures.shoulder_x + figures.arm + std::hypot(figures.forearm, kForearmOffset);
    assert_point({reach, 0, figures.shoulder_z}, wrist, 1e-14, figures.folder);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, figures.reach, wrist.x());
  }
}

void masses_add_up_and_inertias_are_those_of_bodies() {
  for (const Figures& figures : kRobots) {
    const Robot robot = robot_of(figures.folder);
    const auto base = urdf::parseURDFFile(robot.urdf.string())->getLink(robot.base_link);
    double mass = base->inertial->mass;
    for (std::size_t i = 0; i < 6; ++i) {
      mass += robot.elastic.joints[i].mass;
      const Vector3<double> moments =
          Eigen::SelfAdjointEigenSolver<flexcomp::Matrix3<double>>(robot.link_inertia[i])
              .eigenvalues();
      TEST_ASSERT_TRUE(moments[0] > 0 && moments[0] + moments[1] >= moments[2]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, figures.mass, mass);
  }
}

/// A milling path of tests/host/data: a point at or beyond the flange on a circle of 100 mm radius
/// in the plane of joints 2 and 3 (x + iz), with a force that turns with the path. Paths of the
/// wrist centre would be the same with the forearm's offset the other way.
struct ReferencePath {
  const char* name;
  const Figures& robot;
  Complex center;        ///< m
  Complex force;         ///< N, where the path starts
  double beyond_flange;  ///< m
};

const ReferencePath kPaths[] = {
    {"KR100_B", kRobots[0], {1.8, 0.6}, {1104, 0}, 0},
    {"KR360_A_x10", kRobots[2], {2.2, 1.4}, {4400, 6350}, 0.15},
};

/// Elbow up, wrist straight: the triangle of shoulder, elbow and point.
Angles angles_at(const ReferencePath& path, Complex point) {
  const Figures& robot = path.robot;
  const Complex forearm(robot.forearm + robot.flange + path.beyond_flange, kForearmOffset);
  const Complex shoulder(robot.shoulder_x, robot.shoulder_z);
  const double distance = std::abs(point - shoulder);
  const double at_shoulder =
      std::acos((robot.arm * robot.arm + distance * distance - std::norm(forearm)) /
                (2 * robot.arm * distance));
  const double arm_angle = std::arg(point - shoulder) + at_shoulder;
  const Complex elbow = shoulder + std::polar(robot.arm, arm_angle);
  const double forearm_angle = std::arg((point - elbow) / forearm);
  return planar_angles(-arm_angle, arm_angle - forearm_angle);
}

void assert_deflected_point(const ReferencePath& path, const Robot& robot, double angle,
                            Complex expected) {
  const Complex wanted = path.center + std::polar(0.1, angle);
  const auto at = forward_kinematics<double, 6>(six_axis_model(robot), angles_at(path, wanted));
  const Vector3<double> point = at.tcp.position + path.beyond_flange * at.tcp.rotation.col(2);
  assert_point({wanted.real(), 0, wanted.imag()}, point, 1e-14, path.name);

  const Complex force = path.force * std::polar(1.0, angle);
  const auto jacobian = geometric_jacobian<double, 6>(at, point);
  Vector3<double> deflected = point;
  for (int i = 0; i < 6; ++i) {
    const Vector3<double> lever = jacobian.col(i).head<3>();
    const double torque = lever.dot(Vector3<double>(force.real(), 0, force.imag()));
    deflected += lever * robot.elastic.joints[static_cast<std::size_t>(i)].compliance * torque;
  }
  const Complex actual = Complex(deflected.x(), deflected.z()) - path.center;
  TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12, expected.real(), actual.real(), path.name);
  TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12, expected.imag(), actual.imag(), path.name);
}

void loaded_robots_mill_the_reference_paths() {
  for (const ReferencePath& path : kPaths) {
    const Robot robot = robot_of(path.robot.folder);
    const auto table = flexcomp::recording::read_csv(std::string(FLEXCOMP_TEST_DATA) + "/circle_" +
                                                     path.name + ".csv");
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const double angle =
          360 * kDegree * static_cast<double>(i) / static_cast<double>(table.rows.size());
      assert_deflected_point(path, robot, angle, {table.rows[i][0], table.rows[i][1]});
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(springs_are_those_of_the_study);
  RUN_TEST(joints_have_the_published_limits);
  RUN_TEST(at_zero_the_arm_lies_along_x_and_the_flange_looks_along_x);
  RUN_TEST(at_minus_90_degrees_of_a2_the_arm_stands_upright);
  RUN_TEST(stretched_out_the_wrist_is_at_the_published_reach);
  RUN_TEST(masses_add_up_and_inertias_are_those_of_bodies);
  RUN_TEST(loaded_robots_mill_the_reference_paths);
  return UNITY_END();
}
