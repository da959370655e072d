#include "diagnosis/fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "diagnosis/covariance.hpp"
#include "diagnosis/held_remainder.hpp"
#include "error.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Deviations: of normally distributed samples 0.3 % weigh less than one.
constexpr double kHuber = 3;
/// Such a change moves the BIC of 10,000 samples by 0.001.
constexpr double kSettledChange = 1e-7;

/// The weighted remainder of the samples to fit to, simulated anew for every step.
class WeightedRemainder : public HeldRemainder {
 public:
  /// `measured` over the noise, and `weight`: of the samples to fit to.
  WeightedRemainder(const Eigen::VectorXd& measured, const Eigen::VectorXd& weight,
                    Evaluator* evaluator)
      : HeldRemainder(evaluator), measured_(measured), root_(weight.cwiseSqrt()) {}

 protected:
  std::optional<Eigen::VectorXd> left(const Values& values, Eigen::MatrixXd* slope) const override {
    const Eigen::Index n = measured_.size();
    Eigen::VectorXd predicted;
    try {
      predicted = evaluator_->evaluate_to_fit(values, slope);
    } catch (const InputError&) {
      return std::nullopt;  // springs so soft that there is no rest
    }
    if (!predicted.allFinite()) {
      return std::nullopt;  // a formula has no value there
    }
    if (slope != nullptr) {
      slope->topRows(n).array().colwise() *= -root_.array();
    }
    return root_.cwiseProduct(measured_ - predicted.head(n));
  }

 private:
  const Eigen::VectorXd& measured_;
  Eigen::VectorXd root_;  ///< of the weights
};

void solve(const Eigen::VectorXd& measured, const Eigen::VectorXd& weight, int most_steps,
           Evaluator* evaluator) {
  WeightedRemainder cost(measured, weight, evaluator);
  minimise(&cost, {most_steps, kSettledChange}, evaluator);
}

/// The prediction at the start, which is moved to where the machine comes to rest. An amplitude
/// that was taken in proportion may ask for springs too soft for that: all of them are halved then,
/// as often as needed. With none of them the machine is the model, which has a rest.
Eigen::VectorXd predicted_at_rest(Evaluator* evaluator) {
  constexpr int kHalvings = 20;  // to a millionth
  for (int i = 0; i < kHalvings; ++i) {
    try {
      return evaluator->evaluate_to_fit(evaluator->values(), nullptr);
    } catch (const InputError&) {
      evaluator->halve_amplitudes();
    }
  }
  return evaluator->evaluate_to_fit(evaluator->values(), nullptr);
}

/// Parameters that act in steps, like the drag that holds a flank, have no derivative: values
/// around are tried instead, and the middle of the best ones is taken. True if any was changed.
bool scan_steps(const Eigen::VectorXd& measured, Evaluator* evaluator) {
  constexpr int kReach = 20;        // steps either way: from 0.38 to 2.7 times the value
  constexpr double kFactor = 1.05;  // of a step: such a parameter is told to some per cent at best
  constexpr double kSame = 1e-9;    // of the sum of squares: rounding
  const Eigen::Index n = measured.size();
  Eigen::MatrixXd derivative;
  evaluator->evaluate_to_fit(evaluator->values(), &derivative);
  bool changed = false;
  for (std::size_t i = 0; i < evaluator->size(); ++i) {
    if (derivative.col(static_cast<Eigen::Index>(i)).head(n).norm() > 0) {
      continue;
    }
    const Values here = evaluator->values();
    if (here[i] == 0) {
      continue;
    }
    const Parameter& bounds = evaluator->parameter(i);
    double least = std::numeric_limits<double>::infinity();
    std::vector<double> best;
    for (int k = -kReach; k <= kReach; ++k) {
      Values tried = here;
      tried[i] = here[i] * std::pow(kFactor, k);
      if (tried[i] < bounds.lower || tried[i] > bounds.upper) {
        continue;
      }
      const Eigen::VectorXd left = measured - evaluator->evaluate_to_fit(tried, nullptr).head(n);
      const double sum = huber_weights(left).dot(left.cwiseAbs2());
      if (sum < least * (1 - kSame)) {
        least = sum;
        best.clear();
      }
      if (sum <= least * (1 + kSame)) {
        best.push_back(tried[i]);
      }
    }
    Values moved = here;
    moved[i] = best.empty() ? here[i] : best[best.size() / 2];
    changed = changed || moved[i] != here[i];
    evaluator->set(moved);
  }
  return changed;
}

/// Moves the values to those of the least weighted remainder in the samples to fit to.
void move_to_least(const Eigen::VectorXd& to_fit, int most_steps, bool scans,
                   Evaluator* evaluator) {
  const Eigen::VectorXd first = predicted_at_rest(evaluator);
  const Eigen::VectorXd weight = huber_weights(to_fit - first.head(to_fit.size()));
  solve(to_fit, weight, most_steps, evaluator);
  if (scans && scan_steps(to_fit, evaluator)) {
    solve(to_fit, weight, most_steps, evaluator);
  }
}

/// The prediction of all samples at the values; none where there is no rest, or a formula has no
/// value, in what was held out.
std::optional<Eigen::VectorXd> predicted_everywhere(Evaluator* evaluator,
                                                    Eigen::MatrixXd* derivative) {
  try {
    Eigen::VectorXd predicted = evaluator->evaluate(evaluator->values(), derivative);
    return predicted.allFinite() ? std::make_optional(std::move(predicted)) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Fits, and predicts all samples. Scenes that are held out whole are simulated at the end only,
/// or all along where the values must be others for their sake.
Eigen::VectorXd fit_and_predict(const Eigen::VectorXd& to_fit, int most_steps, bool scans,
                                Evaluator* evaluator, Eigen::MatrixXd* derivative) {
  const Values begin = evaluator->values();
  if (most_steps > 0) {
    move_to_least(to_fit, most_steps, scans, evaluator);
  } else {
    evaluator->keep_within_bounds();
  }
  if (auto predicted = predicted_everywhere(evaluator, derivative)) {
    return *predicted;
  }
  evaluator->set(begin);
  evaluator->simulate_all();
  move_to_least(to_fit, most_steps, scans, evaluator);
  return evaluator->evaluate(evaluator->values(), derivative);
}

/// Moves the prediction of one scene along columns to where it fits best.
void fit_scene(const Observations& observations, std::size_t scene, const Eigen::VectorXd& measured,
               const Eigen::MatrixXd& columns, Eigen::VectorXd* predicted) {
  std::vector<Eigen::Index> own;
  for (Eigen::Index i = observations.train; i < observations.size(); ++i) {
    if (observations.samples[static_cast<std::size_t>(i)].scene == scene) {
      own.push_back(i);
    }
  }
  const Eigen::MatrixXd change = columns(own, Eigen::all);
  const Eigen::VectorXd left = (measured - *predicted)(own).cwiseMax(-kGross).cwiseMin(kGross);
  (*predicted)(own) += change * change.completeOrthogonalDecomposition().solve(left);
}

/// A recording that is held out began elsewhere: what lags begins there as fits it, and a tone has
/// another phase. Neither says anything of the machine.
void begin_held_out_anew(const Observations& observations, const Evaluator& evaluator,
                         const Eigen::VectorXd& measured, const Eigen::MatrixXd& derivative,
                         Eigen::VectorXd* predicted) {
  std::vector<Eigen::Index> anew;
  for (std::size_t at = 0; at < evaluator.size(); ++at) {
    if (evaluator.parameter(at).is_of_recording || evaluator.parameter(at).is_of_each) {
      anew.push_back(static_cast<Eigen::Index>(at));
    }
  }
  for (std::size_t scene = observations.train_scenes;
       !anew.empty() && scene < observations.scenes.size(); ++scene) {
    fit_scene(observations, scene, measured, derivative(Eigen::all, anew), predicted);
  }
}

std::vector<effects::Placed> placed_of(const std::vector<Chosen>& chosen) {
  std::vector<effects::Placed> placed;
  placed.reserve(chosen.size());
  for (const Chosen& each : chosen) {
    placed.push_back({each.hypothesis.law, each.hypothesis.joint, each.values});
  }
  return placed;
}

}  // namespace

bool is_chosen(const std::vector<Chosen>& chosen, const Hypothesis& hypothesis) {
  return std::any_of(chosen.begin(), chosen.end(),
                     [&](const Chosen& each) { return are_the_same(each.hypothesis, hypothesis); });
}

Eigen::VectorXd huber_weights(const Eigen::VectorXd& remainder, double deviation) {
  return (kHuber * deviation / remainder.array().abs().max(1e-12)).min(1.0).matrix();
}

Eigen::VectorXd huber_weights(const Eigen::VectorXd& remainder) {
  const double spread =
      std::max(1.0, std::sqrt(remainder.squaredNorm() / static_cast<double>(remainder.size())));
  return huber_weights(remainder, spread);
}

Eigen::VectorXd clipped(const Eigen::VectorXd& remainder) {
  const double limit =
      kFarOff * std::max(1.0, remainder.norm() / std::sqrt(static_cast<double>(remainder.size())));
  return remainder.cwiseMax(-limit).cwiseMin(limit);
}

std::size_t Fit::parameters() const {
  return static_cast<std::size_t>(first_parameter(chosen.size()));
}

Eigen::Index Fit::first_parameter(std::size_t index) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < index; ++i) {
    count += chosen[i].values.size();
  }
  return static_cast<Eigen::Index>(count);
}

Eigen::MatrixXd Fit::covariance_of(std::size_t index) const {
  const Eigen::Index first = first_parameter(index);
  const auto count = static_cast<Eigen::Index>(chosen[index].values.size());
  return covariance.block(first, first, count, count);
}

std::vector<effects::Placed> Fit::placed(const Observations& observations) const {
  std::vector<Chosen> to_come = as_left(observations, chosen);
  to_come.erase(
      std::remove_if(to_come.begin(), to_come.end(),
                     [&](const Chosen& each) { return is_of_each(observations, each.hypothesis); }),
      to_come.end());
  return placed_of(to_come);
}

bool is_of_each(const Observations& observations, const Hypothesis& hypothesis) {
  return observations.train_scenes < observations.scenes.size() &&
         std::any_of(hypothesis.parameters.begin(), hypothesis.parameters.end(),
                     [](const Parameter& each) { return each.is_of_each; });
}

std::vector<Chosen> steady(const std::vector<Chosen>& chosen) {
  std::vector<Chosen> all;
  std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(all),
               [](const Chosen& each) { return each.hypothesis.when == nullptr; });
  return all;
}

std::vector<Chosen> acting(std::vector<Chosen> chosen) {
  for (Chosen& each : chosen) {
    each.hypothesis.when = nullptr;
  }
  return chosen;
}

std::vector<Chosen> as_left(const Observations& observations, std::vector<Chosen> chosen) {
  const auto has_ceased = [&](const Chosen& each) {
    const auto& when = each.hypothesis.when;
    return when && !when->lasts(observations);
  };
  chosen.erase(std::remove_if(chosen.begin(), chosen.end(), has_ceased), chosen.end());
  return chosen;
}

Machine machine_with(const Observations& observations, const std::vector<Chosen>& chosen) {
  Machine machine = observations.machine;
  effects::add_effects(placed_of(as_left(observations, chosen)), &machine);
  return machine;
}

Fit fit(const Observations& observations, std::vector<Chosen> start, int most_steps,
        const Dictionary* dictionary) {
  Fit result;
  const Eigen::Index n = observations.train;
  Evaluator evaluator(observations, std::move(start), dictionary);
  const Eigen::VectorXd base = observations.stacked(observations.predictions);
  const Eigen::VectorXd measured = observations.residual + base;
  Eigen::VectorXd predicted = base;
  result.derivative.resize(base.size(), 0);
  if (evaluator.size() > 0) {
    const bool scans = dictionary == nullptr && most_steps > 0;
    predicted =
        fit_and_predict(measured.head(n), most_steps, scans, &evaluator, &result.derivative);
    begin_held_out_anew(observations, evaluator, measured, result.derivative, &predicted);
  }
  result.chosen = evaluator.chosen();
  result.machine = machine_with(observations, result.chosen);
  result.remainder = measured - predicted;
  const Eigen::VectorXd weight = huber_weights(result.remainder.head(n));
  result.train_sum = weight.dot(result.remainder.head(n).cwiseAbs2());
  const double freedom = static_cast<double>(n) - static_cast<double>(evaluator.size());
  if (evaluator.size() > 0) {
    const Eigen::VectorXd precision = evaluator.precisions();
    const NormalInverse inverse = inverse_of(result.derivative.topRows(n), weight, precision);
    result.covariance =
        covariance_of(observations, inverse, result.derivative.topRows(n), weight,
                      result.remainder.head(n), result.train_sum / std::max(freedom, 1.0));
    result.told = told_parameters(inverse, precision);
    const Eigen::VectorXd widening = evaluator.widenings();
    result.covariance = widening.asDiagonal() * result.covariance * widening.asDiagonal();
  }
  return result;
}

double cancellation(const Observations& observations, const Fit& fit) {
  if (fit.chosen.size() < 2) {
    return 1;
  }
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd base = observations.stacked(observations.predictions);
  double parts = 0;
  for (const Chosen& chosen : fit.chosen) {
    Evaluator alone(observations, {chosen}, nullptr);
    try {
      parts += (alone.evaluate_to_fit(alone.values(), nullptr) - base).head(n).squaredNorm();
    } catch (const InputError&) {
      return std::numeric_limits<double>::infinity();  // no rest without the others
    }
  }
  return parts / std::max((observations.residual - fit.remainder).head(n).squaredNorm(), 1e-9);
}

}  // namespace flexcomp::diagnosis
