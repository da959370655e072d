#include "model/rigid_body.hpp"

namespace flexcomp::model {
namespace {

/// Inertia of a point mass about the origin: what the parallel-axis theorem adds.
Matrix3<double> point_inertia(double mass, const Vector3<double>& at) {
  return mass * (at.squaredNorm() * Matrix3<double>::Identity() - at * at.transpose());
}

}  // namespace

void RigidBody::add(double mass, const Vector3<double>& center,
                    const Matrix3<double>& inertia_at_center) {
  mass_ += mass;
  first_moment_ += mass * center;
  inertia_ += inertia_at_center + point_inertia(mass, center);
}

Vector3<double> RigidBody::center_of_mass() const {
  return mass_ > 0 ? Vector3<double>(first_moment_ / mass_) : Vector3<double>::Zero();
}

Matrix3<double> RigidBody::inertia_at_center() const {
  return inertia_ - point_inertia(mass_, center_of_mass());
}

}  // namespace flexcomp::model
