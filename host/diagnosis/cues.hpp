#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// A quantity along a recording, sorted into classes.
struct Cue {
  std::string name;
  int joint = 0;         ///< 0 where it belongs to none
  Eigen::VectorXi kind;  ///< n, class of each row, 0 … classes − 1
  int classes = 0;
};

/// Cues of one scene; the same ones in the same order for all scenes of a recording session. Of a
/// joint: angle, load, speed, direction of motion, and time since it turned back (where its
/// velocity changes sign along the path). Of the machine: time, temperature and path angle, the
/// angle about the middle of the path in its plane.
std::vector<Cue> cues_of(const Scene& scene, const Prediction& prediction,
                         const Simulation& simulation);

}  // namespace flexcomp::diagnosis
