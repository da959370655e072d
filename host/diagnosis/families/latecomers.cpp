#include "diagnosis/families/latecomers.hpp"

#include <algorithm>
#include <map>

#include "diagnosis/evidence.hpp"
#include "linear_algebra/span.hpp"

namespace flexcomp::diagnosis {
namespace {

/// An entry of the dictionary, and behind it those that it brings.
using Entries = std::vector<const Entry*>;

struct Latecomer {
  Entries entries;
  Eigen::VectorXd amplitude;
  double evidence = 0;  ///< as `bic_gain` counts it
};

/// What a fit leaves, and what it leaves of columns: in the samples to fit to, by their weights.
class Beside {
 public:
  Beside(const Observations& observations, const Fit& fit, const Dictionary& dictionary)
      : fit_(fit),
        dictionary_(dictionary),
        samples_(independent_samples(observations, fit.remainder)) {
    const Eigen::Index n = observations.train;
    root_ = huber_weights(fit.remainder.head(n)).cwiseSqrt();
    left_ = root_.cwiseProduct(fit.remainder.head(n));
    fitted_ = linear_algebra::orthonormal_basis(root_.asDiagonal() * fit.derivative.topRows(n));
  }

  /// Entries of one column each, to first order; no evidence where a number would leave its bounds.
  Latecomer join(Entries entries) const {
    Eigen::MatrixXd columns(left_.size(), static_cast<Eigen::Index>(entries.size()));
    for (std::size_t i = 0; i < entries.size(); ++i) {
      columns.col(static_cast<Eigen::Index>(i)) =
          root_.cwiseProduct(dictionary_.columns.col(entries[i]->first).head(left_.size()));
    }
    columns -= fitted_ * (fitted_.transpose() * columns).eval();
    const Eigen::VectorXd amplitude = columns.colPivHouseholderQr().solve(left_);
    const double gain = left_.squaredNorm() - (left_ - columns * amplitude).squaredNorm();
    const double evidence =
        can_be(entries, amplitude)
            ? bic_gain(samples_, fit_.train_sum, fit_.train_sum - gain, entries.size())
            : 0;
    return {std::move(entries), amplitude, evidence};
  }

 private:
  bool can_be(const Entries& entries, const Eigen::VectorXd& amplitude) const {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!within_bounds(dictionary_.hypotheses[entries[i]->hypothesis],
                         amplitude.segment(static_cast<Eigen::Index>(i), 1))) {
        return false;
      }
    }
    return true;
  }

  const Fit& fit_;
  const Dictionary& dictionary_;
  double samples_;
  Eigen::VectorXd root_;    ///< of the samples' weights
  Eigen::VectorXd left_;    ///< weighted
  Eigen::MatrixXd fitted_;  ///< orthonormal columns of what is fitted, weighted
};

/// The linear forms of friction that a form's joint has in the dictionary and not in a fit.
Entries left_out_friction(const Fit& fit, const Dictionary& dictionary, const Hypothesis& form) {
  Entries all;
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
    const effects::Traits& traits = hypothesis.traits();
    if (form.traits().is_friction && hypothesis.joint == form.joint && traits.is_friction &&
        traits.is_in_family && entry.count == 1 && !is_chosen(fit.chosen, hypothesis)) {
      all.push_back(&entry);
    }
  }
  return all;
}

/// An entry alone, with each of others, and with all of them.
std::vector<Entries> companies(const Entry& entry, const Entries& others) {
  std::vector<Entries> all = {{&entry}};
  for (const Entry* other : others) {
    all.push_back({&entry, other});
  }
  if (others.size() > 1) {
    all.push_back({&entry});
    all.back().insert(all.back().end(), others.begin(), others.end());
  }
  return all;
}

Chosen chosen_of(const Dictionary& dictionary, const Entry& entry, double amplitude) {
  const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
  return {hypothesis, values_of(hypothesis, entry, Eigen::VectorXd::Constant(1, amplitude))};
}

}  // namespace

std::vector<Chosen> latecomers(const Observations& observations, const Fit& fit,
                               const Dictionary& dictionary) {
  if (fit.chosen.empty()) {
    return {};
  }
  const Beside beside(observations, fit, dictionary);
  std::map<std::size_t, Latecomer> best;  // by hypothesis
  const auto consider = [&](Latecomer late) {
    Latecomer& known = best[late.entries.front()->hypothesis];
    if (late.evidence > std::max(known.evidence, kStrongEvidence)) {
      known = std::move(late);
    }
  };
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
    if (!hypothesis.traits().joins_family || entry.count != 1 ||
        is_chosen(fit.chosen, hypothesis)) {
      continue;
    }
    for (Entries& each : companies(entry, left_out_friction(fit, dictionary, hypothesis))) {
      consider(beside.join(std::move(each)));
    }
  }
  std::vector<Chosen> all;
  for (const auto& [index, late] : best) {
    for (std::size_t i = 0; i < late.entries.size(); ++i) {
      Chosen next =
          chosen_of(dictionary, *late.entries[i], late.amplitude(static_cast<Eigen::Index>(i)));
      if (!is_chosen(all, next.hypothesis)) {
        all.push_back(std::move(next));
      }
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
