#include "formula/proportion.hpp"

#include <algorithm>
#include <cmath>

#include "formula/functions.hpp"

namespace flexcomp::formula {
namespace {

constexpr int kMixed = -1;  ///< no degree: terms of several, or within a function

int degree_of_power(const Formula& formula, const Node& node, int base, int exponent) {
  double value = 0;
  if (base == 0 && exponent == 0) {
    return 0;
  }
  const bool is_first = base == 1 && is_constant(formula, node.operand[1], &value) && value == 1;
  return is_first ? 1 : kMixed;
}

int degree_of(const Formula& formula, const Node& node, const std::vector<int>& before,
              const std::vector<bool>& in_set) {
  const int a = node.operation == Operation::name || node.operation == Operation::number
                    ? 0
                    : before[node.operand[0]];
  const int b = node.operation == Operation::name || node.operation == Operation::number
                    ? 0
                    : before[node.operand[1]];
  if (a == kMixed || b == kMixed) {
    return kMixed;
  }
  switch (node.operation) {
    case Operation::number:
      return 0;
    case Operation::name:
      return in_set[node.index] ? 1 : 0;
    case Operation::add:
    case Operation::subtract:
      return a == b ? a : kMixed;
    case Operation::multiply:
      return a + b;
    case Operation::divide:
      return b == 0 ? a : kMixed;
    case Operation::power:
      return degree_of_power(formula, node, a, b);
    case Operation::negate:
      return a;
    case Operation::call:
      return (node.index == kLag && b == 0) || (a == 0 && b == 0) ? a : kMixed;
  }
  return kMixed;
}

bool acts_in_proportion(const Formula& formula, const std::vector<bool>& in_set) {
  std::vector<int> degrees;
  for (const Node& node : formula.nodes()) {
    degrees.push_back(degree_of(formula, node, degrees, in_set));
  }
  return degrees.back() == 1;
}

}  // namespace

std::vector<std::size_t> in_proportion(const Formula& formula,
                                       const std::vector<std::size_t>& candidates) {
  constexpr std::size_t kMost = 12;
  std::vector<std::size_t> best;
  if (candidates.size() > kMost) {
    return best;
  }
  for (std::size_t bits = 1; bits < std::size_t{1} << candidates.size(); ++bits) {
    std::vector<std::size_t> set;
    std::vector<bool> in_set(formula.names().size(), false);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if ((bits >> i & 1) != 0) {
        set.push_back(candidates[i]);
        in_set[candidates[i]] = true;
      }
    }
    if (set.size() > best.size() && acts_in_proportion(formula, in_set)) {
      best = std::move(set);
    }
  }
  return best;
}

}  // namespace flexcomp::formula
