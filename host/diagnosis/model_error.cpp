#include "diagnosis/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "diagnosis/families/elimination.hpp"
#include "recording/noise.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Single samples far off do not decide.
double rms_without_outliers(const Eigen::ArrayXd& values) {
  const double limit = kFarOff * recording::robust_deviation(values.matrix());
  return std::sqrt(values.max(-limit).min(limit).square().mean());
}

}  // namespace

Eigen::VectorXd model_error(const Observations& observations, const Eigen::VectorXd& remainder) {
  std::map<std::pair<Channel, Eigen::Index>, std::vector<double>> parts;
  const auto place = [&](Eigen::Index i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    return std::make_pair(at.channel, at.component);
  };
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    parts[place(i)].push_back(remainder[i]);
  }
  std::map<std::pair<Channel, Eigen::Index>, double> left;
  for (const auto& [component, values] : parts) {
    left[component] = rms_without_outliers(
        Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  }
  Eigen::VectorXd factors(observations.size());
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    factors[i] = std::max(1.0, left[place(i)]);
  }
  return factors;
}

Eigen::VectorXd least_model_error(const Inquiry& inquiry,
                                  const std::vector<Hypothesis>& hypotheses) {
  Elimination all(inquiry.observations, inquiry.given, hypotheses, inquiry.dictionary);
  return model_error(inquiry.observations, all.fullest_remainder());
}

Fit over_noise(Fit fit, const Eigen::VectorXd& factors, Eigen::Index train) {
  fit.remainder = fit.remainder.cwiseQuotient(factors);
  fit.derivative = factors.cwiseInverse().asDiagonal() * fit.derivative;
  const auto to_fit = fit.remainder.head(train);
  fit.train_sum = huber_weights(to_fit).dot(to_fit.cwiseAbs2());
  return fit;
}

}  // namespace flexcomp::diagnosis
