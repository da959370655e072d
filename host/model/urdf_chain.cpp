#include "model/urdf_chain.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::model {
namespace {

/// A rigid body about a frame's origin: mass, first moment and inertia at the origin, so that bodies
/// add up.
struct Body {
  double mass = 0;
  Vector3<double> moment = Vector3<double>::Zero();
  Matrix3<double> inertia = Matrix3<double>::Zero();

  void add(double m, const Vector3<double>& center, const Matrix3<double>& inertia_at_center) {
    mass += m;
    moment += m * center;
    inertia += inertia_at_center +
               m * (center.squaredNorm() * Matrix3<double>::Identity() - center * center.transpose());
  }

  Vector3<double> center() const {
    return mass > 0 ? Vector3<double>(moment / mass) : Vector3<double>::Zero();
  }

  Matrix3<double> inertia_at_center() const {
    const Vector3<double> c = center();
    return inertia - mass * (c.squaredNorm() * Matrix3<double>::Identity() - c * c.transpose());
  }
};

Pose<double> pose(const urdf::Pose& from) {
  const Eigen::Quaterniond rotation(from.rotation.w, from.rotation.x, from.rotation.y,
                                    from.rotation.z);
  return {rotation.normalized().toRotationMatrix(),
          Vector3<double>(from.position.x, from.position.y, from.position.z)};
}

class ChainReader {
 public:
  ChainReader(const std::filesystem::path& file, Robot* robot) : file_(file), robot_(*robot) {}

  void read() {
    console_bridge::noOutputHandler();
    const urdf::ModelInterfaceSharedPtr tree = urdf::parseURDF(files::read_text(file_));
    console_bridge::restorePreviousOutputHandler();
    if (!tree) {
      fail("not a valid URDF (malformed XML, or a link or joint that contradicts itself)");
    }
    const std::vector<urdf::JointConstSharedPtr> joints = joints_between(*tree);
    Pose<double> offset;
    std::size_t index = 0;
    for (const urdf::JointConstSharedPtr& joint : joints) {
      offset = offset * pose(joint->parent_to_joint_origin_transform);
      if (joint->type == urdf::Joint::FIXED) {
        continue;
      }
      read_joint(*joint, offset, index);
      read_body(*tree, *joint, joints, index);
      offset = Pose<double>{};
      ++index;
    }
    robot_.elastic.tool = offset;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("{}: {}", file_.string(), why));
  }

  /// Joints from base to tool, checked to hold six revolute ones.
  std::vector<urdf::JointConstSharedPtr> joints_between(const urdf::ModelInterface& tree) const {
    for (const std::string& name : {robot_.base_link, robot_.tool_link}) {
      if (!tree.getLink(name)) {
        fail(fmt::format("has no link '{}'", name));
      }
    }
    std::vector<urdf::JointConstSharedPtr> joints;
    urdf::LinkConstSharedPtr link = tree.getLink(robot_.tool_link);
    while (link && link->name != robot_.base_link) {
      if (link->parent_joint) {
        joints.push_back(link->parent_joint);
      }
      link = link->getParent();
    }
    if (!link) {
      fail(fmt::format("link '{}' does not lie beyond link '{}'", robot_.tool_link,
                       robot_.base_link));
    }
    std::reverse(joints.begin(), joints.end());
    std::size_t revolute = 0;
    for (const urdf::JointConstSharedPtr& joint : joints) {
      if (joint->type == urdf::Joint::FIXED) {
        continue;
      }
      if (joint->type != urdf::Joint::REVOLUTE) {
        fail(fmt::format("joint '{}' is not revolute with limits; six such joints are expected "
                         "between '{}' and '{}'",
                         joint->name, robot_.base_link, robot_.tool_link));
      }
      ++revolute;
    }
    if (revolute != 6) {
      fail(fmt::format("expected six revolute joints between '{}' and '{}', found {}",
                       robot_.base_link, robot_.tool_link, revolute));
    }
    return joints;
  }

  void read_joint(const urdf::Joint& from, const Pose<double>& origin, std::size_t index) {
    if (!from.limits || !(from.limits->lower < from.limits->upper)) {
      fail(fmt::format("joint '{}': expected limits with lower below upper", from.name));
    }
    if (from.mimic) {
      fail(fmt::format("joint '{}': a joint that mimics another is not supported", from.name));
    }
    const Vector3<double> axis(from.axis.x, from.axis.y, from.axis.z);
    if (!(axis.norm() > 1e-9)) {
      fail(fmt::format("joint '{}': the axis must not be zero", from.name));
    }
    Joint<double>& to = robot_.elastic.joints[index];
    to.origin = origin;
    to.axis = axis.normalized();
    to.lower = from.limits->lower;
    to.upper = from.limits->upper;
    robot_.joint_names[index] = from.name;
    robot_.dynamics[index].effort = from.limits->effort;
    robot_.dynamics[index].velocity = from.limits->velocity;
  }

  /// Sums what moves with a joint: its link and everything fixed to it.
  void read_body(const urdf::ModelInterface& tree, const urdf::Joint& joint,
                 const std::vector<urdf::JointConstSharedPtr>& chain, std::size_t index) {
    Body body;
    add_link(*tree.getLink(joint.child_link_name), Pose<double>{}, chain, &body);
    if (body.mass < 0) {
      fail(fmt::format("link '{}': the mass must not be negative", joint.child_link_name));
    }
    robot_.elastic.joints[index].mass = body.mass;
    robot_.elastic.joints[index].center_of_mass = body.center();
    robot_.link_inertia[index] = body.inertia_at_center();
  }

  void add_link(const urdf::Link& link, const Pose<double>& frame,
                const std::vector<urdf::JointConstSharedPtr>& chain, Body* body) const {
    if (link.inertial) {
      const urdf::Inertial& own = *link.inertial;
      const Pose<double> center = frame * pose(own.origin);
      Matrix3<double> inertia;
      inertia << own.ixx, own.ixy, own.ixz, own.ixy, own.iyy, own.iyz, own.ixz, own.iyz, own.izz;
      body->add(own.mass, center.position,
                center.rotation * inertia * center.rotation.transpose());
    }
    for (const urdf::JointSharedPtr& joint : link.child_joints) {
      const bool moves_on = joint->type != urdf::Joint::FIXED &&
                            std::find(chain.begin(), chain.end(), joint) != chain.end();
      if (moves_on) {
        continue;
      }
      const urdf::LinkSharedPtr child = child_of(link, *joint);
      if (child) {
        add_link(*child, frame * pose(joint->parent_to_joint_origin_transform), chain, body);
      }
    }
  }

  static urdf::LinkSharedPtr child_of(const urdf::Link& link, const urdf::Joint& joint) {
    for (const urdf::LinkSharedPtr& child : link.child_links) {
      if (child->name == joint.child_link_name) {
        return child;
      }
    }
    return nullptr;
  }

  const std::filesystem::path& file_;
  Robot& robot_;
};

}  // namespace

void read_urdf_chain(const std::filesystem::path& urdf, Robot* robot) {
  ChainReader(urdf, robot).read();
}

}  // namespace flexcomp::model
