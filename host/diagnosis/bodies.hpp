#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit.hpp"
#include "effects/machine_size.hpp"

namespace flexcomp::diagnosis {

/// The bodies among hypotheses that have an edge, and how far they are beyond what can be.
///
/// Masses are told by torques only in combinations: of the many that fit the same, one may be of
/// bodies that can be and another not. Who holds the bodies while all numbers are fitted finds the
/// first; who leaves out the impossible ones afterwards loses what the combination explained.
class Bodies {
 public:
  Bodies(const Observations& observations, const std::vector<Chosen>& chosen);

  /// How many numbers tell what is outside.
  Eigen::Index size() const { return size_; }

  /// The excess of each in a machine, a little before the edge already, over what it is held
  /// within; zeros inside.
  Eigen::VectorXd outside(const model::Robot& altered) const;

  /// Are all of them within what they can be, in a machine?
  bool can_be(const model::Robot& altered) const;

 private:
  const model::Robot& model_;
  effects::MachineSize size_of_machine_;
  std::vector<Hypothesis> bodies_;
  Eigen::Index size_ = 0;
};

}  // namespace flexcomp::diagnosis
