#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kSameEvidence = 6;      // of BIC: below "strong" (Kass and Raftery 1995)
constexpr double kNoiseLike = 1.15;      // times the noise: nothing left to explain
constexpr double kLeastExplained = 0.9;  // of the power of a mismatch, for findings to stand
constexpr double kMostCancellation = 10;
constexpr Eigen::Index kFewestSamples = 24;
constexpr Eigen::Index kLeastFreedom = 8;

bool has_enough(const Observations& observations) {
  return observations.train >= kFewestSamples && observations.size() > observations.train;
}

/// A load test's noise is what the fullest fit leaves; single samples far from it are outliers.
void learn_noise(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                 const Dictionary& dictionary) {
  constexpr double kFar = 6;
  const FullestFit full = fit_all(*observations, hypotheses, dictionary);
  if (full.freedom < kLeastFreedom) {
    return;
  }
  const double deviation =
      std::sqrt(full.remainder.squaredNorm() / static_cast<double>(full.freedom));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(observations->size());
  values.head(observations->train) = full.remainder;
  observations->drop_outliers(values, kFar * deviation);
  observations->set_noise(std::max(deviation, 1e-4));
  observations->noise_is_known = true;
  observations->noise_uncertainty = 1 / std::sqrt(2 * static_cast<double>(full.freedom));
}

void find_groups(Diagnosis* diagnosis) {
  for (std::size_t i = 0; i < diagnosis->choice.findings.size(); ++i) {
    const Hypothesis& chosen = *diagnosis->choice.fit.chosen[i].hypothesis;
    std::vector<Place> group = {{chosen.effect, chosen.joint}};
    for (const Alternative& other : diagnosis->choice.findings[i].alternatives) {
      if (other.delta_bic < kSameEvidence) {
        group.push_back({other.effect, other.joint});
      }
    }
    if (group.size() > 1) {
      diagnosis->indistinguishable.push_back(group);
    }
  }
}

/// Findings that leave most of a mismatch standing are not proof of anything.
void withdraw(const Observations& observations, const std::string& reason, Diagnosis* diagnosis) {
  for (const Chosen& chosen : diagnosis->choice.fit.chosen) {
    diagnosis->nearest.push_back({chosen.hypothesis->effect, chosen.hypothesis->joint});
  }
  diagnosis->choice = {};
  diagnosis->choice.fit = fit(observations, {}, 0);
  diagnosis->indistinguishable.clear();
  diagnosis->verdict = "unexplained";
  diagnosis->reason = reason;
}

/// How much findings work against each other: the power of their shares one by one over that of
/// their sum. Effects that are there add up (about 1); a sum of effects that imitates another one
/// is large parts that cancel.
double cancellation(const Observations& observations, const Fit& fit) {
  if (fit.chosen.size() < 2) {
    return 1;
  }
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd base = observations.stacked(observations.predictions);
  double parts = 0;
  for (const Chosen& chosen : fit.chosen) {
    const Machine alone = machine_with(observations, {chosen});
    parts +=
        (observations.stacked(predict(alone, observations.scenes)) - base).head(n).squaredNorm();
  }
  return parts / std::max((observations.residual - fit.remainder).head(n).squaredNorm(), 1e-9);
}

void judge(const Observations& observations, Diagnosis* diagnosis) {
  diagnosis->cancellation = cancellation(observations, diagnosis->choice.fit);
  const double before = largest_ratio(observations, observations.residual);
  const double after = largest_ratio(observations, diagnosis->choice.fit.remainder);
  const bool is_noise =
      !observations.noise_is_known || after < kNoiseLike + 3 * observations.noise_uncertainty;
  const double excess = std::max(before * before - 1, 1e-9);
  const double explained = 1 - (after * after - 1) / excess;
  if (diagnosis->choice.fit.chosen.empty()) {
    diagnosis->verdict = is_noise ? "no_mismatch" : "unexplained";
    diagnosis->reason = is_noise ? "" : "no known effect accounts for it";
  } else if (diagnosis->choice.fit.chosen.size() > 2 &&
             diagnosis->cancellation > kMostCancellation) {
    withdraw(observations,
             "only a sum of large effects that cancel each other comes near, which imitates what "
             "is not there",
             diagnosis);
  } else if (is_noise) {
    diagnosis->verdict = "explained";
  } else if (explained < kLeastExplained) {
    withdraw(observations,
             fmt::format("known effects account for {:.0f} % of it at most", 100 * explained),
             diagnosis);
  } else {
    diagnosis->verdict = "partly_explained";
    diagnosis->reason = fmt::format("{:.1f} times the noise is left", after);
  }
}

}  // namespace

Diagnosis diagnose(Observations* observations, const std::vector<Hypothesis>& hypotheses,
                   const Settings& settings) {
  Diagnosis diagnosis;
  if (!has_enough(*observations)) {
    withdraw(*observations,
             fmt::format("too little data: {} samples to fit to and {} to check with",
                         observations->train, observations->size() - observations->train),
             &diagnosis);
    return diagnosis;
  }
  Dictionary dictionary(*observations, hypotheses, settings.simulating);
  if (observations->is_static) {
    learn_noise(observations, hypotheses, dictionary);
    dictionary = Dictionary(*observations, hypotheses, settings.simulating);
  }
  diagnosis.clocks = check_clocks(*observations, hypotheses, dictionary);
  diagnosis.location = locate(*observations, observations->residual);
  diagnosis.choice =
      choose(observations, hypotheses, dictionary, settings.false_discovery, settings.choosing);
  find_groups(&diagnosis);
  judge(*observations, &diagnosis);
  if (diagnosis.verdict == "unexplained" || diagnosis.verdict == "partly_explained") {
    diagnosis.left = locate(*observations, diagnosis.choice.fit.remainder);
  }
  for (std::size_t i = 0; i < diagnosis.choice.findings.size(); ++i) {
    const std::vector<Alternative>& others = diagnosis.choice.findings[i].alternatives;
    if (diagnosis.suggested_experiment.empty() && !others.empty() &&
        others.front().delta_bic < kSameEvidence) {
      diagnosis.suggested_experiment = suggest_experiment(*observations, diagnosis, i);
    }
  }
  return diagnosis;
}

std::string statement(const Observations& observations, const Diagnosis& diagnosis,
                      std::size_t finding) {
  const Finding& found = diagnosis.choice.findings[finding];
  const Fit& fit = diagnosis.choice.fit;
  const Estimate first = estimates(observations, fit, finding).front();
  std::string clause = fit.chosen[finding].hypothesis->statement;
  clause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(clause.front())));
  const Channel channel = main_channel(observations, found.without, fit);
  const auto written = [&](const Eigen::VectorXd& values, bool held_out) {
    return readable(observations.rms(values, channel, held_out),
                    simulation::kChannelUnits[channel]);
  };
  return fmt::format(
      "{} ({} {}), which the model lacks: held-out error of {} falls from {} to {}, noise {}.",
      clause, first.name, readable(first.value, first.unit), simulation::kChannels[channel],
      written(found.without.remainder, true), written(fit.remainder, true),
      written(Eigen::VectorXd::Ones(observations.size()), false));
}

std::string headline(const Observations& observations, const Diagnosis& diagnosis) {
  if (!diagnosis.choice.findings.empty()) {
    return statement(observations, diagnosis, 0);
  }
  return diagnosis.verdict == "no_mismatch"
             ? "Model and recording agree within the noise."
             : "Model and recording differ: " + diagnosis.reason + ".";
}

}  // namespace flexcomp::diagnosis
