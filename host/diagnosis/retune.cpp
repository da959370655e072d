#include "diagnosis/retune.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence.hpp"
#include "diagnosis/families/families.hpp"
#include "diagnosis/families/possible_bodies.hpp"
#include "diagnosis/families/regression.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kKnown = 2;               // deviations from what the model has
constexpr double kTinyDeviation = 1e-300;  // against a division by zero

/// Findings, and behind them the numbers that they do not alter, as they are.
std::vector<Chosen> with_numbers(const Fit& findings, const std::vector<Hypothesis>& hypotheses,
                                 const Dictionary& dictionary) {
  std::vector<Chosen> all = findings.chosen;
  for (const Hypothesis& each : hypotheses) {
    if (each.traits().is_model_number && !is_chosen(findings.chosen, each) &&
        dictionary.find(each) != nullptr) {
      all.push_back({each, Values(each.parameters.size(), 0.0)});
    }
  }
  return all;
}

void drop(Eigen::Index index, Eigen::VectorXd* value, Eigen::MatrixXd* covariance) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < value->size(); ++i) {
    if (i != index) {
      others.push_back(i);
    }
  }
  *value = (*value)(others).eval();
  *covariance = (*covariance)(others, others).eval();
}

/// Findings, and behind them the numbers that can be told from what they are: one at a time the one
/// that is fewest deviations from zero is put back, as far as this is so, and what the others are
/// without it follows from the covariance.
std::vector<Chosen> known_of(const Fit& fit, std::size_t findings) {
  std::vector<Chosen> known = fit.chosen;
  const auto count = static_cast<Eigen::Index>(known.size() - findings);
  Eigen::VectorXd value(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    value[i] = known[findings + static_cast<std::size_t>(i)].values.front();
  }
  Eigen::MatrixXd covariance = fit.covariance.bottomRightCorner(count, count);
  while (value.size() > 0) {
    Eigen::Index weakest = 0;
    const Eigen::ArrayXd deviation = covariance.diagonal().cwiseMax(0).cwiseSqrt();
    const double least = (deviation > 0)
                             .select(value.array().abs() / deviation.max(kTinyDeviation), 0)
                             .minCoeff(&weakest);
    if (least >= kKnown) {
      break;
    }
    const double variance = std::max(covariance(weakest, weakest), kTinyDeviation);
    const Eigen::VectorXd share = covariance.col(weakest) / variance;
    value -= share * value[weakest];
    covariance -= variance * share * share.transpose();
    drop(weakest, &value, &covariance);
    known.erase(known.begin() + static_cast<std::ptrdiff_t>(findings) + weakest);
  }
  return known;
}

/// The few numbers that every model has: those that can be told from what they are.
Fit fit_model_numbers(const Observations& observations, const Fit& findings,
                      const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  const std::size_t found = findings.chosen.size();
  Fit tuned = fit(observations, with_numbers(findings, hypotheses, dictionary), kSimulatedSteps,
                  &dictionary);
  const auto kept = [&] {
    const auto possible = without_impossible(observations, tuned, found, false);
    return possible ? *possible : known_of(tuned, found);
  };
  for (std::vector<Chosen> next = kept(); next.size() < tuned.chosen.size(); next = kept()) {
    tuned = fit(observations, std::move(next), kSimulatedSteps, &dictionary);
  }
  return tuned;
}

/// Do the numbers behind the findings stand?
bool stands(const Observations& observations, const Fit& findings, const Fit& tuned) {
  return tuned.chosen.size() > findings.chosen.size() &&
         !without_impossible(observations, tuned, findings.chosen.size(), false) &&
         bic_gain(observations, findings, tuned) > kStrongEvidence &&
         predicts_better(observations, findings, tuned);
}

}  // namespace

Fit retune(const Observations& observations, const Fit& findings,
           const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  Fit best;
  Fit numbers;
  Fit families;
  in_parallel(
      2, [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        if (i == 0) {
          numbers = fit_model_numbers(observations, findings, hypotheses, dictionary);
        } else {
          families = fit_families(observations, findings, hypotheses, dictionary).fit;
        }
      });
  // Nothing holds these to the model: large changes that cancel each other imitate what is not
  // there.
  if (stands(observations, findings, numbers) &&
      cancellation(observations, numbers) < kMostCancellation) {
    best = std::move(numbers);
  }
  if (stands(observations, findings, families) &&
      (best.chosen.empty() || predicts_better(observations, best, families))) {
    best = std::move(families);
  }
  return best;
}

Families retune_whole(const Observations& observations, const Fit& given,
                      const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                      const std::vector<Chosen>& known) {
  Families families = fit_families(observations, given, hypotheses, dictionary, known);
  return stands(observations, given, families.fit) ? families : Families{};
}

}  // namespace flexcomp::diagnosis
