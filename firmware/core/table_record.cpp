#include "table_record.hpp"

#include "instantiate.hpp"

namespace flexcomp {
namespace {

template <typename Derived>
float* put(const Eigen::MatrixBase<Derived>& values, float* to) {
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      *to++ = static_cast<float>(values(row, column));
    }
  }
  return to;
}

}  // namespace

template <typename Scalar, int Joints>
void pack(const TableEntry<Scalar, Joints>& entry, const RecordLayout& layout, float* record) {
  put(entry.jacobian, record + layout.jacobian);
  if (layout.has_weight) {
    put(entry.weight_torque, record + layout.weight_torque);
  }
  if (layout.has_structure) {
    float* to = record + layout.structure;
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = 0; column <= row; ++column) {
        *to++ = static_cast<float>(entry.structure(row, column));
      }
    }
    put(entry.structure_motion, record + layout.structure_motion);
  }
  if (layout.has_structure && layout.has_weight) {
    put(entry.structure_weight, record + layout.structure_weight);
    put(entry.structure_weight_motion, record + layout.structure_weight_motion);
  }
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> unpack(const Scalar* record, const RecordLayout& layout) {
  using Joint = JointVector<Scalar, Joints>;
  TableEntry<Scalar, Joints> entry;
  entry.jacobian = Eigen::Map<const Jacobian<Scalar, Joints>>(record + layout.jacobian);
  entry.weight_torque.setZero();
  entry.structure.setZero();
  entry.structure_motion.setZero();
  entry.structure_weight.setZero();
  entry.structure_weight_motion.setZero();
  entry.outside = 0;
  if (layout.has_weight) {
    entry.weight_torque = Eigen::Map<const Joint>(record + layout.weight_torque);
  }
  if (layout.has_structure) {
    const Scalar* from = record + layout.structure;
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = 0; column <= row; ++column) {
        entry.structure(row, column) = *from;
        entry.structure(column, row) = *from++;
      }
    }
    entry.structure_motion =
        Eigen::Map<const Eigen::Matrix<Scalar, Joints, 6>>(record + layout.structure_motion);
  }
  if (layout.has_structure && layout.has_weight) {
    entry.structure_weight = Eigen::Map<const Twist<Scalar>>(record + layout.structure_weight);
    entry.structure_weight_motion =
        Eigen::Map<const Joint>(record + layout.structure_weight_motion);
  }
  return entry;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> exact_entry(const RobotModel<Scalar, Joints>& model,
                                       const JointVector<Scalar, Joints>& q) {
  const Kinematics<Scalar, Joints> kinematics = forward_kinematics(model, q);
  TableEntry<Scalar, Joints> entry;
  entry.jacobian = geometric_jacobian<Scalar, Joints>(kinematics);
  entry.weight_torque = weight_torque(model, kinematics);
  entry.structure.setZero();
  entry.structure_motion.setZero();
  entry.structure_weight.setZero();
  entry.structure_weight_motion.setZero();
  entry.outside = 0;
  if (has_structure_springs(model)) {
    entry.structure = structure_compliance(model, kinematics);
    entry.structure_weight = structure_weight_deflection(model, kinematics);
    for (Eigen::Index column = 0; column < 6; ++column) {
      const Twist<Scalar> twist = entry.structure.col(column);
      entry.structure_motion.col(column) = joint_motion<Scalar, Joints>(entry.jacobian, twist);
    }
    entry.structure_weight_motion =
        joint_motion<Scalar, Joints>(entry.jacobian, entry.structure_weight);
  }
  return entry;
}

#define FLEXCOMP_TABLE_RECORD(Scalar, Joints)                                         \
  template void pack(const TableEntry<Scalar, Joints>&, const RecordLayout&, float*); \
  template TableEntry<Scalar, Joints> unpack(const Scalar*, const RecordLayout&);     \
  template TableEntry<Scalar, Joints> exact_entry(const RobotModel<Scalar, Joints>&,  \
                                                  const JointVector<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE_RECORD)

}  // namespace flexcomp
