#include "diagnosis/retune.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kKnown = 2;  // deviations from what the model has
constexpr int kSteps = 8;

bool is_number_of_model(const Hypothesis& hypothesis) {
  constexpr const char* kEffects[] = {"joint_stiffness", "viscous_friction", "coulomb_friction"};
  return hypothesis.form.empty() && std::find(std::begin(kEffects), std::end(kEffects),
                                              hypothesis.effect) != std::end(kEffects);
}

std::vector<Chosen> unchanged_numbers(const std::vector<Hypothesis>& hypotheses,
                                      const Dictionary& dictionary) {
  std::vector<Chosen> all;
  for (const Hypothesis& each : hypotheses) {
    if (is_number_of_model(each) && dictionary.find(each) != nullptr) {
      all.push_back({&each, Values(each.parameters.size(), 0.0)});
    }
  }
  return all;
}

/// The one whose surest parameter is the least deviations from zero, and by how many.
std::pair<std::size_t, double> least_known(const Fit& fit) {
  std::pair<std::size_t, double> least = {0, std::numeric_limits<double>::infinity()};
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    double most = 0;
    for (const double value : fit.chosen[i].values) {
      const double deviation = std::sqrt(fit.covariance(at, at));
      most = std::max(most, deviation > 0 ? std::abs(value) / deviation : 0);
      ++at;
    }
    least = most < least.second ? std::make_pair(i, most) : least;
  }
  return least;
}

/// Does the held-out error fall noticeably in a channel, and rise in none?
bool predicts_better(const Observations& observations, const Fit& before, const Fit& after) {
  constexpr double kNoticeable = 0.99;
  double best = 1;
  double worst = 0;
  for (std::size_t i = 0; i < simulation::kChannels.size(); ++i) {
    const auto channel = static_cast<Channel>(i);
    if (observations.has(channel)) {
      const double ratio = observations.rms(after.remainder, channel, true) /
                           observations.rms(before.remainder, channel, true);
      best = std::min(best, ratio);
      worst = std::max(worst, ratio);
    }
  }
  return best < kNoticeable && worst <= 1;
}

}  // namespace

Fit retune(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
           const Dictionary& dictionary) {
  const Fit nothing = fit(observations, {}, 0);
  Fit tuned = fit(observations, unchanged_numbers(hypotheses, dictionary), kSteps, &dictionary);
  while (!tuned.chosen.empty()) {
    const auto [weakest, deviations] = least_known(tuned);
    if (deviations >= kKnown) {
      break;
    }
    std::vector<Chosen> others = tuned.chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(weakest));
    tuned = fit(observations, std::move(others), kSteps, &dictionary);
  }
  const bool stands = !tuned.chosen.empty() &&
                      bic_gain(observations, nothing, tuned) > kStrongEvidence &&
                      predicts_better(observations, nothing, tuned) &&
                      cancellation(observations, tuned) < kMostCancellation;
  return stands ? tuned : nothing;
}

}  // namespace flexcomp::diagnosis
