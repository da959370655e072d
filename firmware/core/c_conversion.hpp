#pragma once

#include "flexcomp/flexcomp.h"
#include "flexcomp/model.hpp"

/// Conversions that the parts of the C interface share.
namespace flexcomp::c_api {

constexpr int kJoints = FLEXCOMP_JOINTS;
using Model = RobotModel<float, kJoints>;
using Vector6 = Eigen::Matrix<float, 6, 1>;

inline flexcomp_result_t to_c(flexcomp::Result result) {
  return static_cast<flexcomp_result_t>(result);
}

inline Vector6 vector6(const float* from) { return Eigen::Map<const Vector6>(from); }
inline Eigen::Vector3f vector3(const float* from) {
  return Eigen::Map<const Eigen::Vector3f>(from);
}

template <typename Derived>
void copy(const Eigen::MatrixBase<Derived>& from, float* to) {
  for (Eigen::Index row = 0; row < from.rows(); ++row) {
    for (Eigen::Index column = 0; column < from.cols(); ++column) {
      *to++ = from(row, column);
    }
  }
}

inline flexcomp::Pose<float> pose(const flexcomp_pose_t& from) {
  using RowMajor = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
  return {Eigen::Map<const RowMajor>(from.rotation), vector3(from.position)};
}

inline Model convert(const flexcomp_model_t& from) {
  Model model;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const flexcomp_joint_t& joint = from.joints[i];
    model.joints[i].origin = pose(joint.origin);
    model.joints[i].axis = vector3(joint.axis);
    model.joints[i].lower = joint.lower;
    model.joints[i].upper = joint.upper;
    model.joints[i].compliance = joint.compliance;
    model.joints[i].cubic_compliance = joint.cubic_compliance;
    model.joints[i].link_compliance = vector6(joint.link_compliance);
    model.joints[i].mass = joint.mass;
    model.joints[i].center_of_mass = vector3(joint.center_of_mass);
  }
  model.tool = pose(from.tool);
  model.base_compliance = vector6(from.base_compliance);
  model.tool_compliance = vector6(from.tool_compliance);
  model.gravity = vector3(from.gravity);
  model.payload_mass = from.payload_mass;
  model.payload_center = vector3(from.payload_center);
  return model;
}

}  // namespace flexcomp::c_api
