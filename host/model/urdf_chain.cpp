#include "model/urdf_chain.hpp"

#include <fmt/format.h>
#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "error.hpp"
#include "files/one_line.hpp"
#include "model/rigid_body.hpp"
#include "model/urdf_file.hpp"

namespace flexcomp::model {
namespace {

Vector3<double> vector(const urdf::Vector3& from) { return {from.x, from.y, from.z}; }

Pose<double> pose(const urdf::Pose& from) {
  const Eigen::Quaterniond rotation(from.rotation.w, from.rotation.x, from.rotation.y,
                                    from.rotation.z);
  return {rotation.normalized().toRotationMatrix(), vector(from.position)};
}

Matrix3<double> inertia(const urdf::Inertial& from) {
  Matrix3<double> tensor;
  tensor << from.ixx, from.ixy, from.ixz,  //
      from.ixy, from.iyy, from.iyz,        //
      from.ixz, from.iyz, from.izz;
  return tensor;
}

/// Rounding may make a principal moment of a thin body a little negative.
bool has_negative_principal_moment(const Matrix3<double>& inertia) {
  const Vector3<double> moments =
      Eigen::SelfAdjointEigenSolver<Matrix3<double>>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  return moments.minCoeff() < -1e-6 * moments.cwiseAbs().maxCoeff();
}

std::optional<JointType> type_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return JointType::revolute;
    case urdf::Joint::CONTINUOUS:
      return JointType::continuous;
    case urdf::Joint::PRISMATIC:
      return JointType::prismatic;
    default:
      return std::nullopt;
  }
}

const char* name_of_unusable(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::FLOATING:
      return "floating";
    case urdf::Joint::PLANAR:
      return "planar";
    default:
      return "of no known type";
  }
}

class ChainReader {
 public:
  ChainReader(const std::filesystem::path& file, Robot* robot)
      : file_(file), robot_(*robot), tree_(read_urdf(file)) {}

  void read() {
    const std::vector<urdf::JointConstSharedPtr> joints = joints_between();
    robot_.set_joints(count_of(joints));
    Pose<double> offset;
    std::size_t index = 0;
    for (const urdf::JointConstSharedPtr& joint : joints) {
      offset = offset * pose(joint->parent_to_joint_origin_transform);
      if (joint->type == urdf::Joint::FIXED) {
        continue;
      }
      read_joint(*joint, offset, index);
      read_body(*joint, joints, index);
      offset = Pose<double>{};
      ++index;
    }
    robot_.elastic.tool = offset;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("{}: {}", file_.string(), why));
  }

  [[noreturn]] void fail(const urdf::Joint& joint, const std::string& why) const {
    fail(fmt::format("joint '{}': {}", files::one_line(joint.name), why));
  }

  [[noreturn]] void fail(const urdf::Link& link, const std::string& why) const {
    fail(fmt::format("link '{}': {}", files::one_line(link.name), why));
  }

  std::string names_of_links() const {
    std::vector<std::string> names;
    for (const auto& [name, link] : tree_->links_) {
      names.push_back(name);
    }
    return fmt::format("{}", fmt::join(names, ", "));
  }

  std::vector<urdf::JointConstSharedPtr> joints_between() const {
    for (const std::string& name : {robot_.base_link, robot_.tool_link}) {
      if (!tree_->getLink(name)) {
        fail(fmt::format("has no link '{}', which {} names; it has {}", files::one_line(name),
                         robot_.yaml.string(), files::one_line(names_of_links(), 300)));
      }
    }
    std::vector<urdf::JointConstSharedPtr> joints;
    urdf::LinkConstSharedPtr link = tree_->getLink(robot_.tool_link);
    while (link && link->name != robot_.base_link) {
      if (link->parent_joint) {
        joints.push_back(link->parent_joint);
      }
      link = link->getParent();
    }
    if (!link) {
      fail(fmt::format("link '{}' does not lie beyond link '{}'", files::one_line(robot_.tool_link),
                       files::one_line(robot_.base_link)));
    }
    std::reverse(joints.begin(), joints.end());
    return joints;
  }

  /// How many joints move; fixed ones do not count.
  std::size_t count_of(const std::vector<urdf::JointConstSharedPtr>& joints) const {
    const std::string expected = fmt::format(
        "expected 1 to {} revolute, continuous or prismatic joints between '{}' and '{}'",
        kMostJoints, files::one_line(robot_.base_link), files::one_line(robot_.tool_link));
    std::size_t count = 0;
    for (const urdf::JointConstSharedPtr& joint : joints) {
      if (joint->type == urdf::Joint::FIXED) {
        continue;
      }
      if (!type_of(*joint)) {
        fail(*joint, fmt::format("is {}; {}", name_of_unusable(*joint), expected));
      }
      ++count;
    }
    if (count < 1 || count > static_cast<std::size_t>(kMostJoints)) {
      fail(fmt::format("{}, found {}", expected, count));
    }
    return count;
  }

  void read_joint(const urdf::Joint& from, const Pose<double>& origin, std::size_t index) {
    if (from.mimic) {
      fail(from, "mimics another; expected joints that move by themselves");
    }
    ChainJoint& to = robot_.elastic.joints[index];
    to.type = *type_of(from);
    to.origin = origin;
    to.axis = axis(from);
    read_limits(from, &to, &robot_.dynamics[index]);
    robot_.joint_names[index] = from.name;
  }

  void read_limits(const urdf::Joint& from, ChainJoint* to, JointDynamics* drive) const {
    const bool has_ends = to->type != JointType::continuous;
    if (has_ends && (!from.limits || !(from.limits->lower < from.limits->upper))) {
      fail(from, "expected limits with lower below upper");
    }
    to->lower = has_ends ? from.limits->lower : -kEndless;
    to->upper = has_ends ? from.limits->upper : kEndless;
    if (!from.limits) {
      return;
    }
    if (from.limits->effort < 0 || from.limits->velocity < 0) {
      fail(from, "the limits of effort and velocity must not be negative");
    }
    drive->effort = from.limits->effort;
    drive->velocity = from.limits->velocity;
  }

  /// Takes figures that were rounded to three digits, but nothing that was not meant as a unit
  /// vector.
  Vector3<double> axis(const urdf::Joint& joint) const {
    const Vector3<double> given = vector(joint.axis);
    const double length = given.norm();
    if (!(std::abs(length - 1) < 2e-3)) {
      fail(joint, fmt::format("the axis has length {:.6g}; expected a unit vector", length));
    }
    return given / length;
  }

  void read_body(const urdf::Joint& joint, const std::vector<urdf::JointConstSharedPtr>& chain,
                 std::size_t index) {
    const RigidBody body = body_moved_by(joint, chain);
    robot_.elastic.joints[index].mass = body.mass();
    robot_.elastic.joints[index].center_of_mass = body.center_of_mass();
    robot_.link_inertia[index] = body.inertia_at_center();
  }

  /// A joint's link and all that hangs on it up to the chain's next moving joint.
  RigidBody body_moved_by(const urdf::Joint& joint,
                          const std::vector<urdf::JointConstSharedPtr>& chain) const {
    RigidBody body;
    std::vector<std::pair<urdf::LinkConstSharedPtr, Pose<double>>> open;
    open.emplace_back(tree_->getLink(joint.child_link_name), Pose<double>{});
    while (!open.empty()) {
      const auto [link, frame] = open.back();
      open.pop_back();
      add_link(*link, frame, &body);
      for (const urdf::JointSharedPtr& child : link->child_joints) {
        const bool is_next = child->type != urdf::Joint::FIXED &&
                             std::find(chain.begin(), chain.end(), child) != chain.end();
        if (!is_next) {
          open.emplace_back(tree_->getLink(child->child_link_name),
                            frame * pose(child->parent_to_joint_origin_transform));
        }
      }
    }
    return body;
  }

  void add_link(const urdf::Link& link, const Pose<double>& frame, RigidBody* body) const {
    if (!link.inertial) {
      return;
    }
    const urdf::Inertial& own = *link.inertial;
    if (own.mass < 0) {
      fail(link, fmt::format("the mass must not be negative, found {}", own.mass));
    }
    if (has_negative_principal_moment(inertia(own))) {
      fail(link, "no body has this inertia: a principal moment is negative");
    }
    const Pose<double> center = frame * pose(own.origin);
    body->add(own.mass, center.position,
              center.rotation * inertia(own) * center.rotation.transpose());
  }

  const std::filesystem::path& file_;
  Robot& robot_;
  urdf::ModelInterfaceSharedPtr tree_;
};

}  // namespace

void read_urdf_chain(const std::filesystem::path& urdf, Robot* robot) {
  ChainReader(urdf, robot).read();
}

}  // namespace flexcomp::model
