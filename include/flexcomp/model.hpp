#pragma once

/// @file
/// A robot: joints, springs and weights.

#include <array>
#include <cstddef>
#include <cstdint>

#include "flexcomp/status.hpp"
#include "flexcomp/types.hpp"

namespace flexcomp {

/// One revolute joint, the spring behind it, and the link that it moves.
///
/// The link frame coincides with the joint frame turned by the joint angle about `axis`.
template <typename Scalar>
struct Joint {
  Pose<Scalar> origin;                              ///< joint frame in the previous link's frame
  Vector3<Scalar> axis = Vector3<Scalar>::UnitZ();  ///< unit vector in the joint frame
  Scalar lower = 0;                                 ///< rad, smallest allowed angle
  Scalar upper = 0;                                 ///< rad, largest allowed angle
  Scalar compliance = 0;                            ///< rad/(N·m), c1 in wind-up = c1 τ + c3 τ³
  Scalar cubic_compliance = 0;  ///< rad/(N·m)³, c3; below zero for a hardening spring
  DiagonalCompliance<Scalar> link_compliance =  ///< of the moved link, in its frame, at its origin
      DiagonalCompliance<Scalar>::Zero();
  Scalar mass = 0;                                           ///< kg, of the moved link
  Vector3<Scalar> center_of_mass = Vector3<Scalar>::Zero();  ///< m, in the link frame
};

/// A serial robot with springs: the virtual-joint model of Klimchik et al. (2017).
///
/// The robot base frame is the frame of everything that has no other frame in its name.
template <typename Scalar, int Joints>
struct RobotModel {
  std::array<Joint<Scalar>, Joints> joints;  ///< base to tip
  Pose<Scalar> tool;                         ///< TCP frame in the last link's frame
  DiagonalCompliance<Scalar> base_compliance = DiagonalCompliance<Scalar>::Zero();  ///< base frame
  DiagonalCompliance<Scalar> tool_compliance = DiagonalCompliance<Scalar>::Zero();  ///< tool frame
  Vector3<Scalar> gravity = Vector3<Scalar>::Zero();         ///< m/s²; zero leaves weight out
  Scalar payload_mass = 0;                                   ///< kg, beside the links' masses
  Vector3<Scalar> payload_center = Vector3<Scalar>::Zero();  ///< m, in the tool frame

  /// Same robot in another precision.
  template <typename Other>
  RobotModel<Other, Joints> cast() const;
};

/// A member that is out of its range.
struct UnusableMember {
  const char* name = nullptr;  ///< null where there is none
  std::size_t joint = 0;       ///< from 0; as many as there are joints for a member of the model
};

/// The first member that `validate` refuses.
template <typename Scalar, int Joints>
UnusableMember unusable_member(const RobotModel<Scalar, Joints>& model);

/// Checks that every number is finite, axes have unit length, rotations are orthonormal, limits are
/// ordered, and compliances and masses are not negative (the cubic term may be: a hardening
/// spring).
///
/// Returns `Result::ok` or `Result::bad_model` (`unusable_member`).
template <typename Scalar, int Joints>
Result validate(const RobotModel<Scalar, Joints>& model);

/// Does the model have springs other than those of the joints?
template <typename Scalar, int Joints>
bool has_structure_springs(const RobotModel<Scalar, Joints>& model);

/// Does weight act in the model?
template <typename Scalar, int Joints>
bool has_weight(const RobotModel<Scalar, Joints>& model);

/// 64-bit FNV-1a fingerprint of all parameters rounded to `float`, so that host (`double`) and
/// target (`float`) agree. It ties a table to the robot, tool and payload it was made for.
template <typename Scalar, int Joints>
std::uint64_t model_hash(const RobotModel<Scalar, Joints>& model);

template <typename Scalar, int Joints>
template <typename Other>
RobotModel<Other, Joints> RobotModel<Scalar, Joints>::cast() const {
  const auto pose = [](const Pose<Scalar>& from) {
    return Pose<Other>{from.rotation.template cast<Other>(), from.position.template cast<Other>()};
  };
  RobotModel<Other, Joints> to;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint<Scalar>& from = joints[i];
    to.joints[i].origin = pose(from.origin);
    to.joints[i].axis = from.axis.template cast<Other>();
    to.joints[i].lower = static_cast<Other>(from.lower);
    to.joints[i].upper = static_cast<Other>(from.upper);
    to.joints[i].compliance = static_cast<Other>(from.compliance);
    to.joints[i].cubic_compliance = static_cast<Other>(from.cubic_compliance);
    to.joints[i].link_compliance = from.link_compliance.template cast<Other>();
    to.joints[i].mass = static_cast<Other>(from.mass);
    to.joints[i].center_of_mass = from.center_of_mass.template cast<Other>();
  }
  to.tool = pose(tool);
  to.base_compliance = base_compliance.template cast<Other>();
  to.tool_compliance = tool_compliance.template cast<Other>();
  to.gravity = gravity.template cast<Other>();
  to.payload_mass = static_cast<Other>(payload_mass);
  to.payload_center = payload_center.template cast<Other>();
  return to;
}

}  // namespace flexcomp
