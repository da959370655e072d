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
  Eigen::VectorXd amplitude;  ///< of the entries' columns, one after the other
  double evidence = 0;        ///< as `bic_gain` counts it
};

/// An amplitude's part that belongs to each entry.
std::vector<Eigen::VectorXd> parts_of(const Entries& entries, const Eigen::VectorXd& amplitude) {
  std::vector<Eigen::VectorXd> parts;
  Eigen::Index first = 0;
  for (const Entry* entry : entries) {
    parts.emplace_back(amplitude.segment(first, entry->count));
    first += entry->count;
  }
  return parts;
}

/// What a fit leaves, and what it leaves of columns: in the samples to fit to, by their weights.
class Beside {
 public:
  Beside(const Observations& observations, const Fit& fit, const Dictionary& dictionary)
      : observations_(observations), fit_(fit), dictionary_(dictionary) {
    const Eigen::Index n = observations.train;
    root_ = huber_weights(fit.remainder.head(n)).cwiseSqrt();
    left_ = root_.cwiseProduct(fit.remainder.head(n));
    fitted_ = linear_algebra::orthonormal_basis(root_.asDiagonal() * fit.derivative.topRows(n));
  }

  /// Entries, to first order; no evidence where a number would leave its bounds. Beside fitted
  /// numbers that may change, or as they stand: those that a body's edges hold cannot give way.
  Latecomer join(const Entries& entries) const {
    const Eigen::MatrixXd columns = columns_of(entries);
    Latecomer free = weighed(entries, columns - fitted_ * (fitted_.transpose() * columns).eval());
    Latecomer held = weighed(entries, columns);
    return held.evidence > free.evidence ? held : free;
  }

 private:
  Latecomer weighed(const Entries& entries, const Eigen::MatrixXd& columns) const {
    Eigen::VectorXd amplitude = columns.colPivHouseholderQr().solve(left_);
    const Eigen::VectorXd left = left_ - columns * amplitude;
    const double sum = fit_.train_sum - (left_.squaredNorm() - left.squaredNorm());
    const double evidence = can_be(entries, amplitude)
                                ? bic_gain(independent_samples(observations_, left), fit_.train_sum,
                                           sum, static_cast<std::size_t>(columns.cols()))
                                : 0;
    return {entries, std::move(amplitude), evidence};
  }

  Eigen::MatrixXd columns_of(const Entries& entries) const {
    Eigen::Index count = 0;
    for (const Entry* entry : entries) {
      count += entry->count;
    }
    Eigen::MatrixXd columns(left_.size(), count);
    Eigen::Index first = 0;
    for (const Entry* entry : entries) {
      columns.middleCols(first, entry->count) =
          root_.asDiagonal() *
          dictionary_.columns.middleCols(entry->first, entry->count).topRows(left_.size());
      first += entry->count;
    }
    return columns;
  }

  bool can_be(const Entries& entries, const Eigen::VectorXd& amplitude) const {
    const std::vector<Eigen::VectorXd> parts = parts_of(entries, amplitude);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!within_bounds(dictionary_.hypotheses[entries[i]->hypothesis], parts[i])) {
        return false;
      }
    }
    return true;
  }

  const Observations& observations_;
  const Fit& fit_;
  const Dictionary& dictionary_;
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

Chosen chosen_of(const Dictionary& dictionary, const Entry& entry,
                 const Eigen::VectorXd& amplitude) {
  const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
  return {hypothesis, values_of(hypothesis, entry, amplitude)};
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
    if (!hypothesis.traits().joins_family || is_chosen(fit.chosen, hypothesis)) {
      continue;
    }
    for (const Entries& each : companies(entry, left_out_friction(fit, dictionary, hypothesis))) {
      consider(beside.join(each));
    }
  }
  std::vector<Chosen> all;
  for (const auto& [index, late] : best) {
    const std::vector<Eigen::VectorXd> amplitudes = parts_of(late.entries, late.amplitude);
    for (std::size_t i = 0; i < late.entries.size(); ++i) {
      Chosen next = chosen_of(dictionary, *late.entries[i], amplitudes[i]);
      if (!is_chosen(all, next.hypothesis)) {
        all.push_back(std::move(next));
      }
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
