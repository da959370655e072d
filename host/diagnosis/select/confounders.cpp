#include "diagnosis/select/confounders.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/families/candidates.hpp"
#include "diagnosis/families/elimination.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Of what all findings change. What changes more would rather be found itself.
constexpr double kLargestPart = 0.25;
constexpr double kNoticeable = 3;      // times a variance: the interval becomes twice as wide
constexpr std::size_t kMostNamed = 3;  // a person reads no more

/// Derivatives of the samples by the findings' numbers, about the model where the dictionary has
/// them: as what else there is has them. Of two that do the same, one about the model and one about
/// the fit would differ by as much as the fit is bent.
Eigen::MatrixXd derivative_of(const Dictionary& dictionary, const Fit& fit) {
  Eigen::MatrixXd derivative = fit.derivative;
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    const Entry* entry = dictionary.find(fit.chosen[i].hypothesis);
    if (entry != nullptr &&
        entry->count == static_cast<Eigen::Index>(fit.chosen[i].values.size())) {
      derivative.middleCols(fit.first_parameter(i), entry->count) =
          dictionary.columns.middleCols(entry->first, entry->count).topRows(derivative.rows());
    }
  }
  return derivative;
}

/// The tangent of the findings' fit: how its numbers shift by what else changes the samples.
class FindingsTangent {
 public:
  FindingsTangent(const Observations& observations, const Dictionary& dictionary, const Fit& fit)
      : root_(huber_weights(fit.remainder.head(observations.train)).cwiseSqrt()),
        derivative_(weighted(derivative_of(dictionary, fit))),
        factors_(derivative_),
        remainder_(weighted(fit.remainder)),
        variance_(std::pow(deviation_of(observations, fit.remainder), 2)),
        least_gain_(std::log(independent_samples(observations, fit.remainder))) {}

  /// Root of the sum of squares of a change of the samples.
  double size_of(const Eigen::VectorXd& change) const { return weighted(change).norm(); }

  /// Squares of the shifts of the findings' numbers by one number more, which changes the samples
  /// by `column` and is usually off by `width`. Zero where it would show, and does not.
  Eigen::VectorXd squares_by(const Eigen::VectorXd& column, double width) const {
    const Eigen::VectorXd own = weighted(column);
    const Eigen::VectorXd shift = factors_.solve(own);
    const Eigen::VectorXd beside = own - derivative_ * shift;  // what the findings cannot do
    const double precision = beside.squaredNorm() / variance_;
    const double variance = 1 / (1 / (width * width) + precision);
    const double value = variance * beside.dot(remainder_) / variance_;
    const bool would_show = width * width * precision > kStrongEvidence + least_gain_;
    const bool shows = value * value / variance > least_gain_;
    return ((would_show ? 0 : variance) + (shows || !would_show ? value * value : 0)) *
           shift.cwiseAbs2();
  }

 private:
  Eigen::MatrixXd weighted(const Eigen::MatrixXd& samples) const {
    return root_.asDiagonal() * samples.topRows(root_.size());
  }

  Eigen::VectorXd root_;  ///< of the samples' weights
  Eigen::MatrixXd derivative_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors_;
  Eigen::VectorXd remainder_;
  double variance_;    ///< of a sample
  double least_gain_;  ///< in the sum of squares over the variance: what a number costs in BIC
};

/// A confounder with what it does to the findings' numbers.
struct Doubt {
  Place of;
  Eigen::VectorXd squares;
};

std::vector<Doubt> doubts(const Inquiry& inquiry, const Fit& fit) {
  const Observations& observations = inquiry.observations;
  const Dictionary& dictionary = inquiry.dictionary;
  const FindingsTangent tangent(observations, dictionary, fit);
  const double largest = kLargestPart * tangent.size_of(observations.residual - fit.remainder);
  std::vector<Doubt> all;
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& other = dictionary.hypotheses[entry.hypothesis];
    if (other.linear != other.parameters.size() || is_chosen(fit.chosen, other)) {
      continue;
    }
    for (Eigen::Index i = 0; i < entry.count; ++i) {
      const Eigen::VectorXd column = dictionary.columns.col(entry.first + i);
      const double usual = usual_width(observations, other, static_cast<std::size_t>(i));
      const double width = std::min(usual, largest / tangent.size_of(column));
      all.push_back({{other.effect(), other.joint}, tangent.squares_by(column, width)});
    }
  }
  return all;
}

/// Names the confounder, once, unless enough are named.
void name(const Place& confounder, std::vector<Place>* named) {
  const bool is_named = std::find(named->begin(), named->end(), confounder) != named->end();
  if (!is_named && named->size() < kMostNamed) {
    named->push_back(confounder);
  }
}

}  // namespace

void widen_by_confounders(const Inquiry& inquiry, Choice* choice) {
  if (choice->findings.empty()) {
    return;
  }
  std::vector<Doubt> all = doubts(inquiry, choice->fit);
  for (std::size_t i = 0; i < choice->findings.size(); ++i) {
    Finding& finding = choice->findings[i];
    const Eigen::VectorXd variance = finding.covariance.diagonal();
    const auto own = [&](const Doubt& doubt) {
      return doubt.squares.segment(choice->fit.first_parameter(i), variance.size());
    };
    const auto widening = [&](const Doubt& doubt) {
      return own(doubt).cwiseQuotient(variance.cwiseMax(1e-300)).maxCoeff();
    };
    std::sort(all.begin(), all.end(),
              [&](const Doubt& a, const Doubt& b) { return widening(a) > widening(b); });
    finding.hidden = Eigen::VectorXd::Zero(variance.size());
    for (const Doubt& doubt : all) {
      finding.hidden = finding.hidden.cwiseMax(own(doubt));
      if (widening(doubt) > kNoticeable) {
        name(doubt.of, &finding.confounders);
      }
    }
  }
}

}  // namespace flexcomp::diagnosis
