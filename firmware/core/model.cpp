#include "flexcomp/model.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstring>

#include "checked_number.hpp"
#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// FNV-1a over 32-bit words in little-endian byte order (Fowler, Noll, Vo).
class Fingerprint {
 public:
  void add(float value) {
    const float plain = value + 0.0F;  // -0 and +0 are the same robot
    std::uint32_t word = 0;
    std::memcpy(&word, &plain, sizeof word);
    for (int shift = 0; shift < 32; shift += 8) {
      hash_ = (hash_ ^ ((word >> shift) & 0xFFU)) * 0x100000001B3ULL;
    }
  }

  template <typename Derived>
  void add(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      add(static_cast<float>(values.derived().coeff(i % values.rows(), i / values.rows())));
    }
  }

  template <typename Scalar>
  void add(const Pose<Scalar>& pose) {
    add(pose.rotation);
    add(pose.position);
  }

  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

template <typename Scalar>
bool is_rigid(const Pose<Scalar>& pose) {
  if (!pose.position.allFinite() || !pose.rotation.allFinite()) {
    return false;
  }
  const Matrix3<Scalar> error =
      pose.rotation.transpose() * pose.rotation - Matrix3<Scalar>::Identity();
  return error.cwiseAbs().maxCoeff() < Scalar(1e-4) && pose.rotation.determinant() > Scalar(0);
}

template <typename Derived>
bool none_negative(const Eigen::MatrixBase<Derived>& values) {
  using Scalar = typename Derived::Scalar;
  return values.allFinite() && (values.array() >= Scalar(0)).all();
}

template <typename Scalar>
bool not_negative(Scalar value) {
  return std::isfinite(value) && value >= Scalar(0);
}

template <typename Scalar>
const char* unusable_member_of(const Joint<Scalar>& joint) {
  return first_unusable<9>({{
      {is_rigid(joint.origin), "origin"},
      {joint.axis.allFinite() && std::abs(joint.axis.norm() - Scalar(1)) < Scalar(1e-4), "axis"},
      {std::isfinite(joint.lower), "lower"},
      {std::isfinite(joint.upper) && joint.lower < joint.upper, "upper"},
      {not_negative(joint.compliance), "compliance"},
      {std::isfinite(joint.cubic_compliance), "cubic_compliance"},
      {none_negative(joint.link_compliance), "link_compliance"},
      {not_negative(joint.mass), "mass"},
      {joint.center_of_mass.allFinite(), "center_of_mass"},
  }});
}

}  // namespace

template <typename Scalar, int Joints>
UnusableMember unusable_member(const RobotModel<Scalar, Joints>& model) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (const char* const name = unusable_member_of(model.joints[i])) {
      return {name, i};
    }
  }
  const char* const name = first_unusable<6>({{
      {is_rigid(model.tool), "tool"},
      {none_negative(model.base_compliance), "base_compliance"},
      {none_negative(model.tool_compliance), "tool_compliance"},
      {model.gravity.allFinite(), "gravity"},
      {not_negative(model.payload_mass), "payload_mass"},
      {model.payload_center.allFinite(), "payload_center"},
  }});
  return {name, model.joints.size()};
}

template <typename Scalar, int Joints>
Result validate(const RobotModel<Scalar, Joints>& model) {
  return unusable_member(model).name == nullptr ? Result::ok : Result::bad_model;
}

template <typename Scalar, int Joints>
bool has_structure_springs(const RobotModel<Scalar, Joints>& model) {
  bool any = !model.base_compliance.isZero(Scalar(0)) || !model.tool_compliance.isZero(Scalar(0));
  for (const Joint<Scalar>& joint : model.joints) {
    any = any || !joint.link_compliance.isZero(Scalar(0));
  }
  return any;
}

template <typename Scalar, int Joints>
bool has_weight(const RobotModel<Scalar, Joints>& model) {
  return !model.gravity.isZero(Scalar(0));
}

template <typename Scalar, int Joints>
std::uint64_t model_hash(const RobotModel<Scalar, Joints>& model) {
  Fingerprint hash;
  for (const Joint<Scalar>& joint : model.joints) {
    hash.add(joint.origin);
    hash.add(joint.axis);
    hash.add(static_cast<float>(joint.lower));
    hash.add(static_cast<float>(joint.upper));
    hash.add(static_cast<float>(joint.compliance));
    hash.add(static_cast<float>(joint.cubic_compliance));
    hash.add(joint.link_compliance);
    hash.add(static_cast<float>(joint.mass));
    hash.add(joint.center_of_mass);
  }
  hash.add(model.tool);
  hash.add(model.base_compliance);
  hash.add(model.tool_compliance);
  hash.add(model.gravity);
  hash.add(static_cast<float>(model.payload_mass));
  hash.add(model.payload_center);
  return hash.value();
}

#define FLEXCOMP_VALIDATE(Scalar, Joints)                                     \
  template UnusableMember unusable_member(const RobotModel<Scalar, Joints>&); \
  template Result validate(const RobotModel<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE_CONTROL(FLEXCOMP_VALIDATE)

#define FLEXCOMP_MODEL(Scalar, Joints)                                    \
  template bool has_structure_springs(const RobotModel<Scalar, Joints>&); \
  template bool has_weight(const RobotModel<Scalar, Joints>&);            \
  template std::uint64_t model_hash(const RobotModel<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE_ARM(FLEXCOMP_MODEL)

}  // namespace flexcomp
