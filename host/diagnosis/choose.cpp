#include "diagnosis/choose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kConfirmed = 2;
/// Such a fall of what was held out outweighs the estimate of the noise.
constexpr double kOverwhelming = 20;
constexpr double kLeastStrength = 1.0 / 3;
/// What is weaker than this part of the whole is within the exactness of what is simulated of a
/// motion.
constexpr double kExactness = 0.02;
/// Noise of the encoders is in what is predicted: a filter explains it, but it is no mismatch.
constexpr double kLeastBeyondNoise = 0.75;
constexpr double kLeastShare = 0.1;          // of what is left: many small steps are a wrong way
constexpr double kLeastExplained = 0.9;      // of the power of a mismatch, for findings to stand
constexpr double kExplainedNearNoise = 0.8;  // enough where no more than twice the noise is left
constexpr double kFarFromNoise = 2;          // times the noise: too much for what is left of a sum
constexpr std::size_t kMostFindings = 20;
constexpr int kMostInGroup = 5;  // more would be a sum that fits anything
/// A load test's poses lie all over: its many small errors of geometry tell themselves apart.
constexpr int kMostInLoadTest = 16;
constexpr std::size_t kShortlist = 5;
constexpr std::size_t kLongShortlist = 2;  // times as many, where some of it cannot be
constexpr std::size_t kMany = 4;  // findings, from which on fits are slow and little is ambiguous
constexpr std::size_t kShortShortlist = 2;
constexpr int kQuickSteps = 4;
constexpr double kSettled = 1.1;  // times the noise: nothing left that two could share
constexpr int kSteps = 12;
constexpr int kLastSteps = 60;

/// A hypothesis with values to begin with, and what it promises.
struct Candidate {
  double gain;
  Chosen chosen;
  const Dictionary* dictionary;
  const Entry* entry;
};

class Chooser {
 public:
  Chooser(const Observations* observations, const std::vector<Hypothesis>& hypotheses,
          const Dictionary& dictionary, double false_discovery)
      : observations_(observations),
        hypotheses_(hypotheses),
        dictionary_(dictionary),
        false_discovery_(false_discovery) {}

  /// The most promising hypotheses beside a fit, one start each, the best first.
  std::vector<Chosen> shortlist(const Fit& fit, std::size_t most) const {
    std::vector<Chosen> chosen;
    for (Candidate& candidate : candidates(fit)) {
      if (chosen.size() < most) {
        chosen.push_back(std::move(candidate.chosen));
      }
    }
    return chosen;
  }

  /// Effects at places by what they explain alone, the best form of each.
  std::vector<Ranked> ranking(const Fit& fit) const {
    std::vector<Ranked> all;
    for (const Candidate& candidate : candidates(fit)) {
      const Hypothesis& own = *candidate.chosen.hypothesis;
      const bool is_known = std::any_of(all.begin(), all.end(), [&](const Ranked& other) {
        return other.effect == own.effect() && other.joint == own.joint;
      });
      if (!is_known && candidate.gain > 0) {
        all.push_back({own.effect(), own.joint, candidate.gain});
      }
    }
    return all;
  }

  /// Every hypothesis beside a fit with the best of its starts, the most promising first.
  std::vector<Candidate> candidates(const Fit& fit) const {
    std::vector<Candidate> all;
    add_candidates(fit, hypotheses_, dictionary_, &all);
    if (sought_dictionary_) {
      add_candidates(fit, *sought_.back(), *sought_dictionary_, &all);
    }
    std::sort(all.begin(), all.end(),
              [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
    return all;
  }

  void add_candidates(const Fit& fit, const std::vector<Hypothesis>& hypotheses,
                      const Dictionary& dictionary, std::vector<Candidate>* all) const {
    const std::vector<Screened> screened =
        screen(*observations_, hypotheses, dictionary, fit.remainder, fit.derivative);
    std::vector<const Screened*> best(hypotheses.size(), nullptr);
    for (const Screened& each : screened) {
      const std::size_t hypothesis = dictionary.entries[each.entry].hypothesis;
      if (best[hypothesis] == nullptr || each.sum < best[hypothesis]->sum) {
        best[hypothesis] = &each;
      }
    }
    const double samples = independent_samples(*observations_, fit.remainder);
    const double before = fit.remainder.head(observations_->train).squaredNorm();
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
      if (best[h] != nullptr && !is_among(hypotheses[h], fit)) {
        const double gain =
            bic_gain(samples, before, best[h]->sum, hypotheses[h].parameters.size());
        all->push_back({gain, chosen_of(hypotheses, dictionary, *best[h]), &dictionary,
                        &dictionary.entries[best[h]->entry]});
      }
    }
  }

  static Chosen chosen_of(const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                          const Screened& screened) {
    const Entry& entry = dictionary.entries[screened.entry];
    const Hypothesis& hypothesis = hypotheses[entry.hypothesis];
    return {&hypothesis, values_of(hypothesis, entry, screened.amplitude)};
  }

  /// Seeks new starts in what a fit leaves, for the hypotheses that need it.
  void seek(const Fit& fit) {
    std::vector<Hypothesis> found = sought_anew(*observations_, fit.remainder, hypotheses_);
    if (!found.empty()) {
      sought_.push_back(std::make_shared<const std::vector<Hypothesis>>(std::move(found)));
      sought_dictionary_ = std::make_unique<Dictionary>(*observations_, *sought_.back(),
                                                        [](std::size_t, std::size_t) {});
    }
  }

  const std::vector<std::shared_ptr<const std::vector<Hypothesis>>>& sought() const {
    return sought_;
  }

  /// The fits of the best pairs whose parts do not cancel each other.
  std::vector<Fit> pairs() const {
    constexpr std::size_t kPairs = 3;
    std::vector<Fit> fits;
    for (const ScreenedPair& pair :
         screen_pairs(*observations_, hypotheses_, dictionary_, kPairs)) {
      Fit tried = fit(*observations_,
                      {chosen_of(hypotheses_, dictionary_, pair.first),
                       chosen_of(hypotheses_, dictionary_, pair.second)},
                      kSteps, &dictionary_);
      if (cancellation(*observations_, tried) < kMostCancellation) {
        fits.push_back(std::move(tried));
      }
    }
    return fits;
  }

  /// By strong evidence, or by any with fewer findings.
  bool is_better(const Fit& one, const Fit& other) const {
    const double margin = one.chosen.size() < other.chosen.size() ? 0 : kStrongEvidence;
    return criterion(one) < criterion(other) - margin && all_hold(one);
  }

  /// BIC but for a constant: the smaller the better, fits of any hypotheses beside each other. What
  /// rests at a bound, like the directions in which a base does not give, is not fitted.
  double criterion(const Fit& fit) const {
    int fitted = 0;
    for (const Chosen& each : fit.chosen) {
      for (std::size_t i = 0; i < each.values.size(); ++i) {
        const Parameter& parameter = each.hypothesis->parameters[i];
        fitted += each.values[i] > parameter.lower && each.values[i] < parameter.upper ? 1 : 0;
      }
    }
    const auto samples = static_cast<double>(observations_->train);
    return samples * std::log(std::max(fit.train_sum, 1e-9)) + fitted * std::log(samples);
  }

  bool all_hold(const Fit& whole) const {
    for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
      if (!holds(judge(whole, i).evidence)) {
        return false;
      }
    }
    return true;
  }

  Fit with(const Fit& fit_before, const Chosen& chosen, int steps) const {
    std::vector<Chosen> all = fit_before.chosen;
    all.push_back(chosen);
    return fit(*observations_, std::move(all), steps, &dictionary_);
  }

  Fit without(const Fit& whole, std::size_t index) const {
    std::vector<Chosen> others = whole.chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(index));
    return fit(*observations_, std::move(others), kQuickSteps, &dictionary_);
  }

  /// Can the last hypothesis of a fit be, as fitted?
  bool can_be(const Fit& fit) const {
    return why_impossible(*observations_, fit, fit.chosen.size() - 1).empty();
  }

  /// Those of a shortlist beside a fit that can be, quickly fitted, the best first.
  std::vector<Fit> tried_with(const Fit& before, std::size_t most) const {
    std::vector<Fit> all;
    for (const Chosen& candidate : shortlist(before, kLongShortlist * most)) {
      Fit tried = with(before, candidate, kQuickSteps);
      if (can_be(tried)) {
        all.push_back(std::move(tried));
      }
      if (all.size() == most) {
        break;
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [&](const Fit& a, const Fit& b) { return criterion(a) < criterion(b); });
    return all;
  }

  /// The best of a shortlist beside a fit, fitted; nothing chosen if the list is empty.
  Fit best_with(const Fit& before, std::size_t most) const {
    const std::vector<Fit> tried = tried_with(before, most);
    return tried.empty() ? Fit{} : fit(*observations_, tried.front().chosen, kSteps, &dictionary_);
  }

  static std::size_t shortlist_beside(const Fit& fit) {
    return fit.chosen.size() < kMany ? kShortlist : kShortShortlist;
  }

  bool holds(const Evidence& evidence) const {
    return evidence.impossible.empty() && evidence.delta_bic > kStrongEvidence &&
           evidence.p_value < false_discovery_ && evidence.confirmation > kConfirmed &&
           evidence.strength > kLeastStrength &&
           (observations_->is_static || evidence.relative_strength > kExactness) &&
           (observations_->is_static || evidence.beyond_noise > kLeastBeyondNoise ||
            evidence.confirmation > kOverwhelming) &&
           evidence.share > kLeastShare;
  }

  /// In the end no finding is made that does not lower the held-out error itself.
  bool stands(const Evidence& evidence) const {
    return holds(evidence) && evidence.lowers_held_out;
  }

  Evidence weigh_last(const Fit& before, const Fit& after) const {
    return weigh(*observations_, before, after, static_cast<double>(dictionary_.entries.size()));
  }

  /// From another fit on.
  void begin() { found_in_.clear(); }

  bool grow(Fit* current) {
    for (const Fit& tried : tried_with(*current, shortlist_beside(*current))) {
      Fit grown = fit(*observations_, tried.chosen, kSteps, &dictionary_);
      const Evidence evidence = weigh_last(*current, grown);
      if (holds(evidence)) {
        if (++found_in_[evidence.group] > most_in_group()) {
          return false;
        }
        *current = std::move(grown);
        return true;
      }
      const bool can_be = evidence.impossible.empty();
      if (can_be && (evidence.confirmation > kConfirmed || evidence.delta_bic < kStrongEvidence)) {
        return false;
      }
    }
    return false;
  }

  int most_in_group() const { return observations_->is_static ? kMostInLoadTest : kMostInGroup; }

  /// Do two choices, each of a fit, show in the same samples?
  bool meet(const Fit& fit, std::size_t index, const Fit& other_fit, std::size_t other) const {
    return meet(directions(fit, index), directions(other_fit, other));
  }

  /// Do two, by their directions? Else neither can stand in for the other: friction of one joint
  /// and friction of another.
  static bool meet(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
    constexpr double kMeeting = 0.03;  // cosine
    return (one.transpose() * other).cwiseAbs().maxCoeff() > kMeeting;
  }

  /// How a choice changes the samples to fit to, for each of its parameters, of length one.
  Eigen::MatrixXd directions(const Fit& fit, std::size_t index) const {
    const auto width = static_cast<Eigen::Index>(fit.chosen[index].values.size());
    return normalized(fit.derivative.middleCols(fit.first_parameter(index), width));
  }

  Eigen::MatrixXd directions(const Candidate& candidate) const {
    const Entry& entry = *candidate.entry;
    return normalized(candidate.dictionary->columns.middleCols(entry.first, entry.count));
  }

  template <typename Columns>
  Eigen::MatrixXd normalized(const Columns& columns) const {
    constexpr double kTiny = 1e-300;  // a parameter that does not show has no direction
    Eigen::MatrixXd all = columns.topRows(observations_->train);
    all.array().rowwise() /= all.colwise().norm().cwiseMax(kTiny).array().eval();
    return all;
  }

  /// Replaces or drops one choice, the earliest that can be bettered; false if all stand.
  bool revise(Fit* current) const {
    for (std::size_t i = 0; i + 1 < current->chosen.size(); ++i) {
      if (!meet(*current, i, *current, current->chosen.size() - 1)) {
        continue;
      }
      const Fit others = without(*current, i);
      const Fit replaced = best_with(others, kShortlist / 2);
      if (replaced.chosen.empty()) {
        continue;
      }
      const bool better = replaced.train_sum < current->train_sum &&
                          criterion(replaced) < criterion(*current) - kStrongEvidence;
      const bool simpler = replaced.parameters() < current->parameters() &&
                           criterion(replaced) < criterion(*current);
      if ((better || simpler) && holds(weigh_last(others, replaced))) {
        *current = replaced;
        return true;
      }
    }
    return false;
  }

  /// Drops what no longer holds beside the others: what cannot be first, then the weakest.
  void prune(Choice* choice) const {
    while (!choice->fit.chosen.empty()) {
      choice->findings.clear();
      std::size_t weakest = choice->fit.chosen.size();
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < choice->fit.chosen.size(); ++i) {
        choice->findings.push_back(judge(choice->fit, i));
        const Evidence& evidence = choice->findings.back().evidence;
        const double worth = evidence.impossible.empty() ? evidence.delta_bic
                                                         : std::numeric_limits<double>::lowest();
        if (!stands(evidence) && worth < least) {
          least = worth;
          weakest = i;
        }
      }
      if (weakest == choice->fit.chosen.size()) {
        return;
      }
      choice->fit = without(choice->fit, weakest);
    }
    choice->findings.clear();
  }

  /// Withdraws what leaves most of the mismatch standing where it shows, and several findings that
  /// fail together on what was held out there: that proves nothing. Nor does what remains in such a
  /// place (`fallen`: where those showed that were withdrawn), unless it comes near the noise by
  /// itself. What is kept may have stood by what is not: true where it is to be looked at anew.
  bool withdraw_unproved(Choice* choice, std::vector<Group>* fallen) const {
    std::vector<bool> stays(choice->findings.size(), true);
    for (std::size_t i = 0; i < stays.size(); ++i) {
      const Evidence& evidence = choice->findings[i].evidence;
      const bool explains = evidence.explained >=
                            (evidence.left > kFarFromNoise ? kLeastExplained : kExplainedNearNoise);
      const bool fails = explains && falls_with_others(*choice, i);
      const bool is_remnant = evidence.left > kFarFromNoise &&
                              std::any_of(fallen->begin(), fallen->end(), [&](const Group& other) {
                                return are_of_one_place(other, evidence.group);
                              });
      stays[i] = explains && !fails && !is_remnant;
      choice->explained =
          explains ? choice->explained : std::max(choice->explained, evidence.explained);
      choice->mispredicts = choice->mispredicts || fails;
    }
    std::vector<Chosen> kept;
    for (std::size_t i = 0; i < stays.size(); ++i) {
      (stays[i] ? kept : choice->withdrawn).push_back(choice->fit.chosen[i]);
      if (!stays[i]) {
        const std::vector<Group>& shows = choice->findings[i].evidence.shows;
        fallen->insert(fallen->end(), shows.begin(), shows.end());
      }
    }
    if (kept.size() == stays.size()) {
      return false;
    }
    choice->fit = fit(*observations_, std::move(kept), kLastSteps);
    prune(choice);
    return true;
  }

  /// One law that accounts for so much is not so by accident; a sum of several may be: does this
  /// finding fall because all that show in its place fail together on what was held out there? Of
  /// two, one may be right, and only the weaker falls.
  bool falls_with_others(const Choice& choice, std::size_t index) const {
    const Evidence& own = choice.findings[index].evidence;
    int others = 0;
    bool is_weakest = true;
    for (std::size_t i = 0; i < choice.findings.size(); ++i) {
      const Evidence& other = choice.findings[i].evidence;
      if (i != index && other.group == own.group) {
        ++others;
        is_weakest = is_weakest && own.delta_bic <= other.delta_bic;
      }
    }
    return (others > 1 || (others == 1 && is_weakest)) &&
           fails_held_out(*observations_, choice.fit.remainder, own.group);
  }

  Finding judge(const Fit& whole, std::size_t index) const {
    Finding finding;
    finding.without = without(whole, index);
    Fit last = whole;  // the same fit, its last hypothesis the one that is weighed
    std::rotate(last.chosen.begin() + static_cast<std::ptrdiff_t>(index),
                last.chosen.begin() + static_cast<std::ptrdiff_t>(index) + 1, last.chosen.end());
    finding.evidence = weigh_last(finding.without, last);
    return finding;
  }

  /// Puts one hypothesis in the place of two that are not far better than it, and is true then.
  bool merge(Choice* choice) const {
    const std::size_t count = choice->findings.size();
    for (std::size_t i = 0; count <= kMany && i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        const Fit others = without(choice->findings[j].without, i);
        const Fit merged = best_with(others, kShortlist);
        if (!merged.chosen.empty() && is_as_good(merged, choice->fit) &&
            !is_confirmed(merged, choice->fit) && holds(weigh_last(others, merged))) {
          choice->fit = fit(*observations_, merged.chosen, kLastSteps);
          prune(choice);
          return true;
        }
      }
    }
    return false;
  }

  /// Does no strong evidence speak for the richer fit?
  bool is_as_good(const Fit& plain, const Fit& rich) const {
    return bic_gain(*observations_, plain, rich) < kStrongEvidence;
  }

  /// Does what was held out speak for the richer fit?
  bool is_confirmed(const Fit& plain, const Fit& rich) const {
    return weigh_last(plain, rich).confirmation > kConfirmed;
  }

  /// The largest of its parameters, in sizes that matter.
  static double change(const Chosen& chosen) {
    double most = 0;
    for (std::size_t i = 0; i < chosen.values.size(); ++i) {
      most = std::max(most, std::abs(chosen.values[i]) / chosen.hypothesis->parameters[i].step);
    }
    return most;
  }

  /// Of fewer parameters, and no evidence speaks for the other; or as many, with no strong evidence
  /// for the other, of what is changed more often than a joint's own: the payload, not the last
  /// link's mass (of these two, each a body simplified in its own way, no evidence to speak of
  /// beside what either explains); or the very same in numbers by a smaller change: the rotor half
  /// as heavy again, not the link ten times as heavy.
  static bool is_plainer(const Alternative& one, const Finding& finding, const Chosen& other) {
    constexpr double kIdentical = 0.1;    // of BIC
    constexpr double kNegligible = 1e-3;  // of what a finding gains: no simulation is so exact
    if (one.chosen.hypothesis->traits().is_curve_only) {
      return false;
    }
    const bool are_bodies =
        one.chosen.hypothesis->traits().is_body && other.hypothesis->traits().is_body;
    const double negligible = are_bodies ? kNegligible * finding.evidence.delta_bic : 0;
    const double same = std::max(kSameEvidence, negligible);
    const bool is_smaller = one.chosen.values.size() < other.values.size();
    const bool is_as_rich = one.chosen.values.size() == other.values.size();
    const bool is_likelier =
        is_as_rich && one.delta_bic < same && one.joint == 0 && other.hypothesis->joint != 0;
    const bool changes_less = is_as_rich && one.delta_bic < kIdentical &&
                              one.joint == other.hypothesis->joint &&
                              change(one.chosen) < change(other);
    return (is_smaller && one.delta_bic <= 0) || is_likelier || changes_less;
  }

  /// A law of the same joint that fits as well as a mere shape: that it has more parameters, some
  /// of which do not show, says nothing against it.
  static bool is_the_law(const Alternative& one, const Finding& finding, const Chosen& other) {
    constexpr double kIndifferent = 2;  // "not worth more than a bare mention" (Kass and Raftery)
    const double more =
        static_cast<double>(one.chosen.values.size()) - static_cast<double>(other.values.size());
    return other.hypothesis->traits().is_curve_only && one.joint == other.hypothesis->joint &&
           one.delta_bic - more * std::log(finding.evidence.effective_samples) < kIndifferent;
  }

  /// Finds the alternatives; puts a plainer one or the law itself in the place of a finding, and is
  /// true then: the richer one was taken for what others account for by now.
  bool simplify(Choice* choice) const {
    for (std::size_t i = 0; i < choice->findings.size(); ++i) {
      find_alternatives(choice->fit, i, &choice->findings[i]);
    }
    for (std::size_t i = 0; i < choice->findings.size(); ++i) {
      for (const Alternative& other : choice->findings[i].alternatives) {
        const Chosen& own = choice->fit.chosen[i];
        if (is_plainer(other, choice->findings[i], own) ||
            is_the_law(other, choice->findings[i], own)) {
          std::vector<Chosen> chosen = choice->fit.chosen;
          chosen[i] = other.chosen;
          Fit better = fit(*observations_, std::move(chosen), kLastSteps);
          if (!is_confirmed(better, choice->fit)) {
            choice->fit = std::move(better);
            prune(choice);
            return true;
          }
        }
      }
    }
    return false;
  }

  /// Others that would do nearly as well in the place of a finding.
  void find_alternatives(const Fit& whole, std::size_t index, Finding* finding) const {
    const Hypothesis& own = *whole.chosen[index].hypothesis;
    const double samples = finding->evidence.effective_samples;
    const Eigen::MatrixXd shown = directions(whole, index);
    std::size_t looked_at = 0;
    for (const Candidate& candidate : candidates(finding->without)) {
      const Hypothesis& other = *candidate.chosen.hypothesis;
      if (looked_at == shortlist_beside(whole)) {
        break;
      }
      if (!meet(shown, directions(candidate))) {
        continue;
      }
      ++looked_at;
      if (are_the_same(other, own)) {
        continue;
      }
      const Fit tried = with(finding->without, candidate.chosen, kQuickSteps);
      const double gain = bic_gain(samples, finding->without.train_sum, tried.train_sum,
                                   candidate.chosen.values.size());
      if (gain > kStrongEvidence && can_be(tried) &&
          meet(shown, directions(tried, tried.chosen.size() - 1))) {
        finding->alternatives.push_back({other.effect(), other.joint,
                                         std::max(finding->evidence.delta_bic - gain, 0.0),
                                         tried.chosen.back()});
      }
    }
    std::sort(finding->alternatives.begin(), finding->alternatives.end(),
              [](const Alternative& a, const Alternative& b) { return a.delta_bic < b.delta_bic; });
  }

  static bool is_among(const Hypothesis& hypothesis, const Fit& fit) {
    return std::any_of(fit.chosen.begin(), fit.chosen.end(), [&](const Chosen& each) {
      return are_the_same(*each.hypothesis, hypothesis);
    });
  }

 private:
  const Observations* observations_;
  const std::vector<Hypothesis>& hypotheses_;
  const Dictionary& dictionary_;
  double false_discovery_;
  std::map<Group, int> found_in_;
  std::vector<std::shared_ptr<const std::vector<Hypothesis>>> sought_;
  std::unique_ptr<Dictionary> sought_dictionary_;
};

void strongest_first(Choice* choice) {
  std::vector<std::size_t> order(choice->findings.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return choice->findings[a].evidence.delta_bic > choice->findings[b].evidence.delta_bic;
  });
  Choice sorted = *choice;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.findings[i] = choice->findings[order[i]];
    sorted.fit.chosen[i] = choice->fit.chosen[order[i]];
  }
  *choice = std::move(sorted);
}

}  // namespace

Choice choose(const Observations* observations, const std::vector<Hypothesis>& hypotheses,
              const Dictionary& dictionary, double false_discovery, const Tell& tell) {
  Chooser chooser(observations, hypotheses, dictionary, false_discovery);
  Choice choice;
  choice.fit = fit(*observations, {}, 0);
  choice.ranking = chooser.ranking(choice.fit);
  const auto grow = [&](Fit* current) {
    chooser.begin();
    while (current->chosen.size() < kMostFindings && chooser.grow(current)) {
      tell(current->chosen.size(), kMostFindings);
      chooser.revise(current);
      chooser.seek(*current);
    }
  };
  grow(&choice.fit);
  const bool is_settled =
      choice.fit.parameters() <= 2 && largest_ratio(*observations, choice.fit.remainder) < kSettled;
  if (!is_settled) {
    const std::vector<Fit> pairs = chooser.pairs();
    // What grows from a pair may be better in the end; in a load test it is soon found out.
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Fit rival = pairs[i];
      if (chooser.is_better(rival, choice.fit) || (observations->is_static && i == 0)) {
        chooser.seek(rival);
        grow(&rival);
        choice.fit = chooser.is_better(rival, choice.fit) ? rival : choice.fit;
      }
    }
  }
  choice.fit = fit(*observations, choice.fit.chosen, kLastSteps);
  chooser.prune(&choice);
  std::vector<Group> fallen;
  while (chooser.withdraw_unproved(&choice, &fallen)) {
  }
  // Each time a finding, a parameter or a joint less.
  while (chooser.merge(&choice) || chooser.simplify(&choice)) {
  }
  strongest_first(&choice);
  // In the order that the covariance and the derivative have from here on.
  choice.fit = fit(*observations, choice.fit.chosen, 0);
  choice.sought = chooser.sought();
  return choice;
}

}  // namespace flexcomp::diagnosis
