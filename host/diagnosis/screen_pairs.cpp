#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/dictionary.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr std::size_t kMostPromising = 80;  // singles, each paired with all: time

/// Bounded least squares of two entries, from products that are known already.
class PairSolver {
 public:
  PairSolver(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
             const Dictionary& dictionary, const BesideFitted& beside)
      : hypotheses_(hypotheses),
        dictionary_(dictionary),
        beside_(beside),
        samples_(static_cast<double>(observations.train)) {}

  /// The smaller the better; infinite where an amplitude leaves its bounds.
  double criterion(std::size_t a, std::size_t b, ScreenedPair* pair) const {
    const Entry& first = dictionary_.entries[a];
    const Entry& second = dictionary_.entries[b];
    const Eigen::Index m = first.count;
    const Eigen::Index n = m + second.count;
    Eigen::MatrixXd inner(n, n);
    inner.topLeftCorner(m, m) = whole_product(first, first);
    inner.bottomRightCorner(n - m, n - m) = whole_product(second, second);
    inner.topRightCorner(m, n - m) = whole_product(first, second);
    inner.bottomLeftCorner(n - m, m) = inner.topRightCorner(m, n - m).transpose();
    const Eigen::VectorXd scale = inner.diagonal().cwiseSqrt();
    Eigen::MatrixXd common(beside_.shared.rows(), n);
    common << beside_.shared.middleCols(first.first, m),
        beside_.shared.middleCols(second.first, n - m);
    inner -= common.transpose() * common;
    Eigen::VectorXd moment(n);
    moment << beside_.product.segment(first.first, m), beside_.product.segment(second.first, n - m);
    const Hypothesis& one = hypotheses_[first.hypothesis];
    const Hypothesis& other = hypotheses_[second.hypothesis];
    const LeastSquares solved = solve_within_bounds({&one, &other}, inner, moment, scale);
    const Eigen::VectorXd& amplitude = solved.amplitude;
    pair->sum = std::max(beside_.sum - solved.gain, 1e-9);
    pair->first = {a, pair->sum, amplitude.head(m)};
    pair->second = {b, pair->sum, amplitude.tail(n - m)};
    if (!amplitude.allFinite() || !within_bounds(one, amplitude.head(m)) ||
        !within_bounds(other, amplitude.tail(n - m))) {
      return std::numeric_limits<double>::infinity();
    }
    return samples_ * std::log(pair->sum) +
           static_cast<double>(one.parameters.size() + other.parameters.size()) *
               std::log(samples_);
  }

 private:
  Eigen::MatrixXd whole_product(const Entry& one, const Entry& other) const {
    return dictionary_.gram.block(one.first, other.first, one.count, other.count);
  }

  const std::vector<Hypothesis>& hypotheses_;
  const Dictionary& dictionary_;
  const BesideFitted& beside_;
  double samples_;
};

}  // namespace

std::vector<ScreenedPair> screen_pairs(const Observations& observations,
                                       const std::vector<Hypothesis>& hypotheses,
                                       const Dictionary& dictionary, const BesideFitted& beside,
                                       std::size_t most) {
  std::vector<Screened> singles = screen(hypotheses, dictionary, beside);
  std::sort(singles.begin(), singles.end(),
            [](const Screened& a, const Screened& b) { return a.sum < b.sum; });
  singles.resize(std::min(singles.size(), kMostPromising));
  const PairSolver solver(observations, hypotheses, dictionary, beside);
  std::vector<std::pair<double, ScreenedPair>> found;
  for (const Screened& single : singles) {
    const std::size_t own = dictionary.entries[single.entry].hypothesis;
    std::pair<double, ScreenedPair> best{std::numeric_limits<double>::infinity(), {}};
    for (std::size_t other = 0; other < dictionary.entries.size(); ++other) {
      const Hypothesis& second = hypotheses[dictionary.entries[other].hypothesis];
      if (are_the_same(hypotheses[own], second)) {
        continue;
      }
      ScreenedPair pair;
      const double criterion = solver.criterion(single.entry, other, &pair);
      if (criterion < best.first) {
        best = {criterion, pair};
      }
    }
    if (std::isfinite(best.first)) {
      found.push_back(best);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ScreenedPair> pairs;
  for (const std::pair<double, ScreenedPair>& ranked : found) {
    const ScreenedPair& pair = ranked.second;
    const auto place = [&](const Screened& screened) {
      return dictionary.entries[screened.entry].hypothesis;
    };
    const bool is_new = std::none_of(pairs.begin(), pairs.end(), [&](const ScreenedPair& other) {
      return (place(other.first) == place(pair.first) &&
              place(other.second) == place(pair.second)) ||
             (place(other.first) == place(pair.second) && place(other.second) == place(pair.first));
    });
    if (is_new && pairs.size() < most) {
      pairs.push_back(pair);
    }
  }
  return pairs;
}

}  // namespace flexcomp::diagnosis
