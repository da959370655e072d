#pragma once

#include <vector>

#include "formula/formula.hpp"

namespace flexcomp::formula {

/// A formula along a course of values, row after row: `lag` and `play` remember the rows before.
/// Copies go on by themselves.
class Course {
 public:
  /// `ahead`: by how much what lags begins above its input.
  explicit Course(const Formula& formula, double ahead = 0);

  /// The value at the next row: `values` of the formula's names, `step` (s) since the row before;
  /// zero where time does not matter, as in a load test, where nothing lags. At the first row what
  /// lags has caught up, unless it begins ahead. Not finite where the formula has no value there.
  double next(const std::vector<double>& values, double step);

 private:
  double computed(const Node& node, std::size_t at, const std::vector<double>& values, double step);
  double lagging(std::size_t at, double input, double constant, double step);
  double playing(std::size_t at, double input, double gap);

  const std::vector<Node>* nodes_;
  double ahead_;
  std::vector<double> now_;     ///< of every node
  std::vector<double> memory_;  ///< of every node that remembers
  std::vector<double> input_;   ///< that it had in the row before
  bool has_begun_ = false;
};

}  // namespace flexcomp::formula
