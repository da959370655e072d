#include "diagnosis/select/judge.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/plausible.hpp"
#include "diagnosis/select/standards.hpp"
#include "statistics/distributions.hpp"

namespace flexcomp::diagnosis {

Eigen::MatrixXd Finding::whole_covariance() const {
  Eigen::MatrixXd whole = covariance;
  if (hidden.size() > 0) {
    whole.diagonal() += hidden;
  }
  return whole;
}

Evidence weigh_last(const Inquiry& inquiry, const Fit& before, const Fit& after) {
  return weigh(inquiry.observations, before, after,
               static_cast<double>(inquiry.dictionary.entries.size()));
}

Finding judge(const Inquiry& inquiry, const Fit& whole, std::size_t index) {
  const auto at = static_cast<std::ptrdiff_t>(index);
  Fit without = fit_without(inquiry, whole, index);
  Fit last = whole;  // the same fit, its last hypothesis the one that is weighed
  std::rotate(last.chosen.begin() + at, last.chosen.begin() + at + 1, last.chosen.end());
  Evidence evidence = weigh_last(inquiry, without, last);
  return {whole.chosen[index], {}, std::move(evidence), std::move(without), {}, {}, {}};
}

bool are_told_from_nothing(const Chosen& chosen, const Eigen::MatrixXd& covariance) {
  constexpr double kChance = 0.05;  // as of the interval
  const auto count = static_cast<Eigen::Index>(chosen.hypothesis.linear);
  if (count == 0) {
    return true;
  }
  const Eigen::Map<const Eigen::VectorXd> value(chosen.values.data(), count);
  const Eigen::MatrixXd inverse =
      covariance.topLeftCorner(count, count).completeOrthogonalDecomposition().pseudoInverse();
  return statistics::chi_squared_above(value.dot(inverse * value), static_cast<double>(count)) <
         kChance;
}

bool holds(const Inquiry& inquiry, const Evidence& evidence) {
  const bool is_static = inquiry.observations.is_static;
  return evidence.impossible.empty() && evidence.delta_bic > kStrongEvidence &&
         evidence.p_value < inquiry.false_discovery && evidence.confirmation > kConfirmed &&
         evidence.strength > kLeastStrength &&
         (is_static || evidence.relative_strength > kExactness) &&
         (is_static || evidence.beyond_noise > kLeastBeyondNoise ||
          evidence.confirmation > kOverwhelming) &&
         evidence.share > kLeastShare;
}

bool stands(const Inquiry& inquiry, const Evidence& evidence) {
  return holds(inquiry, evidence) && evidence.lowers_held_out;
}

bool can_be(const Inquiry& inquiry, const Fit& fit) {
  return why_impossible(inquiry.observations, fit, fit.chosen.size() - 1).empty();
}

double criterion(const Observations& observations, const Fit& fit) {
  int fitted = 0;
  for (const Chosen& each : fit.chosen) {
    for (std::size_t i = 0; i < each.values.size(); ++i) {
      const Parameter& parameter = each.hypothesis.parameters[i];
      fitted += each.values[i] > parameter.lower && each.values[i] < parameter.upper ? 1 : 0;
    }
  }
  const auto samples = static_cast<double>(observations.train);
  return samples * std::log(std::max(fit.train_sum, 1e-9)) + fitted * std::log(samples);
}

bool is_better(const Inquiry& inquiry, const Fit& one, const Fit& other) {
  const double margin = one.chosen.size() < other.chosen.size() ? 0 : kStrongEvidence;
  if (!(criterion(inquiry.observations, one) < criterion(inquiry.observations, other) - margin)) {
    return false;
  }
  for (std::size_t i = 0; i < one.chosen.size(); ++i) {
    if (!holds(inquiry, judge(inquiry, one, i).evidence)) {
      return false;
    }
  }
  return true;
}

Attempt better_of(const Inquiry& inquiry, Attempt best, Attempt rival) {
  return is_better(inquiry, rival.fit, best.fit) ? rival : best;
}

bool is_as_good(const Inquiry& inquiry, const Fit& plain, const Fit& rich) {
  return bic_gain(inquiry.observations, plain, rich) < kStrongEvidence;
}

bool is_confirmed(const Inquiry& inquiry, const Fit& plain, const Fit& rich) {
  return confirmation_of(inquiry.observations, plain.remainder, rich.remainder) > kConfirmed;
}

Fit fit_with(const Inquiry& inquiry, const Fit& before, const Chosen& chosen, int steps) {
  std::vector<Chosen> all = before.chosen;
  all.push_back(chosen);
  return fit(inquiry.observations, std::move(all), steps, &inquiry.dictionary);
}

Fit fit_without(const Inquiry& inquiry, const Fit& whole, std::size_t index) {
  std::vector<Chosen> others = whole.chosen;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(index));
  return fit(inquiry.observations, std::move(others), kQuickSteps, &inquiry.dictionary);
}

}  // namespace flexcomp::diagnosis
