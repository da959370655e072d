#include "diagnosis/dictionary.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

/// A guess of the whole effect may be off by so much and still be its own.
constexpr double kLeastWhole = 0.4;
constexpr double kMostWhole = 2.5;

class Columns {
 public:
  Columns(const Observations& observations, const Hypothesis& hypothesis)
      : observations_(observations), hypothesis_(hypothesis) {}

  /// Change of the whole prediction over the noise, by the values of the parameters.
  Eigen::VectorXd change(const Values& values) const {
    std::vector<Prediction> predictions;
    if (hypothesis_.alters_model && !hypothesis_.sketch) {
      Machine machine = observations_.machine;
      hypothesis_.apply(values, &machine);
      predictions = predict(machine, observations_.scenes);
    } else {
      Machine machine;
      machine.robot = observations_.machine.robot;
      if (hypothesis_.sketch) {
        machine.terms.push_back(hypothesis_.sketch(values));
      } else {
        hypothesis_.apply(values, &machine);
      }
      for (std::size_t s = 0; s < observations_.scenes.size(); ++s) {
        predictions.push_back(
            with_terms(machine.terms, observations_.scenes[s], observations_.simulations[s]));
      }
      return observations_.stacked(predictions) - bare();
    }
    return observations_.stacked(predictions) - observations_.stacked(observations_.predictions);
  }

  /// samples × count, for one start.
  Eigen::MatrixXd at(const Values& start) const {
    const std::size_t linear = hypothesis_.linear;
    if (linear == 0) {
      return change(start);
    }
    Eigen::MatrixXd columns(observations_.size(), static_cast<Eigen::Index>(linear));
    Values values(linear, 0.0);
    values.insert(values.end(), start.begin(), start.end());
    // The first parameter stays while the others are tried: a first moment needs its mass.
    values[0] = hypothesis_.parameters[0].step;
    const Eigen::VectorXd first = change(values);
    columns.col(0) = first / values[0];
    for (std::size_t k = 1; k < linear; ++k) {
      values[k] = hypothesis_.parameters[k].step;
      columns.col(static_cast<Eigen::Index>(k)) = (change(values) - first) / values[k];
      values[k] = 0;
    }
    return columns;
  }

 private:
  Eigen::VectorXd bare() const {
    std::vector<Prediction> predictions;
    for (const Simulation& simulation : observations_.simulations) {
      predictions.push_back(simulation.prediction);
    }
    return observations_.stacked(predictions);
  }

  const Observations& observations_;
  const Hypothesis& hypothesis_;
};

}  // namespace

Dictionary::Dictionary(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                       const std::function<void(std::size_t, std::size_t)>& progress)
    : hypotheses_(&hypotheses) {
  std::vector<std::vector<Eigen::MatrixXd>> blocks(hypotheses.size());
  in_parallel(hypotheses.size(), progress, [&](std::size_t i) {
    const Columns columns_of(observations, hypotheses[i]);
    for (const Values& start : hypotheses[i].starts) {
      blocks[i].push_back(columns_of.at(start));
    }
  });
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < blocks[i].size(); ++k) {
      const bool shows =
          blocks[i][k].allFinite() && blocks[i][k].topRows(observations.train).norm() > 0;
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
  gram = Eigen::MatrixXd::Zero(count, count);
  gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.topRows(observations.train).transpose());
  gram = Eigen::MatrixXd(gram.selfadjointView<Eigen::Lower>());
}

const Entry* Dictionary::find(const Hypothesis& hypothesis) const {
  for (const Entry& entry : entries) {
    if (&(*hypotheses_)[entry.hypothesis] == &hypothesis) {
      return &entry;
    }
  }
  return nullptr;
}

std::vector<Screened> screen(const Observations& observations,
                             const std::vector<Hypothesis>& hypotheses,
                             const Dictionary& dictionary, const Eigen::VectorXd& remainder,
                             const Eigen::MatrixXd& fitted) {
  const Eigen::Index n = observations.train;
  Eigen::VectorXd left = remainder.head(n);
  const auto columns = dictionary.columns.topRows(n);
  Eigen::MatrixXd orthonormal(n, 0);
  if (fitted.cols() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(fitted.topRows(n));
    orthonormal = qr.householderQ() * Eigen::MatrixXd::Identity(n, qr.rank());
    left -= orthonormal * (orthonormal.transpose() * left);
  }
  const Eigen::MatrixXd shared = orthonormal.transpose() * columns;
  const Eigen::VectorXd product = columns.transpose() * left;
  const double sum = left.squaredNorm();
  std::vector<Screened> all;
  for (std::size_t i = 0; i < dictionary.entries.size(); ++i) {
    const Entry& entry = dictionary.entries[i];
    const auto common = shared.middleCols(entry.first, entry.count);
    const Eigen::MatrixXd own =
        dictionary.gram.block(entry.first, entry.first, entry.count, entry.count);
    Eigen::MatrixXd inner = own - common.transpose() * common;
    const Eigen::VectorXd scale = own.diagonal().cwiseSqrt().cwiseMax(1e-300);
    inner = scale.cwiseInverse().asDiagonal() * inner * scale.cwiseInverse().asDiagonal();
    inner.diagonal().array() += 1e-10;
    const Eigen::VectorXd moment = product.segment(entry.first, entry.count).cwiseQuotient(scale);
    const Eigen::VectorXd solved = inner.ldlt().solve(moment);
    const double gain = 2 * moment.dot(solved) - solved.dot(inner * solved);
    const Eigen::VectorXd amplitude = solved.cwiseQuotient(scale);
    if (gain > 0 && amplitude.allFinite() &&
        within_bounds(hypotheses[entry.hypothesis], amplitude)) {
      all.push_back({i, std::max(sum - gain, 0.0), amplitude});
    }
  }
  return all;
}

FullestFit fit_all(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                   const Dictionary& dictionary) {
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
  const Eigen::VectorXd target = observations.residual.head(observations.train);
  fit.remainder = target - columns * qr.solve(target);
  fit.freedom = observations.train - qr.rank();
  return fit;
}

bool within_bounds(const Hypothesis& hypothesis, const Eigen::VectorXd& amplitude) {
  if (hypothesis.linear == 0) {
    return amplitude[0] > kLeastWhole && amplitude[0] < kMostWhole;
  }
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    const Parameter& parameter = hypothesis.parameters[static_cast<std::size_t>(i)];
    // Noise may take a parameter that is nothing a little below its bound.
    const double slack = amplitude.size() > 1 ? 2 * parameter.step : 0;
    if (!(amplitude[i] >= parameter.lower - slack && amplitude[i] <= parameter.upper + slack)) {
      return false;
    }
  }
  return true;
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
