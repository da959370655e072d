#include "diagnosis/families/elimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "diagnosis/covariance.hpp"
#include "diagnosis/evidence.hpp"
#include "diagnosis/families/candidates.hpp"
#include "linear_algebra/gram.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kWeightRounds = 3;     // of Huber's weights: they change little after that
constexpr double kEdge = 1e-2;       // of a body's size, for its first fit by simulation
constexpr Eigen::Index kParts = 10;  // that are predicted from all others

/// The part of the samples that is predicted as one: neighbours in time are in the same.
Eigen::Index part_of(const Observations& observations, const Sample& at) {
  return stretch_of(at.row, observations.scenes[at.scene].rows()) % kParts;
}

/// Samples of a remainder for each that is independent.
double repeats_of(const Observations& observations, const Eigen::VectorXd& remainder) {
  return static_cast<double>(observations.train) / independent_samples(observations, remainder);
}

}  // namespace

double deviation_of(const Observations& observations, const Eigen::VectorXd& remainder) {
  const Eigen::VectorXd left = remainder.head(observations.train);
  const double square =
      huber_weights(left).dot(left.cwiseAbs2()) / static_cast<double>(observations.train);
  return std::sqrt(repeats_of(observations, left) * std::max(1.0, square));
}

Elimination::Elimination(const Observations& observations, const Fit& given,
                         const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary)
    : Elimination(observations, given, given.chosen.size(), hypotheses, dictionary) {}

Elimination::Elimination(const Observations& observations, const Fit& about, std::size_t given,
                         const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary)
    : observations_(observations),
      target_(about.remainder.head(observations.train)),
      columns_(observations.train, 0) {
  for (std::size_t i = 0; i < about.chosen.size(); ++i) {
    const Chosen& chosen = about.chosen[i];
    const auto count = static_cast<Eigen::Index>(chosen.values.size());
    const auto columns = about.derivative.middleCols(about.first_parameter(i), count);
    if (i < given) {
      add({chosen, {}, true}, columns);
      continue;
    }
    add({{chosen.hypothesis, Values(chosen.values.size(), 0.0)}, {}, false}, columns);
    target_ += columns.topRows(observations.train) *
               Eigen::Map<const Eigen::VectorXd>(chosen.values.data(), count);
  }
  const Eigen::MatrixXd said = what_is_said(about, given, observations.train);
  for (const Hypothesis& each : hypotheses) {
    const Entry* entry = dictionary.find(each);
    if (is_candidate(observations, each) && !is_chosen(about.chosen, each) && entry != nullptr) {
      const auto columns = dictionary.columns.middleCols(entry->first, entry->count);
      const Eigen::MatrixXd own = columns.topRows(observations.train);
      if (could_matter(each, own, target_) && !is_said(own, said)) {
        add({{each, Values(each.parameters.size(), 0.0)}, {}, false}, columns);
      }
    }
  }
  unit_ = target_.norm() * columns_.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
  weight_ = Eigen::VectorXd::Ones(observations.train);
  prepare_plain();
}

template <typename Columns>
void Elimination::add(Member member, const Columns& columns) {
  const Eigen::Index first = columns_.cols();
  columns_.conservativeResize(observations_.train, first + columns.cols());
  columns_.rightCols(columns.cols()) = columns.topRows(observations_.train);
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Parameter& parameter = member.chosen.hypothesis.parameters[at];
    const double begin = member.chosen.values[at];
    bounds_.emplace_back(parameter.lower - begin, parameter.upper - begin);
    is_held_.push_back(false);
    widest_.conservativeResize(first + columns.cols());
    widest_[first + i] = member.is_given ? std::numeric_limits<double>::infinity()
                                         : usual_width(observations_, member.chosen.hypothesis, at);
    member.columns.push_back(first + i);
  }
  members_.push_back(std::move(member));
}

std::vector<Eigen::Index> Elimination::columns_of(const std::vector<std::size_t>& members) const {
  std::vector<Eigen::Index> all;
  for (const std::size_t member : members) {
    for (const Eigen::Index column : members_[member].columns) {
      if (!is_held_[static_cast<std::size_t>(column)]) {
        all.push_back(column);
      }
    }
  }
  return all;
}

/// Standard deviations that hold the numbers; none is wider than its plausible range. Gains are
/// held by that alone: only their usual size tells the unit of all torques, and how uncertain it
/// is.
Eigen::VectorXd Elimination::tolerance() const {
  Eigen::VectorXd width = (tolerance_ * unit_).cwiseMin(widest_);
  for (const Member& member : members_) {
    if (member.chosen.hypothesis.traits().is_gain) {
      width(member.columns) = widest_(member.columns);
    }
  }
  return width;
}

/// Precisions by which the tolerances hold the numbers, beside samples over the noise. They weigh
/// more where the remainder hangs together over time, since its samples tell less then.
Eigen::VectorXd Elimination::precision() const {
  return (deviation() / tolerance().array()).square().matrix();
}

Eigen::VectorXd Elimination::solution(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                                      const std::vector<Eigen::Index>& columns) const {
  Eigen::MatrixXd inner = gram(columns, columns);
  inner.diagonal() += precision()(columns);
  return inner.ldlt().solve(moment(columns));
}

Elimination::Equations Elimination::equations_of(const std::vector<Eigen::Index>& rows,
                                                 const Eigen::VectorXd& weight) const {
  const Eigen::VectorXd root = weight(rows).cwiseSqrt();
  const Eigen::MatrixXd columns = root.asDiagonal() * columns_(rows, Eigen::all);
  const Eigen::VectorXd target = root.cwiseProduct(target_(rows));
  Equations equations;
  equations.gram = linear_algebra::gram_of(columns);
  equations.moment = columns.transpose() * target;
  equations.square = target.squaredNorm();
  return equations;
}

/// Normal equations of each part of the samples, and of all, where all have the weight of one.
void Elimination::prepare_plain() {
  std::vector<std::vector<Eigen::Index>> rows(static_cast<std::size_t>(kParts));
  for (Eigen::Index i = 0; i < observations_.train; ++i) {
    const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
    rows[static_cast<std::size_t>(part_of(observations_, at))].push_back(i);
  }
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(observations_.train);
  for (std::vector<Eigen::Index>& own : rows) {
    if (!own.empty()) {
      plain_.push_back(equations_of(own, one));
      rows_.push_back(std::move(own));
    }
  }
}

/// Normal equations of each part. Few samples weigh less than one: what they lack is taken off.
std::vector<Elimination::Equations> Elimination::weighted_parts() const {
  std::vector<Equations> parts = plain_;
  const Eigen::VectorXd lack = Eigen::VectorXd::Ones(weight_.size()) - weight_;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    std::vector<Eigen::Index> light;
    std::copy_if(rows_[part].begin(), rows_[part].end(), std::back_inserter(light),
                 [&](Eigen::Index row) { return lack[row] > 0; });
    if (light.empty()) {
      continue;
    }
    const Equations less = equations_of(light, lack);
    parts[part].gram -= less.gram;
    parts[part].moment -= less.moment;
    parts[part].square -= less.square;
  }
  return parts;
}

/// Robust least squares of all members; their normal equations.
void Elimination::solve(const std::vector<std::size_t>& members) {
  const std::vector<Eigen::Index> columns = columns_of(members);
  for (int round = 0; round < kWeightRounds; ++round) {
    gram_ = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    moment_ = Eigen::VectorXd::Zero(columns_.cols());
    for (const Equations& part : weighted_parts()) {
      gram_ += part.gram;
      moment_ += part.moment;
    }
    value_ = Eigen::VectorXd::Zero(columns_.cols());
    value_(columns) = solution(gram_, moment_, columns);
    remainder_ = target_ - columns_ * value_;
    const auto n = static_cast<double>(remainder_.size());
    spread_ = std::max(1.0, std::sqrt(weight_.dot(remainder_.cwiseAbs2()) / n));
    repeats_ = repeats_of(observations_, remainder_);
    weight_ = huber_weights(remainder_, spread_);
  }
}

/// Weighted squares that a set leaves in each part when it is fitted to all others.
double Elimination::error_elsewhere(const std::vector<std::size_t>& members) const {
  const std::vector<Eigen::Index> columns = columns_of(members);
  double error = 0;
  for (const Equations& part : parts_) {
    const Eigen::VectorXd value = solution(gram_ - part.gram, moment_ - part.moment, columns);
    const Eigen::VectorXd moment = part.moment(columns);
    error += part.square - 2 * value.dot(moment) + value.dot(part.gram(columns, columns) * value);
  }
  return std::max(error, 0.0);  // of samples without any, rounding leaves less than nothing
}

/// Members that leave a set together: each by itself, but gains all at once. With all gains larger
/// and all masses and frictions smaller, a machine gives the same torques: if one gain is left out,
/// all other numbers are told in its joint's unit.
std::vector<std::vector<std::size_t>> Elimination::leaving_together(
    const std::vector<std::size_t>& members) const {
  std::vector<std::vector<std::size_t>> all;
  std::vector<std::size_t> gains;
  for (const std::size_t member : members) {
    if (members_[member].is_given) {
      continue;
    }
    if (members_[member].chosen.hypothesis.traits().is_gain) {
      gains.push_back(member);
    } else {
      all.push_back({member});
    }
  }
  if (!gains.empty()) {
    all.push_back(std::move(gains));
  }
  return all;
}

/// The members that are known least beside the others, by Wald's statistic over its degrees of
/// freedom; none where only given ones are left.
std::vector<std::size_t> Elimination::weakest_of(const std::vector<std::size_t>& members,
                                                 const Eigen::VectorXd& widenings) const {
  const std::vector<Eigen::Index> columns = columns_of(members);
  Eigen::MatrixXd inner = gram_(columns, columns);
  inner.diagonal() += precision()(columns);
  const Eigen::LDLT<Eigen::MatrixXd> factors(inner);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(columns_.cols());
  const Eigen::VectorXd moment = moment_(columns);
  const Eigen::VectorXd solved = factors.solve(moment);
  value(columns) = solved;
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
  const Eigen::MatrixXd covariance =
      factors.solve(Eigen::MatrixXd::Identity(inner.rows(), inner.cols()));
  inverse(columns, columns) = covariance;
  std::vector<std::size_t> weakest;
  double least = std::numeric_limits<double>::infinity();
  for (std::vector<std::size_t>& leaving : leaving_together(members)) {
    const std::vector<Eigen::Index> own = columns_of(leaving);
    if (own.empty()) {
      return leaving;
    }
    const Eigen::VectorXd values = value(own);
    const Eigen::MatrixXd uncertain = inverse(own, own);
    const double known = values.dot(uncertain.ldlt().solve(values)) /
                         (widenings(own).maxCoeff() * static_cast<double>(own.size()));
    if (!(known >= least)) {
      least = std::isnan(known) ? -std::numeric_limits<double>::infinity() : known;
      weakest = std::move(leaving);
    }
  }
  return weakest;
}

/// The number in use that lies farthest out of its bounds, over its tolerance; -1 where none does.
Eigen::Index Elimination::farthest_out(const std::vector<std::size_t>& members) const {
  const std::vector<Eigen::Index> columns = columns_of(members);
  const Eigen::VectorXd value = solution(gram_, moment_, columns);
  const Eigen::VectorXd width = tolerance();
  double most = 0;
  Eigen::Index farthest = -1;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::Index column = columns[i];
    const auto [lower, upper] = bounds_[static_cast<std::size_t>(column)];
    const double at = value[static_cast<Eigen::Index>(i)];
    const double out = std::max(lower - at, at - upper) / width[column];
    if (out > most) {
      most = out;
      farthest = column;
    }
  }
  return farthest;
}

/// Holds numbers at the model's that would leave their bounds, the farthest first: what they seem
/// to tell is another's. Those that stay within them beside all others after all are let go.
void Elimination::hold_impossible(const std::vector<std::size_t>& members) {
  for (Eigen::Index out = farthest_out(members); out >= 0; out = farthest_out(members)) {
    is_held_[static_cast<std::size_t>(out)] = true;
  }
  for (const std::size_t member : members) {
    for (const Eigen::Index column : members_[member].columns) {
      const auto at = static_cast<std::size_t>(column);
      if (is_held_[at]) {
        is_held_[at] = false;
        is_held_[at] = farthest_out(members) >= 0;
      }
    }
  }
}

std::vector<std::size_t> Elimination::all_members() const {
  std::vector<std::size_t> all(members_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Factors by which the numbers' variances are larger since the remainder hangs together over time.
Eigen::VectorXd Elimination::widenings() const {
  Eigen::VectorXd wide(columns_.cols());
  for (Eigen::Index column = 0; column < columns_.cols(); ++column) {
    wide[column] = correlated_widening(
        observations_, columns_.col(column).cwiseProduct(weight_).cwiseProduct(remainder_));
  }
  return wide;
}

/// What a set of numbers is found to be, and how certainly; endless certainty, zero, of those that
/// are not among them.
Elimination::Estimate Elimination::estimate(const std::vector<Eigen::Index>& columns) const {
  Eigen::MatrixXd inner = gram_(columns, columns);
  inner.diagonal() += precision()(columns);
  const Eigen::LDLT<Eigen::MatrixXd> factors(inner);
  const Eigen::MatrixXd inverse =
      factors.solve(Eigen::MatrixXd::Identity(inner.rows(), inner.cols()));
  Estimate all{Eigen::VectorXd::Zero(columns_.cols()), Eigen::VectorXd::Zero(columns_.cols())};
  const Eigen::VectorXd moment = moment_(columns);
  const Eigen::VectorXd value = factors.solve(moment);
  all.value(columns) = value;
  all.variance(columns) = deviation() * deviation() * inverse.diagonal();
  return all;
}

/// Factors by which a set's numbers are less certain if the members that were left out are not
/// ruled out: they would share what a number tells, and change it. Other forms of friction do not
/// count: which form it is makes no other number uncertain.
Eigen::VectorXd Elimination::widenings_by_others(const std::vector<std::size_t>& members) const {
  const std::vector<Eigen::Index> own = columns_of(members);
  std::vector<Eigen::Index> all = own;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& member = members_[i];
    if (std::find(members.begin(), members.end(), i) == members.end() &&
        !member.chosen.hypothesis.traits().is_friction) {
      all.insert(all.end(), member.columns.begin(), member.columns.end());
    }
  }
  const Estimate alone = estimate(own);
  const Estimate beside = estimate(all);
  const Eigen::VectorXd square = beside.variance + (beside.value - alone.value).cwiseAbs2();
  return (alone.variance.array() > 0)
      .select(square.cwiseQuotient(alone.variance.cwiseMax(1e-300)), 1)
      .cwiseMax(1)
      .cwiseSqrt();
}

double Elimination::deviation() const { return spread_ * std::sqrt(repeats_); }

/// Every sample weighs as much as any other, whatever was solved before.
void Elimination::begin_anew() {
  weight_.setOnes();
  spread_ = 1;
  repeats_ = 1;
}

std::vector<Chosen> Elimination::chosen_of(const Set& set) {
  tolerance_ = set.tolerance;
  widest_ = set.widest;
  is_held_ = set.is_held;
  begin_anew();
  solve(set.members);
  const Eigen::VectorXd widenings = widenings_by_others(set.members);
  std::vector<Chosen> all;
  for (const std::size_t index : set.members) {
    const Member& member = members_[index];
    all.push_back(member.chosen);
    Chosen& chosen = all.back();
    if (!member.is_given && !chosen.hypothesis.is_regression) {
      chosen.hypothesis.edge = kEdge / spread_;
    }
    for (std::size_t i = 0; i < member.columns.size(); ++i) {
      Parameter& parameter = chosen.hypothesis.parameters[i];
      double& value = chosen.values[i];
      value = std::clamp(value + value_[member.columns[i]], parameter.lower, parameter.upper);
      parameter.widening = widenings[member.columns[i]];
      if (!member.is_given) {
        parameter.tolerance = 1 / std::sqrt(precision()[member.columns[i]]);
      }
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
