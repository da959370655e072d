#include "diagnosis/families.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kWeightRounds = 3;          // of Huber's weights: they change little after that
constexpr int kPruneRounds = 5;           // weights follow what was taken out
constexpr double kRobustLimit = 3;        // deviations, as in `fit`
constexpr int kSimulatedSteps = 8;        // of the fit by simulation, from close by
constexpr double kPriorSteps = 300;       // of a parameter, that the model may be off: a weak prior
constexpr Eigen::Index kLagPart = 40;     // of a series, over which a score may be correlated
constexpr Bounds kCouplings{-3, 3, 0.1};  // turns of a motor a turn of the joint before its own
constexpr double kLeastShare = 0.01;  // of the sum of squares, that a coupling is worth trying for
constexpr double kStaysAbove = 6;     // of BIC: "strong" (Kass and Raftery 1995)

/// Columns that belong to one hypothesis.
struct Member {
  Chosen chosen;
  std::vector<Eigen::Index> columns;
  bool is_finding;  ///< stays whatever its evidence is here
};

bool is_member(const Hypothesis& hypothesis) {
  return hypothesis.traits().is_in_family && hypothesis.linear == hypothesis.parameters.size();
}

Eigen::MatrixXd block(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& columns) {
  return all(columns, columns);
}

/// Findings and numbers as columns of the samples to fit to, and their least squares.
class LinearFamilies {
 public:
  LinearFamilies(const Observations& observations, const Fit& findings,
                 const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary)
      : observations_(observations) {
    for (std::size_t i = 0; i < findings.chosen.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(findings.chosen[i].values.size());
      add({findings.chosen[i], {}, true},
          findings.derivative.middleCols(findings.first_parameter(i), count));
    }
    for (const Hypothesis& each : hypotheses) {
      const bool is_found =
          std::any_of(findings.chosen.begin(), findings.chosen.end(),
                      [&](const Chosen& found) { return are_the_same(found.hypothesis, each); });
      const Entry* entry = dictionary.find(each);
      if (is_member(each) && !is_found && entry != nullptr) {
        add({{each, Values(each.parameters.size(), 0.0)}, {}, false},
            dictionary.columns.middleCols(entry->first, entry->count));
      }
    }
    target_ = findings.remainder.head(observations.train);
    weight_ = Eigen::VectorXd::Ones(observations.train);
  }

  /// Takes out numbers until all that are left are known beside each other.
  void prune() {
    for (int round = 0; round < kPruneRounds; ++round) {
      solve();
      if (!take_out_unknown()) {
        return;
      }
    }
  }

  std::vector<Chosen> chosen() const {
    std::vector<Chosen> all;
    for (const Member& member : members_) {
      all.push_back(member.chosen);
      for (std::size_t i = 0; i < member.columns.size(); ++i) {
        const Parameter& parameter = member.chosen.hypothesis.parameters[i];
        double& value = all.back().values[i];
        value = std::clamp(value + value_[member.columns[i]], parameter.lower, parameter.upper);
      }
    }
    return all;
  }

 private:
  template <typename Columns>
  void add(Member member, const Columns& columns) {
    const Eigen::Index first = columns_.cols();
    columns_.conservativeResize(observations_.train, first + columns.cols());
    columns_.rightCols(columns.cols()) = columns.topRows(observations_.train);
    damping_.conservativeResize(first + columns.cols());
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      const Parameter& parameter = member.chosen.hypothesis.parameters[static_cast<std::size_t>(i)];
      damping_[first + i] = std::pow(kPriorSteps * parameter.step, -2);
      member.columns.push_back(first + i);
    }
    members_.push_back(std::move(member));
  }

  std::vector<Eigen::Index> used() const {
    std::vector<Eigen::Index> all;
    for (const Member& member : members_) {
      all.insert(all.end(), member.columns.begin(), member.columns.end());
    }
    return all;
  }

  void solve() {
    const std::vector<Eigen::Index> free = used();
    const Eigen::MatrixXd columns = columns_(Eigen::all, free);
    value_ = Eigen::VectorXd::Zero(columns_.cols());
    for (int round = 0; round < kWeightRounds && !free.empty(); ++round) {
      const Eigen::MatrixXd weighted = weight_.asDiagonal() * columns;
      gram_ = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
      gram_(free, free) = columns.transpose() * weighted;
      gram_.diagonal() += spread_ * spread_ * damping_;
      moment_ = Eigen::VectorXd::Zero(columns_.cols());
      const Eigen::VectorXd moment = weighted.transpose() * target_;
      const Eigen::VectorXd value = block(gram_, free).ldlt().solve(moment);
      moment_(free) = moment;
      value_(free) = value;
      remainder_ = target_ - columns * value;
      const auto n = static_cast<double>(remainder_.size());
      spread_ = std::max(1.0, std::sqrt(weight_.dot(remainder_.cwiseAbs2()) / n));
      weight_ = (kRobustLimit * spread_ / remainder_.array().abs().max(1e-12)).min(1.0).matrix();
    }
  }

  /// By how much the variance of a column's value is larger than for independent errors: scores
  /// that are correlated over time (Newey and West 1987, Bartlett's weights).
  double widening(Eigen::Index column) const {
    const Eigen::VectorXd score =
        columns_.col(column).cwiseProduct(weight_).cwiseProduct(remainder_);
    double alone = 0;
    double together = 0;
    Eigen::Index begin = 0;
    while (begin < score.size()) {
      Eigen::Index end = begin + 1;
      while (end < score.size() && is_same_series(begin, end)) {
        ++end;
      }
      const auto series = score.segment(begin, end - begin);
      const Eigen::Index lags =
          observations_.is_static ? 0 : std::max<Eigen::Index>(1, series.size() / kLagPart);
      alone += series.squaredNorm();
      together += series.squaredNorm();
      for (Eigen::Index lag = 1; lag <= lags && lag < series.size(); ++lag) {
        const double share = 1 - static_cast<double>(lag) / static_cast<double>(lags + 1);
        const Eigen::Index pairs = series.size() - lag;
        together += 2 * share * series.head(pairs).dot(series.tail(pairs));
      }
      begin = end;
    }
    return alone > 0 ? std::max(1.0, together / alone) : 1.0;
  }

  bool is_same_series(Eigen::Index a, Eigen::Index b) const {
    const Sample& one = observations_.samples[static_cast<std::size_t>(a)];
    const Sample& other = observations_.samples[static_cast<std::size_t>(b)];
    return one.scene == other.scene && one.channel == other.channel &&
           one.component == other.component;
  }

  /// BIC of a member by Wald's statistic, its variance widened.
  double evidence(const Member& member, const Eigen::MatrixXd& inverse,
                  const Eigen::VectorXd& widenings) const {
    const double wide = widenings(member.columns).maxCoeff();
    const Eigen::MatrixXd covariance = spread_ * spread_ * wide * block(inverse, member.columns);
    const Eigen::VectorXd own = value_(member.columns);
    const double samples = static_cast<double>(observations_.train) / wide;
    return own.dot(covariance.ldlt().solve(own)) -
           static_cast<double>(member.columns.size()) * std::log(samples);
  }

  /// With the weights as they are: true if any number was taken out.
  bool take_out_unknown() {
    Eigen::VectorXd widenings = Eigen::VectorXd::Ones(columns_.cols());
    for (const Eigen::Index column : used()) {
      widenings[column] = widening(column);
    }
    bool any = false;
    while (true) {
      const std::vector<Eigen::Index> free = used();
      if (free.empty()) {
        return any;
      }
      const Eigen::LDLT<Eigen::MatrixXd> factors(block(gram_, free));
      const Eigen::VectorXd moment = moment_(free);
      Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
      const auto size = static_cast<Eigen::Index>(free.size());
      inverse(free, free) = factors.solve(Eigen::MatrixXd::Identity(size, size)).eval();
      value_.setZero();
      value_(free) = factors.solve(moment).eval();
      auto weakest = members_.end();
      double least = kStaysAbove;
      for (auto at = members_.begin(); at != members_.end(); ++at) {
        const double own = at->is_finding ? kStaysAbove : evidence(*at, inverse, widenings);
        if (!(own >= least)) {  // not a number: what does not show goes first
          least = std::isnan(own) ? -std::numeric_limits<double>::infinity() : own;
          weakest = at;
        }
      }
      if (weakest == members_.end()) {
        return any;
      }
      members_.erase(weakest);
      any = true;
    }
  }

  const Observations& observations_;
  std::vector<Member> members_;
  Eigen::MatrixXd columns_;  ///< samples to fit to × all columns, over the noise
  Eigen::VectorXd damping_;  ///< of each column, one over the square of what the prior allows
  Eigen::VectorXd target_;   ///< what the findings leave, over the noise
  Eigen::VectorXd weight_, remainder_;
  Eigen::MatrixXd gram_;  ///< of the columns in use, weighted and damped
  Eigen::VectorXd moment_, value_;
  double spread_ = 1;
};

/// A drive that turns with the joint before its own, by one turn or against it.
struct Coupling {
  Chosen chosen;
  double gain = 0;  ///< fall of the sum of squares by its share of the prediction, to first order
};

/// The couplings that would take most of a fit's remainder, its friction and rotors as they are.
std::vector<Coupling> propose_couplings(const Observations& observations, const Fit& fit) {
  const effects::LawPointer law = effects::find_law("transmission", "");
  const Eigen::VectorXd known = observations.stacked(predict(fit.machine, observations.scenes));
  const auto left = fit.remainder.head(observations.train);
  std::vector<Coupling> all;
  for (const int joint : law->joints(observations.machine.robot.joints())) {
    if (fit.machine.robot.transmission(joint - 1, joint - 2) != 0) {
      continue;
    }
    Hypothesis hypothesis(law, joint, observations.machine.robot);
    hypothesis.set_bounds({kCouplings});
    for (const double ratio : {1.0, -1.0}) {
      Machine coupled = fit.machine;
      hypothesis.apply({ratio}, &coupled);
      const Eigen::VectorXd change =
          (observations.stacked(predict(coupled, observations.scenes)) - known)
              .head(observations.train);
      const double product = change.dot(left);
      const double gain = product > 0 ? product * product / change.squaredNorm() : 0;
      all.push_back({{hypothesis, {ratio}}, gain});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Coupling& a, const Coupling& b) { return a.gain > b.gain; });
  return all;
}

/// The dictionary with the numbers of a coupled drive as they act through its coupling.
Dictionary with_coupled_drive(const Observations& observations, const Dictionary& dictionary,
                              const Chosen& coupling) {
  Dictionary coupled = dictionary;
  Machine machine = observations.machine;
  coupling.hypothesis.apply(coupling.values, &machine);
  const Eigen::VectorXd base = observations.stacked(predict(machine, observations.scenes));
  for (const Entry& entry : coupled.entries) {
    const Hypothesis& hypothesis = coupled.hypotheses[entry.hypothesis];
    if (hypothesis.joint != coupling.hypothesis.joint || !is_member(hypothesis)) {
      continue;
    }
    for (Eigen::Index i = 0; i < entry.count; ++i) {
      const auto parameter = static_cast<std::size_t>(i);
      Values values(hypothesis.parameters.size(), 0.0);
      values[parameter] = hypothesis.parameters[parameter].step;
      Machine changed = machine;
      hypothesis.apply(values, &changed);
      coupled.columns.col(entry.first + i) =
          (observations.stacked(predict(changed, observations.scenes)) - base) / values[parameter];
    }
  }
  return coupled;
}

/// Findings, and behind them the numbers of the families that stay beside them.
Fit fit_beside(const Observations& observations, const Fit& findings,
               const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  LinearFamilies families(observations, findings, hypotheses, dictionary);
  families.prune();
  return fit(observations, families.chosen(), kSimulatedSteps, &dictionary);
}

}  // namespace

Fit fit_families(const Observations& observations, const Fit& findings,
                 const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  Fit best = fit_beside(observations, findings, hypotheses, dictionary);
  if (!observations.has(simulation::joint_torque)) {
    return best;
  }
  std::vector<Chosen> given = findings.chosen;
  Dictionary coupled = dictionary;
  while (true) {
    const std::vector<Coupling> couplings = propose_couplings(observations, best);
    if (couplings.empty() || couplings.front().gain < kLeastShare * best.train_sum) {
      return best;
    }
    given.push_back(couplings.front().chosen);
    coupled = with_coupled_drive(observations, coupled, given.back());
    Fit next = fit_beside(observations, fit(observations, given, 0, &coupled), hypotheses, coupled);
    if (!(bic_gain(observations, best, next) > kStrongEvidence)) {
      return best;
    }
    best = std::move(next);
  }
}

}  // namespace flexcomp::diagnosis
