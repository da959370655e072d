#include "formula/course.hpp"

#include <algorithm>
#include <cmath>

#include "formula/functions.hpp"

namespace flexcomp::formula {

Course::Course(const Formula& formula, double ahead)
    : nodes_(&formula.nodes()),
      ahead_(ahead),
      now_(nodes_->size(), 0),
      memory_(nodes_->size(), 0),
      input_(nodes_->size(), 0) {}

double Course::next(const std::vector<double>& values, double step) {
  for (std::size_t i = 0; i < nodes_->size(); ++i) {
    now_[i] = computed((*nodes_)[i], i, values, step);
  }
  has_begun_ = true;
  return now_.back();
}

double Course::computed(const Node& node, std::size_t at, const std::vector<double>& values,
                        double step) {
  const double a = now_[node.operand[0]];
  const double b = now_[node.operand[1]];
  switch (node.operation) {
    case Operation::number:
      return node.number;
    case Operation::name:
      return values[node.index];
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return std::pow(a, b);
    case Operation::negate:
      return -a;
    case Operation::call:
      break;
  }
  if (node.index == kLag) {
    return lagging(at, a, b, step);
  }
  return node.index == kPlay ? playing(at, a, b) : kFunctions[node.index].value(a, b);
}

// Exact for an input that is straight between the rows.
double Course::lagging(std::size_t at, double input, double constant, double step) {
  const bool lags = has_begun_ && step > 0 && constant > 0;
  const double share = lags ? std::exp(-step / constant) : 0;
  const double slope = lags ? (input - input_[at]) / step : 0;
  const double behind = slope * std::max(constant, 0.0);
  const double begun = has_begun_ ? input : input + ahead_;
  memory_[at] = lags ? input - behind + (memory_[at] - input_[at] + behind) * share : begun;
  input_[at] = input;
  return memory_[at];
}

double Course::playing(std::size_t at, double input, double gap) {
  const double half = std::max(0.5 * gap, 0.0);
  memory_[at] = has_begun_ ? std::min(std::max(memory_[at], input - half), input + half) : input;
  return memory_[at];
}

}  // namespace flexcomp::formula
