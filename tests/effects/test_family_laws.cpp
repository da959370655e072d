// Laws of the families that have no file of their own, each against a computation of its own.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "effects/learned.hpp"
#include "effects/moving_robot.hpp"
#include "host/scratch_folder.hpp"
#include "model/chain_kinematics.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using effects::LawPointer;
using effects::Values;
using Matrix = Matrix3<double>;
using Vector = Vector3<double>;

namespace {

/// The moving robot with straight springs: no gravity and no force; no friction and no rotors.
struct FreeRobot : test::MovingRobot {
  FreeRobot() {
    robot.elastic.gravity.setZero();
    recording.wrench.reset();
    recording.q_link.reset();
    for (model::JointDynamics& motor : robot.dynamics) {
      motor.coulomb = motor.viscous = motor.rotor_inertia = 0;
    }
  }
};

Eigen::MatrixXd shown(const simulation::Machine& machine, const simulation::Scene& scene,
                      simulation::Channel channel) {
  return predict(machine, {scene}).front().channel[channel];
}

/// What a law changes of a channel.
Eigen::MatrixXd change_by(const LawPointer& law, int joint, const Values& values,
                          const model::Robot& robot, const simulation::Scene& scene,
                          simulation::Channel channel) {
  const simulation::Machine plain = effects::machine_of(robot);
  simulation::Machine machine = plain;
  law->apply(values, joint, &machine);
  return shown(machine, scene, channel) - shown(plain, scene, channel);
}

/// The same of the first form of an effect.
Eigen::MatrixXd change_by(const char* effect, int joint, const Values& values,
                          const model::Robot& robot, const simulation::Scene& scene,
                          simulation::Channel channel) {
  return change_by(effects::find_law(effect, ""), joint, values, robot, scene, channel);
}

/// Orientation of each link and direction of each axis, base frame, by the URDF's frames.
struct Axes {
  Axes(const model::Robot& robot, const Eigen::RowVectorXd& q) {
    Matrix frame = Matrix::Identity();
    for (std::size_t i = 0; i < robot.elastic.joints.size(); ++i) {
      const model::ChainJoint& joint = robot.elastic.joints[i];
      frame = frame * joint.origin.rotation *
              Eigen::AngleAxisd(q[static_cast<Eigen::Index>(i)], joint.axis).toRotationMatrix();
      link.push_back(frame);
      axis.emplace_back(frame * joint.axis);
    }
  }

  std::vector<Matrix> link;
  std::vector<Vector> axis;
};

void what_stands_behind_a_link_is_shifted_with_it() {
  const FreeRobot moving;
  const simulation::Scene scene = moving.scene();
  for (int joint = 1; joint <= 5; ++joint) {
    Vector shift = Vector::Zero();
    const Values values = {2e-3, -3e-3};
    const auto named = effects::find_law("link_offset", "")->parameters(moving.robot, joint);
    TEST_ASSERT_EQUAL_UINT64(2, named.size());
    for (std::size_t i = 0; i < 2; ++i) {
      shift[named[i].name[0] - 'x'] = values[i];
    }
    const Eigen::MatrixXd change =
        change_by("link_offset", joint, values, moving.robot, scene, simulation::tcp_position);
    for (Eigen::Index row = 0; row < scene.rows(); row += 20) {
      const Axes axes(moving.robot, scene.q.row(row));
      const Vector expected = axes.link[static_cast<std::size_t>(joint - 1)] * shift;
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (change.row(row).transpose() - expected).norm());
    }
  }
}

/// The length of a link has a law of its own.
void an_offset_is_across_the_link() {
  const FreeRobot moving;
  for (int joint = 1; joint <= 5; ++joint) {
    Vector along = moving.robot.elastic.joints[static_cast<std::size_t>(joint)].origin.position;
    Eigen::Index most = 0;
    along.cwiseAbs().maxCoeff(&most);
    for (const auto& each : effects::find_law("link_offset", "")->parameters(moving.robot, joint)) {
      TEST_ASSERT_TRUE(along.isZero(1e-6) || each.name[0] - 'x' != most);
    }
  }
}

/// Euler's equation about the link's origin: torque on the axis of every joint that turns the link.
void inertia_of_a_link_takes_the_torque_of_eulers_equation() {
  const FreeRobot moving;
  const simulation::Scene scene = moving.scene();
  const Values values = {4, -3, 5, 1, -2, 0.5};
  Matrix inertia;
  inertia << 4, 1, -2, 1, -3, 0.5, -2, 0.5, 5;
  constexpr double kStep = 1e-5;  // s, of the axes' differences
  for (const int joint : {2, 4, 6}) {
    const Eigen::MatrixXd change =
        change_by("link_inertia", joint, values, moving.robot, scene, simulation::joint_torque);
    for (Eigen::Index row = 0; row < scene.rows(); row += 20) {
      const auto count = static_cast<std::size_t>(joint);
      const auto turn = [&](double t) {
        const Eigen::RowVectorXd speed = scene.velocity.row(row) + t * scene.acceleration.row(row);
        const Axes axes(moving.robot, scene.q.row(row) + t * scene.velocity.row(row) +
                                          t * t / 2 * scene.acceleration.row(row));
        Vector all = Vector::Zero();
        for (std::size_t i = 0; i < count; ++i) {
          all += speed[static_cast<Eigen::Index>(i)] * axes.axis[i];
        }
        return all;
      };
      const Axes axes(moving.robot, scene.q.row(row));
      const Matrix there = axes.link[count - 1] * inertia * axes.link[count - 1].transpose();
      const Vector acceleration = (turn(kStep) - turn(-kStep)) / (2 * kStep);
      const Vector torque = there * acceleration + turn(0).cross(there * turn(0));
      for (std::size_t i = 0; i < 6; ++i) {
        const double expected = i < count ? axes.axis[i].dot(torque) : 0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * torque.norm(), expected,
                                  change(row, static_cast<Eigen::Index>(i)));
      }
    }
  }
}

/// A body of positive density: no principal moment of inertia exceeds the sum of the others.
bool is_body(const Matrix& inertia) {
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(inertia, Eigen::EigenvaluesOnly);
  const Vector moments = axes.eigenvalues();  // in rising order
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2];
}

void inertia_that_no_body_has_is_refused() {
  const FreeRobot moving;
  const LawPointer law = effects::find_law("link_inertia", "");
  model::Robot model = moving.robot;
  model.link_inertia[2] = Vector(5, 6, 7).asDiagonal();
  const auto is_refused = [&](const Values& values) {
    simulation::Machine machine = effects::machine_of(model);
    law->apply(values, 3, &machine);
    const bool refused =
        !law->excess(model, machine.robot, effects::size_of(model), 3, 0).isZero(0);
    TEST_ASSERT_TRUE(refused != is_body(machine.robot.link_inertia[2]));
    return refused;
  };
  TEST_ASSERT_FALSE(is_refused({0, 0, 0, 0, 0, 0}));
  TEST_ASSERT_FALSE(is_refused({1, -1, 2, 1, -1, 0.5}));
  TEST_ASSERT_FALSE(is_refused({0, 0, 3.9, 0, 0, 0}));
  TEST_ASSERT_TRUE(is_refused({0, 0, 4.1, 0, 0, 0}));   // 5 + 6 < 11.1
  TEST_ASSERT_TRUE(is_refused({-5.5, 0, 0, 0, 0, 0}));  // a negative moment
  TEST_ASSERT_TRUE(is_refused({0, 0, 0, 4, 0, 0}));     // by a product of inertia
  for (const char* each : {"link_offset", "torque_gain", "load_friction"}) {
    TEST_ASSERT_FALSE(effects::find_law(each, "")->excess);  // they are no bodies
  }
}

void a_gain_scales_what_is_measured_of_one_joint() {
  const test::MovingRobot moving;
  const simulation::Scene scene = moving.scene();
  const Eigen::MatrixXd torque =
      shown(effects::machine_of(moving.robot), scene, simulation::joint_torque);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(scene.rows(), 6);
  expected.col(2) = -0.07 * torque.col(2);
  const Eigen::MatrixXd change =
      change_by("torque_gain", 3, {-0.07}, moving.robot, scene, simulation::joint_torque);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (change - expected).cwiseAbs().maxCoeff());
}

/// The heat by its convolution: what each row's torque brings fades from the row on.
void a_gain_by_heat_follows_the_square_of_the_torque_late() {
  constexpr double kGain = 2e-6;  // 1/(N·m)²
  constexpr double kTime = 0.7;   // s
  const test::MovingRobot moving;
  const simulation::Scene scene = moving.scene();
  const Eigen::VectorXd torque =
      shown(effects::machine_of(moving.robot), scene, simulation::joint_torque).col(2);
  const Eigen::MatrixXd change =
      change_by(effects::find_law("torque_gain", "heat"), 3, {kGain, kTime}, moving.robot, scene,
                simulation::joint_torque);
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    const auto left = [&](Eigen::Index since) {
      return std::exp(-(scene.time[row] - scene.time[since]) / kTime);
    };
    double heat = torque[0] * torque[0] * left(0);
    for (Eigen::Index i = 1; i <= row; ++i) {
      heat += torque[i] * torque[i] * (left(i) - left(i - 1));
    }
    const double expected = kGain * heat * torque[row];
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * torque.norm(), expected, change(row, 2));
  }
  TEST_ASSERT_TRUE(change.col(2).cwiseAbs().maxCoeff() > 1e-3 * torque.cwiseAbs().maxCoeff());
  TEST_ASSERT_EQUAL_DOUBLE(0, change.col(1).cwiseAbs().maxCoeff());
}

/// Without friction and rotors all of the torque goes through the gear.
void friction_under_load_is_a_share_of_the_torque_against_the_motion() {
  FreeRobot moving;
  moving.robot.elastic.gravity = {0, 0, -9.81};
  const simulation::Scene scene = moving.scene();
  const Eigen::VectorXd torque =
      shown(effects::machine_of(moving.robot), scene, simulation::joint_torque).col(1);
  const Eigen::VectorXd change =
      change_by("load_friction", 2, {0.08}, moving.robot, scene, simulation::joint_torque).col(1);
  TEST_ASSERT_TRUE(torque.minCoeff() < 0 || torque.maxCoeff() > 0);
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    const double speed = scene.velocity(row, 1);
    if (std::abs(speed) > 0.01) {
      const double expected = 0.08 * std::abs(torque[row]) * (speed > 0 ? 1 : -1);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9 * torque.norm(), expected, change[row]);
    }
  }
}

/// The whole robot turned about its base, under the gravity that it had.
void a_robot_that_leans_carries_its_weight_as_if_gravity_leant_the_other_way() {
  FreeRobot moving;
  moving.robot.elastic.gravity = {0, 0, -9.81};
  const simulation::Scene scene = moving.scene();
  model::Robot leaning = moving.robot;
  const Matrix turn = Eigen::AngleAxisd(0.02, Vector(0.6, -0.8, 0)).toRotationMatrix();
  auto& first = leaning.elastic.joints.front().origin;
  first.position = turn * first.position;
  first.rotation = turn * first.rotation;
  const auto torque = [&](const model::Robot& robot) {
    return shown(effects::machine_of(robot), scene, simulation::joint_torque);
  };
  const Eigen::MatrixXd expected = torque(leaning) - torque(moving.robot);
  const Eigen::MatrixXd change = change_by("gravity_tilt", 0, {-0.02 * 0.6, 0.02 * 0.8},
                                           moving.robot, scene, simulation::joint_torque);
  TEST_ASSERT_TRUE(expected.col(0).cwiseAbs().maxCoeff() > 10);  // N·m of a joint that bore none
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, (change - expected).cwiseAbs().maxCoeff());
}

void each_is_read_as_it_was_written() {
  const test::MovingRobot moving;
  const simulation::Scene scene = moving.scene();
  const std::vector<effects::Placed> placed = {
      {effects::find_law("link_offset", ""), 2, {2e-3, -1e-3}},
      {effects::find_law("link_inertia", ""), 3, {4, 3, 5, 0.1, -0.2, 0.5}},
      {effects::find_law("torque_gain", ""), 4, {0.06}},
      {effects::find_law("torque_gain", "heat"), 4, {3e-6, 5}},
      {effects::find_law("load_friction", ""), 5, {0.08}}};
  for (const effects::Placed& each : placed) {
    const test::ScratchFolder folder;
    const std::filesystem::path file = folder / "robot.yaml";
    model::write_robot(file, effects::with_learned(moving.robot, {each}));
    const model::Robot read = model::load_robot(file);
    TEST_ASSERT_EQUAL_UINT64(1, read.effects.size());
    TEST_ASSERT_EQUAL_STRING(each.law->effect.c_str(), read.effects[0].effect.c_str());
    TEST_ASSERT_EQUAL_INT(each.joint, read.effects[0].joint);
    const auto named = each.law->parameters(moving.robot, each.joint);
    for (std::size_t i = 0; i < named.size(); ++i) {
      TEST_ASSERT_EQUAL_DOUBLE(each.values[i], read.effects[0].parameters.at(named[i].name));
    }
    const simulation::Machine plain = effects::machine_of(moving.robot);
    simulation::Machine machine = plain;
    effects::add_effects({each}, &machine);
    const simulation::Machine again = effects::machine_of(read, {scene});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, test::difference(machine, again, scene));
    TEST_ASSERT_TRUE(test::difference(plain, again, scene) > 1e-5);
  }
}

/// Derivative of a point's place on a link (m/rad) by the joints' angles, by central differences.
Eigen::MatrixXd jacobian_of(const model::Robot& robot, const simulation::JointValues& q,
                            std::size_t link, const Vector& point) {
  constexpr double kStep = 1e-6;
  const auto place = [&](const simulation::JointValues& at) -> Vector {
    const Pose<double> frame = model::forward_kinematics(robot.elastic, at).links[link];
    return frame.position + frame.rotation * point;
  };
  Eigen::MatrixXd jacobian(3, q.size());
  for (Eigen::Index joint = 0; joint < q.size(); ++joint) {
    simulation::JointValues step = simulation::JointValues::Zero(q.size());
    step[joint] = kStep;
    jacobian.col(joint) = (place(q + step) - place(q - step)) / (2 * kStep);
  }
  return jacobian;
}

/// Lagrange: a point mass adds m JᵀJ to the joint-space inertia.
void a_lump_takes_the_torque_of_a_mass_at_its_place() {
  constexpr double kMass = 30;
  constexpr int kJoint = 3;
  const Vector place(0.4, -0.1, 0.2);
  const FreeRobot free;
  simulation::Machine machine = effects::machine_of(free.robot);
  const Vector moment = kMass * place;
  effects::find_law("link_mass", "lump")
      ->apply({kMass, moment.x(), moment.y(), moment.z()}, kJoint, &machine);
  simulation::JointValues q(6), rest = simulation::JointValues::Zero(6), acceleration(6);
  q << 0.3, -0.9, 1.1, 0.4, -0.7, 0.2;
  acceleration << 1, -2, 0.5, 3, -1, 2;
  const simulation::JointValues change =
      simulation::inverse_dynamics(machine.robot, q, rest, acceleration) -
      simulation::inverse_dynamics(free.robot, q, rest, acceleration);
  const Eigen::MatrixXd jacobian = jacobian_of(free.robot, q, kJoint - 1, place);
  const Eigen::VectorXd expected = kMass * jacobian.transpose() * (jacobian * acceleration);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6 * expected.norm(), 0, (change - expected).norm());
}

/// A robot on stiff joints that carries a spindle.
struct CarryingRobot : test::MovingRobot {
  CarryingRobot() {
    for (model::ChainJoint& joint : robot.elastic.joints) {
      joint.compliance = joint.cubic_compliance = 0;
    }
    robot.elastic.payload_mass = 80;
    robot.elastic.payload_center = Vector(0, 0, -0.1);
  }
};

/// By how much the TCP moves with a spring (m/N, tool frame) under the wrench, and the payload.
void assert_gives(const char* form, double carried) {
  const CarryingRobot carrying;
  const simulation::Scene scene = carrying.scene();
  const Values compliance = {2e-7, 3e-7, 1e-7};
  const simulation::Machine plain = effects::machine_of(carrying.robot);
  simulation::Machine machine = plain;
  effects::find_law("tool_compliance", form)->apply(compliance, 0, &machine);
  const Eigen::MatrixXd change = shown(machine, scene, simulation::tcp_position) -
                                 shown(plain, scene, simulation::tcp_position);
  for (Eigen::Index row = 0; row < scene.rows(); row += 20) {
    const Axes axes(carrying.robot, scene.q.row(row));
    const Matrix tool = axes.link.back() * carrying.robot.elastic.tool.rotation;
    const Vector force =
        scene.wrench.row(row).head<3>().transpose() + carried * carrying.robot.elastic.gravity;
    const Vector give =
        Eigen::Map<const Vector>(compliance.data()).cwiseProduct(tool.transpose() * force);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (change.row(row).transpose() - tool * give).norm());
  }
}

void the_payload_hangs_on_a_flange_that_gives() { assert_gives("", 80); }

void the_payload_does_not_hang_on_a_holder_that_gives() { assert_gives("holder", 0); }

void a_late_force_sensor_follows_a_force_between_two_rows() {
  constexpr double kForce = 500;   // N
  constexpr double kPace = 30;     // rad/s: a straight line between rows is off by 5.6 N halfway
  constexpr double kDelay = 5e-3;  // s, half a row
  test::MovingRobot moving;
  const Eigen::ArrayXd time = moving.recording.time.array();
  moving.recording.wrench->col(0) = kForce * (kPace * time).cos();
  const simulation::Scene scene = moving.scene();
  simulation::Machine machine = effects::machine_of(moving.robot, {scene});
  machine.wrench_delay = kDelay;
  const Eigen::Index inside = time.size() - 4;  // at the ends a slope is known from one side alone
  const Eigen::ArrayXd expected = kForce * (kPace * (time.segment(2, inside) + kDelay)).cos();
  const Eigen::ArrayXd found = simulate(machine, scene).wrench.col(0).segment(2, inside).array();
  TEST_ASSERT_DOUBLE_WITHIN(1, 0, (found - expected).abs().maxCoeff());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_stands_behind_a_link_is_shifted_with_it);
  RUN_TEST(an_offset_is_across_the_link);
  RUN_TEST(inertia_of_a_link_takes_the_torque_of_eulers_equation);
  RUN_TEST(inertia_that_no_body_has_is_refused);
  RUN_TEST(a_gain_scales_what_is_measured_of_one_joint);
  RUN_TEST(a_gain_by_heat_follows_the_square_of_the_torque_late);
  RUN_TEST(friction_under_load_is_a_share_of_the_torque_against_the_motion);
  RUN_TEST(a_robot_that_leans_carries_its_weight_as_if_gravity_leant_the_other_way);
  RUN_TEST(a_lump_takes_the_torque_of_a_mass_at_its_place);
  RUN_TEST(the_payload_hangs_on_a_flange_that_gives);
  RUN_TEST(the_payload_does_not_hang_on_a_holder_that_gives);
  RUN_TEST(a_late_force_sensor_follows_a_force_between_two_rows);
  RUN_TEST(each_is_read_as_it_was_written);
  return UNITY_END();
}
