#pragma once

#include <vector>

#include "check/regression.hpp"
#include "model/robot.hpp"
#include "simulation/scene.hpp"

/// Torques by what they are made of, and what the parts say of signs and scales.
namespace flexcomp::check {

/// Parts of a joint's torque, a column each.
enum Part : Eigen::Index { kWeight, kInertia, kDry, kViscous, kConstant, kFromWrench, kParts };

/// A joint's torque by what it is made of.
struct TorqueFit {
  bool is_there = false;
  Regression fit;
  double rms = 0;             ///< N·m, measured
  double friction = 0;        ///< N·m, at the usual speed
  double friction_noise = 0;  ///< N·m, its standard deviation
};

/// Votes of a torque's parts on its sign: 1, −1, or 0 where they do not tell.
struct Witnesses {
  int weight = 0;
  int inertia = 0;
  int friction = 0;

  bool all_turned() const {
    const bool none_right = weight <= 0 && inertia <= 0 && friction <= 0;
    // A missing balancer can turn what looks like weight, and poor inertias what looks like
    // inertia; no friction drives.
    return none_right && (friction < 0 || (inertia < 0 && weight < 0));
  }
};

Witnesses witnesses_of(const TorqueFit& torque);

/// The scale of a torque against the model's, by weight and inertia if they agree, or by one of
/// them that is most of the torque; 0 where they do not tell. Below a bound the latter alone will
/// do: rotors and payloads that a model lacks make torques larger, nothing makes them so much
/// smaller.
double scale_of(const TorqueFit& torque);

/// Fits of all joints: of torques, or where there are none of the joints' deflections, which go
/// with them.
std::vector<TorqueFit> fit_torques(const model::Robot& robot, const simulation::Scene& scene);

}  // namespace flexcomp::check
