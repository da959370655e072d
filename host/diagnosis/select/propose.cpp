#include "diagnosis/select/propose.hpp"

#include <algorithm>

#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

const Dictionary& dictionary_of(const Inquiry& inquiry, const Attempt& before,
                                const Candidate& candidate) {
  return candidate.is_sought ? *before.sought : inquiry.dictionary;
}

Chosen chosen_of(const Dictionary& dictionary, const Screened& screened) {
  const Entry& entry = dictionary.entries[screened.entry];
  const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
  return {hypothesis, values_of(hypothesis, entry, screened.amplitude)};
}

void add_candidates(const Observations& observations, const Fit& fit, const Dictionary& dictionary,
                    bool is_sought, std::vector<Candidate>* all) {
  const std::vector<Hypothesis>& hypotheses = dictionary.hypotheses;
  const std::vector<Screened> screened =
      screen(hypotheses, dictionary, {observations, dictionary, fit.remainder, fit.derivative});
  std::vector<const Screened*> best(hypotheses.size(), nullptr);
  for (const Screened& each : screened) {
    const std::size_t hypothesis = dictionary.entries[each.entry].hypothesis;
    if (best[hypothesis] == nullptr || each.sum < best[hypothesis]->sum) {
      best[hypothesis] = &each;
    }
  }
  const double samples = independent_samples(observations, fit.remainder);
  const double before = fit.remainder.head(observations.train).squaredNorm();
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    if (best[h] != nullptr && !is_chosen(fit.chosen, hypotheses[h])) {
      const double gain = bic_gain(samples, before, best[h]->sum, hypotheses[h].numbers());
      all->push_back({gain, chosen_of(dictionary, *best[h]), is_sought, best[h]->entry});
    }
  }
}

template <typename Columns>
Eigen::MatrixXd normalized(const Observations& observations, const Columns& columns) {
  constexpr double kTiny = 1e-300;  // a parameter that does not show has no direction
  Eigen::MatrixXd all = columns.topRows(observations.train);
  all.array().rowwise() /= all.colwise().norm().cwiseMax(kTiny).array().eval();
  return all;
}

}  // namespace

Sought seek(const Inquiry& inquiry, const Fit& fit) {
  std::vector<Hypothesis> found =
      sought_anew(inquiry.observations, fit.remainder, inquiry.dictionary.hypotheses);
  if (found.empty()) {
    return nullptr;
  }
  const auto untold = [](std::size_t, std::size_t) {};
  const bool are_curved = std::any_of(
      found.begin(), found.end(), [](const Hypothesis& each) { return each.traits().is_curved; });
  // What is far from proportion does nothing to the model as it was, where that is far away.
  return are_curved
             ? std::make_shared<const Dictionary>(inquiry.observations, std::move(found),
                                                  fit.machine, untold)
             : std::make_shared<const Dictionary>(inquiry.observations, std::move(found), untold);
}

std::vector<Candidate> propose(const Inquiry& inquiry, const Attempt& before) {
  std::vector<Candidate> all;
  add_candidates(inquiry.observations, before.fit, inquiry.dictionary, false, &all);
  if (before.sought) {
    add_candidates(inquiry.observations, before.fit, *before.sought, true, &all);
  }
  std::sort(all.begin(), all.end(),
            [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
  return all;
}

std::vector<Ranked> rank(const std::vector<Candidate>& candidates) {
  std::vector<Ranked> all;
  for (const Candidate& candidate : candidates) {
    const Hypothesis& own = candidate.chosen.hypothesis;
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const Ranked& other) {
      return other.effect == own.effect() && other.joint == own.joint;
    });
    if (!is_known && candidate.gain > 0) {
      all.push_back({own.effect(), own.joint, candidate.gain});
    }
  }
  return all;
}

std::vector<Fit> propose_pairs(const Inquiry& inquiry, const Fit& before) {
  const Dictionary& dictionary = inquiry.dictionary;
  const BesideFitted beside(inquiry.observations, dictionary, before.remainder, before.derivative);
  std::vector<Fit> fits;
  for (const ScreenedPair& pair :
       screen_pairs(inquiry.observations, dictionary.hypotheses, dictionary, beside, kPairs)) {
    std::vector<Chosen> chosen = before.chosen;
    for (const Screened& each : {pair.first, pair.second}) {
      chosen.push_back(chosen_of(dictionary, each));
    }
    Fit tried = fit(inquiry.observations, std::move(chosen), kSteps, &dictionary);
    if (cancellation(inquiry.observations, tried) < kMostCancellation) {
      fits.push_back(std::move(tried));
    }
  }
  return fits;
}

Eigen::MatrixXd directions(const Inquiry& inquiry, const Attempt& before,
                           const Candidate& candidate) {
  const Dictionary& dictionary = dictionary_of(inquiry, before, candidate);
  const Entry& entry = dictionary.entries[candidate.entry];
  return normalized(inquiry.observations, dictionary.columns.middleCols(entry.first, entry.count));
}

Eigen::MatrixXd directions(const Observations& observations, const Fit& fit, std::size_t index) {
  const auto width = static_cast<Eigen::Index>(fit.chosen[index].values.size());
  return normalized(observations, fit.derivative.middleCols(fit.first_parameter(index), width));
}

bool meet(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
  return (one.transpose() * other).cwiseAbs().maxCoeff() > kMeeting;
}

}  // namespace flexcomp::diagnosis
