#include <array>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>
#include <string>

#include "flexcomp/chain.hpp"
#include "model/robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr std::array<const char*, 4> kRobots = {"kr100", "kr270", "kr360", "kr500"};

/// The same URDF as Orocos KDL reads it.
class Reference {
 public:
  explicit Reference(const model::Robot& robot) {
    KDL::Tree tree;
    TEST_ASSERT_TRUE(kdl_parser::treeFromFile(robot.urdf.string(), tree));
    TEST_ASSERT_TRUE(tree.getChain(robot.base_link, robot.tool_link, chain_));
    TEST_ASSERT_EQUAL(6, chain_.getNrOfJoints());
  }

  KDL::Frame pose(const JointVector<double, 6>& q) {
    KDL::ChainFkSolverPos_recursive solver(chain_);
    KDL::Frame frame;
    TEST_ASSERT_EQUAL(0, solver.JntToCart(joints(q), frame));
    return frame;
  }

  Jacobian<double, 6> jacobian(const JointVector<double, 6>& q) {
    KDL::ChainJntToJacSolver solver(chain_);
    KDL::Jacobian result(6);
    TEST_ASSERT_EQUAL(0, solver.JntToJac(joints(q), result));
    return result.data;
  }

 private:
  static KDL::JntArray joints(const JointVector<double, 6>& q) {
    KDL::JntArray array(6);
    array.data = q;
    return array;
  }

  KDL::Chain chain_;
};

template <typename Scalar>
double difference(const Pose<Scalar>& pose, const KDL::Frame& frame) {
  double largest = 0;
  for (int row = 0; row < 3; ++row) {
    largest = std::max(largest, std::abs(static_cast<double>(pose.position[row]) - frame.p(row)));
    for (int column = 0; column < 3; ++column) {
      largest = std::max(largest, std::abs(static_cast<double>(pose.rotation(row, column)) -
                                           frame.M(row, column)));
    }
  }
  return largest;
}

void pose_and_jacobian_agree_on_1000_postures_of_each_robot() {
  std::mt19937 random(1);
  for (const char* name : kRobots) {
    const model::Robot robot =
        model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml");
    const RobotModel<double, 6> core = six_axis_model(robot);
    const RobotModel<float, 6> single = core.cast<float>();
    Reference reference(robot);
    for (int posture = 0; posture < 1000; ++posture) {
      JointVector<double, 6> q;
      for (std::size_t i = 0; i < 6; ++i) {
        std::uniform_real_distribution<double> angle(core.joints[i].lower, core.joints[i].upper);
        q[static_cast<Eigen::Index>(i)] = angle(random);
      }
      const KDL::Frame frame = reference.pose(q);
      const Jacobian<double, 6> jacobian = reference.jacobian(q);
      const auto exact = forward_kinematics<double, 6>(core, q);
      TEST_ASSERT_TRUE_MESSAGE(difference(exact.tcp, frame) < 1e-12, name);
      TEST_ASSERT_TRUE_MESSAGE(
          (geometric_jacobian<double, 6>(exact) - jacobian).cwiseAbs().maxCoeff() < 1e-12, name);

      const auto rounded = forward_kinematics<float, 6>(single, q.cast<float>());
      const double scale = std::max(1.0, jacobian.cwiseAbs().maxCoeff());
      TEST_ASSERT_TRUE_MESSAGE(difference(rounded.tcp, frame) < 1e-5 * scale, name);
      TEST_ASSERT_TRUE_MESSAGE(
          (geometric_jacobian<float, 6>(rounded).cast<double>() - jacobian).cwiseAbs().maxCoeff() <
              1e-5 * scale,
          name);
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(pose_and_jacobian_agree_on_1000_postures_of_each_robot);
  return UNITY_END();
}
