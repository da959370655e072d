#pragma once

#include "flexcomp/types.hpp"

namespace flexcomp::model {

/// Rigid bodies added up: mass (kg), first moment (kg·m) and inertia (kg·m²) about a frame's
/// origin, because those three add where centres of mass and inertias about them do not.
class RigidBody {
 public:
  /// Adds a body by its mass, its centre of mass and its inertia about that centre, all in the
  /// frame.
  void add(double mass, const Vector3<double>& center, const Matrix3<double>& inertia_at_center);

  double mass() const { return mass_; }

  /// The origin for a body without mass.
  Vector3<double> center_of_mass() const;

  Matrix3<double> inertia_at_center() const;

 private:
  double mass_ = 0;
  Vector3<double> first_moment_ = Vector3<double>::Zero();
  Matrix3<double> inertia_ = Matrix3<double>::Zero();
};

}  // namespace flexcomp::model
