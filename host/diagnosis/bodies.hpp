#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit.hpp"
#include "effects/machine_size.hpp"

namespace flexcomp::diagnosis {

/// The bodies among hypotheses that have an edge, and their excess over bodies that can be.
///
/// Torques tell masses in combinations only: of many that fit the same, some are of bodies that can
/// be and some are not. Holding the bodies while all numbers are fitted finds the first. Leaving
/// out impossible ones afterwards would lose what their combination explains.
class Bodies {
 public:
  Bodies(const Observations& observations, const std::vector<Chosen>& chosen);

  /// Number of figures that tell an excess.
  Eigen::Index size() const { return size_; }

  /// The excess of each in a machine over the amount within which it is held; it begins a little
  /// before the edge, and is zero inside.
  Eigen::VectorXd outside(const model::Robot& altered) const;

  /// Are all bodies of a machine within their edges?
  bool can_be(const model::Robot& altered) const;

 private:
  const model::Robot& model_;
  effects::MachineSize size_of_machine_;
  std::vector<Hypothesis> bodies_;
  Eigen::Index size_ = 0;
};

}  // namespace flexcomp::diagnosis
