#include "diagnosis/dictionary.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "linear_algebra/gram.hpp"
#include "linear_algebra/span.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

/// A guess of the whole effect may be off by so much and still be its own.
constexpr double kLeastWhole = 0.4;
constexpr double kMostWhole = 2.5;

Eigen::Index columns_of(const Hypothesis& hypothesis) {
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(hypothesis.linear));
}

/// Index of the linear parameter that is the farthest out of its bounds, in steps of it, among
/// those of hypotheses whose columns follow each other; −1 where none is.
Eigen::Index most_out_of_bounds(const std::vector<const Hypothesis*>& hypotheses,
                                const Eigen::VectorXd& amplitude) {
  constexpr double kTolerance = 2;  // noise may take a parameter that is nothing so far below zero
  Eigen::Index most = -1;
  double distance = 0;
  Eigen::Index first = 0;
  for (const Hypothesis* hypothesis : hypotheses) {
    for (std::size_t i = 0; i < hypothesis->linear; ++i) {
      const Parameter& parameter = hypothesis->parameters[i];
      const Eigen::Index at = first + static_cast<Eigen::Index>(i);
      const double out =
          std::max(parameter.lower - amplitude[at], amplitude[at] - parameter.upper) /
          parameter.step;
      if (out > std::max(distance, hypothesis->linear > 1 ? kTolerance : 0.0)) {
        distance = out;
        most = at;
      }
    }
    first += columns_of(*hypothesis);
  }
  return most;
}

/// Least squares by normal equations, in columns over their `length`, slightly damped so that a
/// column that is a mixture of others gets next to nothing.
LeastSquares solve_scaled(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                          const Eigen::VectorXd& length) {
  constexpr double kDamping = 1e-10;  // of a column's square
  const Eigen::VectorXd scale = length.cwiseMax(1e-300);
  Eigen::MatrixXd inner =
      scale.cwiseInverse().asDiagonal() * gram * scale.cwiseInverse().asDiagonal();
  inner.diagonal().array() += kDamping;
  const Eigen::VectorXd scaled = moment.cwiseQuotient(scale);
  const Eigen::VectorXd solved = inner.ldlt().solve(scaled);
  return {solved.cwiseQuotient(scale), 2 * scaled.dot(solved) - solved.dot(inner * solved)};
}

}  // namespace

Changes::Changes(const Observations& observations)
    : observations_(observations),
      machine_(observations.machine),
      rigid_(observations.rigid),
      predicted_(observations.stacked(observations.predictions)) {}

Changes::Changes(const Observations& observations, const Machine& around)
    : observations_(observations),
      machine_(around),
      rigid_(simulation::rigid_torques(around, observations.scenes)),
      simulations_(simulate(machine_, observations.scenes, rigid_, simulation::Levers::all)),
      predicted_(
          observations.stacked(with_terms(machine_.terms, observations.scenes, simulations_))) {}

Eigen::VectorXd Changes::by(const Hypothesis& hypothesis, const Values& values) const {
  Machine machine = machine_;
  if (hypothesis.is_sketched) {
    machine.terms.push_back(hypothesis.law->sketch(values, hypothesis.joint));
  } else {
    hypothesis.apply(values, &machine);
  }
  const bool simulates_anew = hypothesis.traits().alters_model && !hypothesis.is_sketched;
  return observations_.stacked(
             simulates_anew ? predict(machine, observations_.scenes, rigid_, simulations())
                            : with_terms(machine.terms, observations_.scenes, simulations())) -
         predicted_;
}

Eigen::MatrixXd Changes::columns(const Hypothesis& hypothesis, const Values& start) const {
  const std::size_t linear = hypothesis.linear;
  if (linear == 0) {
    return by(hypothesis, start);
  }
  Eigen::MatrixXd columns(observations_.size(), static_cast<Eigen::Index>(linear));
  Values values(linear, 0.0);
  values.insert(values.end(), start.begin(), start.end());
  // The first parameter stays while the others are tried: a first moment needs its mass.
  values[0] = hypothesis.parameters[0].step;
  const Eigen::VectorXd first = by(hypothesis, values);
  columns.col(0) = first / values[0];
  for (std::size_t k = 1; k < linear; ++k) {
    values[k] = hypothesis.parameters[k].step;
    columns.col(static_cast<Eigen::Index>(k)) = (by(hypothesis, values) - first) / values[k];
    values[k] = 0;
  }
  return columns;
}

namespace {

/// Empty where a machine with it would have no rest: springs that are soft already get no softer.
Eigen::MatrixXd columns_or_none(const Changes& changes, const Hypothesis& hypothesis,
                                const Values& start) {
  try {
    return changes.columns(hypothesis, start);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

Dictionary::Dictionary(const Observations& observations, std::vector<Hypothesis> all,
                       const std::function<void(std::size_t, std::size_t)>& progress)
    : Dictionary(observations, std::move(all), Changes(observations), progress) {}

Dictionary::Dictionary(const Observations& observations, std::vector<Hypothesis> all,
                       const Machine& around,
                       const std::function<void(std::size_t, std::size_t)>& progress)
    : Dictionary(observations, std::move(all), Changes(observations, around), progress) {}

Dictionary::Dictionary(const Observations& observations, std::vector<Hypothesis> all,
                       const Changes& changes,
                       const std::function<void(std::size_t, std::size_t)>& progress)
    : hypotheses(std::move(all)) {
  std::vector<std::vector<Eigen::MatrixXd>> blocks(hypotheses.size());
  in_parallel(hypotheses.size(), progress, [&](std::size_t i) {
    for (const Values& start : hypotheses[i].starts) {
      blocks[i].push_back(columns_or_none(changes, hypotheses[i], start));
    }
  });
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < blocks[i].size(); ++k) {
      const bool shows = blocks[i][k].rows() > 0 && blocks[i][k].allFinite() &&
                         blocks[i][k].topRows(observations.train).norm() > 0;
      if (shows) {
        entries.push_back({i, hypotheses[i].starts[k], count, blocks[i][k].cols()});
        count += blocks[i][k].cols();
      } else {
        blocks[i][k].resize(0, 0);
      }
    }
  }
  columns.resize(observations.size(), count);
  Eigen::Index at = 0;
  for (std::vector<Eigen::MatrixXd>& hypothesis : blocks) {
    for (Eigen::MatrixXd& block : hypothesis) {
      if (block.cols() > 0) {
        columns.middleCols(at, block.cols()) = block;
        at += block.cols();
        block.resize(0, 0);
      }
    }
  }
  gram = linear_algebra::gram_of(columns.topRows(observations.train));
}

Dictionary Dictionary::with(const Dictionary& others, const Observations& observations) const {
  const Eigen::Index own = columns.cols();
  const Eigen::Index count = own + others.columns.cols();
  Dictionary both = *this;
  both.columns.conservativeResize(Eigen::NoChange, count);
  both.columns.rightCols(others.columns.cols()) = others.columns;
  both.gram.conservativeResize(count, count);
  both.gram.topRightCorner(own, others.gram.cols()) =
      columns.topRows(observations.train).transpose() * others.columns.topRows(observations.train);
  both.gram.bottomLeftCorner(others.gram.cols(), own) =
      both.gram.topRightCorner(own, others.gram.cols()).transpose();
  both.gram.bottomRightCorner(others.gram.rows(), others.gram.cols()) = others.gram;
  for (Entry entry : others.entries) {
    entry.hypothesis += hypotheses.size();
    entry.first += own;
    both.entries.push_back(std::move(entry));
  }
  both.hypotheses.insert(both.hypotheses.end(), others.hypotheses.begin(), others.hypotheses.end());
  return both;
}

Dictionary Dictionary::by_turns(const std::vector<std::size_t>& of,
                                const std::shared_ptr<const Spells>& when,
                                const Observations& observations) const {
  const Eigen::VectorXd acts = when->by_sample(observations, observations.size());
  Dictionary some;
  Eigen::Index count = 0;
  for (const std::size_t at : of) {
    Hypothesis hypothesis = hypotheses[entries[at].hypothesis];
    hypothesis.when = when;
    hypothesis.starts = {entries[at].start};
    hypothesis.seek = nullptr;
    some.hypotheses.push_back(std::move(hypothesis));
    some.entries.push_back(
        {some.hypotheses.size() - 1, entries[at].start, count, entries[at].count});
    count += entries[at].count;
  }
  some.columns.resize(observations.size(), count);
  for (std::size_t i = 0; i < of.size(); ++i) {
    some.columns.middleCols(some.entries[i].first, some.entries[i].count) =
        acts.asDiagonal() * columns.middleCols(entries[of[i]].first, entries[of[i]].count);
  }
  some.gram = linear_algebra::gram_of(some.columns.topRows(observations.train));
  return some;
}

const Entry* Dictionary::find(const Hypothesis& hypothesis) const {
  for (const Entry& entry : entries) {
    const Hypothesis& own = hypotheses[entry.hypothesis];
    if (own.law == hypothesis.law && own.joint == hypothesis.joint) {
      return &entry;
    }
  }
  return nullptr;
}

LeastSquares solve_within_bounds(const std::vector<const Hypothesis*>& hypotheses,
                                 const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                                 const Eigen::VectorXd& length) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < moment.size(); ++i) {
    free.push_back(i);
  }
  while (!free.empty()) {
    const LeastSquares solved = solve_scaled(gram(free, free), moment(free), length(free));
    Eigen::VectorXd amplitude = Eigen::VectorXd::Zero(moment.size());
    amplitude(free) = solved.amplitude;
    const Eigen::Index out = most_out_of_bounds(hypotheses, amplitude);
    if (out < 0 || !amplitude.allFinite()) {
      return {amplitude, solved.gain};
    }
    free.erase(std::remove(free.begin(), free.end(), out), free.end());
  }
  return {Eigen::VectorXd::Zero(moment.size()), 0};
}

BesideFitted::BesideFitted(const Observations& observations, const Dictionary& dictionary,
                           const Eigen::VectorXd& remainder, const Eigen::MatrixXd& fitted) {
  const Eigen::Index n = observations.train;
  Eigen::VectorXd left = remainder.head(n);
  const auto columns = dictionary.columns.topRows(n);
  const Eigen::MatrixXd orthonormal = linear_algebra::orthonormal_basis(fitted.topRows(n));
  left -= orthonormal * (orthonormal.transpose() * left);
  shared = orthonormal.transpose() * columns;
  product = columns.transpose() * left;
  sum = left.squaredNorm();
}

std::vector<Screened> screen(const std::vector<Hypothesis>& hypotheses,
                             const Dictionary& dictionary, const BesideFitted& beside) {
  std::vector<Screened> all;
  for (std::size_t i = 0; i < dictionary.entries.size(); ++i) {
    const Entry& entry = dictionary.entries[i];
    const auto common = beside.shared.middleCols(entry.first, entry.count);
    const Eigen::MatrixXd own =
        dictionary.gram.block(entry.first, entry.first, entry.count, entry.count);
    const LeastSquares solved = solve_within_bounds(
        {&hypotheses[entry.hypothesis]}, own - common.transpose() * common,
        beside.product.segment(entry.first, entry.count), own.diagonal().cwiseSqrt());
    if (solved.gain > 0 && solved.amplitude.allFinite() &&
        within_bounds(hypotheses[entry.hypothesis], solved.amplitude)) {
      all.push_back({i, std::max(beside.sum - solved.gain, 0.0), solved.amplitude});
    }
  }
  return all;
}

FullestFit fit_all(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                   const Dictionary& dictionary, const Eigen::VectorXd& unexplained) {
  std::vector<Eigen::Index> linear;
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = hypotheses[entry.hypothesis];
    for (Eigen::Index i = 0; i < entry.count && hypothesis.starts.front().empty(); ++i) {
      linear.push_back(entry.first + i);
    }
  }
  Eigen::MatrixXd columns(observations.train, static_cast<Eigen::Index>(linear.size()) + 3);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) =
        dictionary.columns.col(linear[i]).head(observations.train).normalized();
  }
  for (Eigen::Index c = 0; c < 3; ++c) {  // and a constant of each component
    for (Eigen::Index i = 0; i < observations.train; ++i) {
      const Sample& at = observations.samples[static_cast<std::size_t>(i)];
      columns(i, columns.cols() - 3 + c) = at.component == c ? 1 : 0;
    }
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-7);
  FullestFit fit;
  const Eigen::VectorXd target = unexplained.head(observations.train);
  fit.remainder = target - columns * qr.solve(target);
  fit.freedom = observations.train - qr.rank();
  return fit;
}

bool within_bounds(const Hypothesis& hypothesis, const Eigen::VectorXd& amplitude) {
  if (hypothesis.linear == 0) {
    return amplitude[0] > kLeastWhole && amplitude[0] < kMostWhole;
  }
  return most_out_of_bounds({&hypothesis}, amplitude) < 0;
}

Values values_of(const Hypothesis& hypothesis, const Entry& entry,
                 const Eigen::VectorXd& amplitude) {
  Values values;
  if (hypothesis.linear > 0) {
    values.assign(amplitude.data(), amplitude.data() + amplitude.size());
  }
  values.insert(values.end(), entry.start.begin(), entry.start.end());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = hypothesis.parameters[i];
    values[i] = std::clamp(values[i], parameter.lower, parameter.upper);
  }
  return values;
}

}  // namespace flexcomp::diagnosis
