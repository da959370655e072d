#include "diagnosis/families/latecomers.hpp"

#include <map>

#include "diagnosis/evidence.hpp"
#include "linear_algebra/span.hpp"

namespace flexcomp::diagnosis {
namespace {

struct Latecomer {
  const Entry* entry = nullptr;
  double amplitude = 0;
  double gain = 0;  ///< fall of the weighted squares, to first order
};

}  // namespace

std::vector<Chosen> latecomers(const Observations& observations, const Fit& fit,
                               const Dictionary& dictionary) {
  if (fit.chosen.empty()) {
    return {};
  }
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd root = huber_weights(fit.remainder.head(n)).cwiseSqrt();
  const Eigen::VectorXd left = root.cwiseProduct(fit.remainder.head(n));
  const Eigen::MatrixXd fitted =
      linear_algebra::orthonormal_basis(root.asDiagonal() * fit.derivative.topRows(n));
  std::map<std::size_t, Latecomer> best;  // by hypothesis
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
    if (!hypothesis.traits().joins_family || entry.count != 1 ||
        is_chosen(fit.chosen, hypothesis)) {
      continue;
    }
    Eigen::VectorXd column = root.cwiseProduct(dictionary.columns.col(entry.first).head(n));
    column -= fitted * (fitted.transpose() * column);
    const double square = column.squaredNorm();
    const double amplitude = square > 0 ? column.dot(left) / square : 0;
    const double gain = amplitude * amplitude * square;
    const Eigen::VectorXd amplitudes = Eigen::VectorXd::Constant(1, amplitude);
    Latecomer& known = best[entry.hypothesis];
    if (gain > known.gain && within_bounds(hypothesis, amplitudes)) {
      known = {&entry, amplitude, gain};
    }
  }
  const double samples = independent_samples(observations, fit.remainder);
  std::vector<Chosen> all;
  for (const auto& [index, late] : best) {
    if (late.gain > 0 &&
        bic_gain(samples, fit.train_sum, fit.train_sum - late.gain, 1) > kStrongEvidence) {
      const Hypothesis& hypothesis = dictionary.hypotheses[index];
      all.push_back({hypothesis, values_of(hypothesis, *late.entry,
                                           Eigen::VectorXd::Constant(1, late.amplitude))});
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
