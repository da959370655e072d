#pragma once

#include <Eigen/Core>

#include "study/planar_arm.hpp"

namespace flexcomp::study {

/// As many points of a path as are computed at a time: no memory is asked for, and the processor's
/// vectors are full.
constexpr Eigen::Index kStretch = 8;
using Values = Eigen::Array<double, kStretch, 1>;

/// Points or vectors of the plane, along a stretch of a path.
struct PlanarPath {
  Values x;
  Values z;

  static PlanarPath constant(Planar value) {
    return {Values::Constant(value.real()), Values::Constant(value.imag())};
  }
  PlanarPath operator+(const PlanarPath& other) const { return {x + other.x, z + other.z}; }
  PlanarPath operator-(const PlanarPath& other) const { return {x - other.x, z - other.z}; }
  PlanarPath shifted(Planar by) const { return {x + by.real(), z + by.imag()}; }
  PlanarPath turned(Planar by) const {
    return {by.real() * x - by.imag() * z, by.imag() * x + by.real() * z};
  }
  Planar operator[](Eigen::Index i) const { return {x[i], z[i]}; }
  void set(Eigen::Index i, Planar value) {
    x[i] = value.real();
    z[i] = value.imag();
  }
};

/// Each vector times the conjugate of the other's: its direction from there.
inline PlanarPath relative(const PlanarPath& a, const PlanarPath& b) {
  return {a.x * b.x + a.z * b.z, a.z * b.x - a.x * b.z};
}

/// A stretch of the circle, about its centre.
struct CircleStretch {
  PlanarPath tool;     ///< m
  PlanarPath turning;  ///< of the wrench, as a unit vector
  PlanarPath force;    ///< N
};

/// The levers at each point of a stretch.
struct Levers {
  PlanarPath shoulder;  ///< from joint 2 to the tool point
  PlanarPath elbow;     ///< from joint 3
  PlanarPath wrist;     ///< from joint 5; not set where that is the tool point
};

}  // namespace flexcomp::study
