#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>
#include <string>

#include "flexcomp/model.hpp"

/// Machines of 1 to 12 joints that turn or slide. What is an angle (rad), a torque (N·m) or an
/// inertia (kg·m²) of a joint that turns is a travel (m), a force (N) or a mass (kg) of one that
/// slides, in the same places and with the same names.
namespace flexcomp::model {

constexpr int kMostJoints = 12;

/// One of something a joint, base to tip, without memory from the heap.
template <typename Item>
using PerJoint = boost::container::static_vector<Item, kMostJoints>;

/// One number a joint.
using JointValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;

/// A number for every pair of joints.
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                  kMostJoints, kMostJoints>;

/// Maps joint rates to the twist of the TCP; linear rows first.
using ChainJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostJoints>;

enum class JointType {
  revolute,
  continuous,  ///< turns without end
  prismatic,
};

/// Limit, either way, of a joint that has none (rad): farther than any goes, and a number.
constexpr double kEndless = 1e6;

/// "revolute", "continuous" or "prismatic".
const char* name_of(JointType type);

/// A joint that turns about its axis or slides along it, the spring behind it and the link that it
/// moves. The link frame coincides with the joint frame moved so.
struct ChainJoint : Joint<double> {
  JointType type = JointType::revolute;

  bool slides() const { return type == JointType::prismatic; }
};

/// A serial machine with springs: the virtual-joint model of Klimchik et al. (2017). The base frame
/// is the frame of everything that has no other frame in its name.
struct Chain {
  PerJoint<ChainJoint> joints;  ///< base to tip
  Pose<double> tool;            ///< TCP frame in the last link's frame
  DiagonalCompliance<double> base_compliance = DiagonalCompliance<double>::Zero();  ///< base frame
  DiagonalCompliance<double> tool_compliance = DiagonalCompliance<double>::Zero();  ///< tool frame
  Vector3<double> gravity = Vector3<double>::Zero();         ///< m/s²; zero leaves weight out
  double payload_mass = 0;                                   ///< kg, beside the links' masses
  Vector3<double> payload_center = Vector3<double>::Zero();  ///< m, in the tool frame

  Eigen::Index size() const { return static_cast<Eigen::Index>(joints.size()); }
  const ChainJoint& joint(Eigen::Index index) const {
    return joints[static_cast<std::size_t>(index)];
  }
};

/// Checks that there are joints, and of them and the rest what the core checks of its models.
Result validate(const Chain& chain);

/// Does the chain have springs other than those of the joints?
bool has_structure_springs(const Chain& chain);

/// The core's model of the same machine; nothing unless it has six revolute joints with limits.
std::optional<RobotModel<double, 6>> six_axis_model(const Chain& chain);

/// A model of the core as a chain.
Chain chain_of(const RobotModel<double, 6>& model);

/// A unit of a joint that turns, as it is for this joint: N·m is N of one that slides, rad/(N·m) is
/// m/N. Units that have nothing to do with what the joint is stay as they are.
std::string unit_of(const ChainJoint& joint, const std::string& of_turning);

/// A unit that holds for all joints of a chain: "N·m or N" where some turn and some slide.
std::string unit_of(const Chain& chain, const std::string& of_turning);

}  // namespace flexcomp::model
