#pragma once

#include <memory>
#include <vector>

#include "effects/formula_law.hpp"

namespace flexcomp::effects {

/// The laws that a robot's file has as formulas, while it runs: what moves its TCP, period by
/// period.
///
/// Speeds and accelerations are differences of the angles from period to period. Other effects of
/// the file are not in it, and of the laws not those of what only a measurement shows.
class RunningLaws {
 public:
  /// `period`: s. Throws InputError as `listed_effects` does, and for a law that follows temp_c.
  RunningLaws(const model::Robot& robot, double period);

  bool any() const { return !laws_.empty(); }

  /// The TCP's shift (m, base frame) by all laws in the next period. Throws InputError where a
  /// formula has no value.
  Vector3<double> next(const model::JointValues& q, const Wrench<double>& wrench);

 private:
  struct Running {
    std::shared_ptr<const BoundFormula> bound;
    formula::Course course;
    std::vector<double> values;  ///< of the formula's names
  };

  Machine machine_;
  double period_;
  std::vector<Running> laws_;
  Scene scene_;  ///< of one row
  bool has_begun_ = false;
};

}  // namespace flexcomp::effects
