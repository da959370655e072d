#pragma once

#include <string>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Some rows of a recording that follow each other.
struct Spell {
  std::size_t scene = 0;
  Part rows{};
};

/// When an effect acts that comes and goes while a machine is recorded, as the mass of a part that
/// is carried on every other move, or that begins and stays, as the zero of a clamp that slipped.
struct Spells {
  std::vector<Eigen::VectorXd> acts;  ///< by scene: one in each row in which it acts, else zero

  /// One in each sample in which it acts, else zero: the first `count` of the observations'.
  Eigen::VectorXd by_sample(const Observations& observations, Eigen::Index count) const;
  /// Those in which it acts, in their order.
  std::vector<Spell> all() const;
  /// How often it begins or ends within the recordings.
  std::size_t changes() const;
  /// Does it act in the last row of the last recording to fit to? So the machine was left.
  bool lasts(const Observations& observations) const;
};

}  // namespace flexcomp::diagnosis
