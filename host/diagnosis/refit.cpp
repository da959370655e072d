#include "diagnosis/refit.hpp"

#include <algorithm>
#include <iterator>

#include "diagnosis/model_error.hpp"
#include "diagnosis/rest.hpp"
#include "diagnosis/select/members.hpp"
#include "diagnosis/select/standards.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Takes the numbers of a fit that stand by themselves for the findings, where they are more than
/// `others`; what does not stand stays behind them.
void take_members(const Inquiry& inquiry, const Fit& whole, std::size_t others,
                  Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  std::vector<Finding> standing = members_that_stand(inquiry, whole);
  if (standing.size() <= others) {
    return;
  }
  std::vector<Chosen> chosen;
  for (const Finding& finding : standing) {
    chosen.push_back(finding.chosen);
  }
  diagnosis->choice.findings = std::move(standing);
  diagnosis->choice.fit = fit(observations, chosen, 0);
  for (const Chosen& each : whole.chosen) {
    if (!is_chosen(chosen, each.hypothesis)) {
      chosen.push_back(each);
    }
  }
  const bool all_stand = chosen.size() == diagnosis->choice.findings.size();
  diagnosis->retuned = all_stand ? Fit{} : fit(observations, std::move(chosen), 0);
  diagnosis->is_weighed_whole = true;
  diagnosis->nearest.clear();
  diagnosis->indistinguishable.clear();
  diagnosis->reason = more_than_noise(observations, diagnosis->updated().remainder);
  diagnosis->verdict = diagnosis->reason.empty() ? Verdict::explained : Verdict::partly_explained;
}

bool is_number_of_family(const Inquiry& inquiry, const Chosen& chosen) {
  return chosen.hypothesis.traits().is_in_family &&
         !is_chosen(inquiry.given.chosen, chosen.hypothesis);
}

/// The findings to begin with. Where torques were recorded these are all, since torques tell each
/// number by itself. Numbers that positions show are left out: nothing would hold a single one to
/// the size of its like.
std::vector<Chosen> kept_of(const Inquiry& inquiry, const Fit& found) {
  if (inquiry.observations.has(simulation::joint_torque)) {
    return found.chosen;
  }
  std::vector<Chosen> kept;
  std::copy_if(found.chosen.begin(), found.chosen.end(), std::back_inserter(kept),
               [&](const Chosen& each) { return !is_number_of_family(inquiry, each); });
  return kept;
}

/// Does a fit leave next to nothing beyond the noise, of what was fitted to and of what was held
/// out?
bool leaves_little(const Observations& observations, const Fit& before, const Fit& after) {
  const auto beyond_noise = [&](const Fit& fit, bool held_out) {
    const Part part = observations.part(held_out);
    const Eigen::Index count = part.end - part.first;
    return fit.remainder.segment(part.first, count).squaredNorm() - static_cast<double>(count);
  };
  const auto is_little = [&](bool held_out) {
    return beyond_noise(after, held_out) <= (1 - kLeastExplained) * beyond_noise(before, held_out);
  };
  return is_little(false) && is_little(true);
}

/// What numbers are fitted beside in any case: what was given, and a finding that accounts for
/// nearly all of the torques by itself, as a load does that nobody told the model of. Masses of
/// several links do the same together, and would share it.
Fit base_of(const Inquiry& inquiry, const Fit& found) {
  Fit base = inquiry.given;
  if (!inquiry.observations.has(simulation::joint_torque)) {
    return base;
  }
  for (const Chosen& each : found.chosen) {
    if (!is_chosen(inquiry.given.chosen, each.hypothesis)) {
      Fit alone = fit_with(inquiry, inquiry.given, each, kSteps);
      if (alone.train_sum < base.train_sum &&
          leaves_little(inquiry.observations, inquiry.given, alone)) {
        base = std::move(alone);
      }
    }
  }
  return base;
}

/// How numbers came to be fitted together, so that the same way can be gone over another noise.
struct Way {
  bool is_alone = true;        ///< without the findings that were made one by one
  bool is_beside = true;       ///< beside those that are no numbers
  std::vector<Chosen> extras;  ///< coupled drives and late clocks that stayed
};

/// The numbers of a machine together, in the place of those that were found one by one: beside the
/// other findings, or beside the base alone where that predicts as well. Nothing where single
/// numbers predict better. Tries the ways given, and gives the one that was best.
Fit together(const Inquiry& inquiry, const Fit& base, const Fit& found,
             const std::vector<Hypothesis>& hypotheses, Way* way) {
  const Observations& observations = inquiry.observations;
  const std::vector<Chosen> kept = kept_of(inquiry, found);
  const bool keeps_any = kept.size() > base.chosen.size();
  Families alone;
  Families beside;
  in_parallel(
      2, [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        if (i == 0 && way->is_alone) {
          alone = retune_whole(observations, base, hypotheses, inquiry.dictionary, way->extras);
        } else if (i == 1 && way->is_beside && keeps_any) {
          const Fit rest = fit(observations, kept, kSteps, &inquiry.dictionary);
          beside = retune_whole(observations, rest, hypotheses, inquiry.dictionary, way->extras);
        }
      });
  const bool is_beside = is_better_beside(observations, alone.fit, beside.fit);
  Families& best = is_beside ? beside : alone;
  if (best.fit.chosen.empty() || predicts_better(observations, best.fit, found)) {
    return {};
  }
  *way = {!is_beside, is_beside, std::move(best.extras)};
  return std::move(best.fit);
}

/// Does a fit hold bodies that cannot be?
bool has_regression(const Fit& fit) {
  return std::any_of(fit.chosen.begin(), fit.chosen.end(),
                     [](const Chosen& each) { return each.hypothesis.is_regression; });
}

}  // namespace

bool is_better_beside(const Observations& observations, const Fit& alone, const Fit& beside) {
  if (beside.chosen.empty() || alone.chosen.empty()) {
    return !beside.chosen.empty();
  }
  const bool stands_in = has_regression(alone) && !has_regression(beside);
  return predicts_better(observations, alone, beside) ||
         (stands_in && !predicts_better(observations, beside, alone));
}

bool are_many(const Inquiry& inquiry, const Fit& found) {
  const auto count =
      std::count_if(found.chosen.begin(), found.chosen.end(),
                    [&](const Chosen& each) { return is_number_of_family(inquiry, each); });
  return static_cast<std::size_t>(count) >= kMany;
}

namespace {

/// A dictionary over another noise, `factors` times as large.
Dictionary over_noise(Dictionary dictionary, const Eigen::VectorXd& factors, Eigen::Index train) {
  dictionary.columns = factors.cwiseInverse().asDiagonal() * dictionary.columns;
  const auto to_fit = dictionary.columns.topRows(train);
  dictionary.gram = to_fit.transpose() * to_fit;
  return dictionary;
}

void refit_in(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses, Way* way,
              Diagnosis* diagnosis) {
  const Observations& observations = inquiry.observations;
  const Dictionary& dictionary = inquiry.dictionary;
  const bool is_begun = !diagnosis->choice.begun.chosen.empty();
  const Fit& found = is_begun ? diagnosis->choice.begun : diagnosis->choice.fit;
  const Fit base = base_of(inquiry, found);
  if (is_begun || are_many(inquiry, found)) {
    take_members(inquiry, together(inquiry, base, found, hypotheses, way), 0, diagnosis);
  }
  if (diagnosis->is_weighed_whole || diagnosis->verdict == Verdict::explained) {
    return;
  }
  const std::size_t findings = diagnosis->choice.findings.size();
  diagnosis->retuned = retune(observations, diagnosis->choice.fit, hypotheses, dictionary);
  take_members(inquiry, Fit(diagnosis->retuned), findings, diagnosis);
  if (findings > 0) {
    const Fit afresh = retune_whole(observations, base, hypotheses, dictionary).fit;
    if (!afresh.chosen.empty() && predicts_better(observations, diagnosis->updated(), afresh)) {
      take_members(inquiry, afresh, diagnosis->choice.findings.size(), diagnosis);
    }
  }
}

/// Refits where what is left of each component counts for noise: `factors` times its noise.
Diagnosis refit_over(const Eigen::VectorXd& factors, const Inquiry& inquiry,
                     const std::vector<Hypothesis>& hypotheses, Way* way, Diagnosis diagnosis) {
  const Eigen::Index train = inquiry.observations.train;
  Observations doubtful = inquiry.observations;
  doubtful.add_model_error(factors);
  const Dictionary dictionary = over_noise(inquiry.dictionary, factors, train);
  const Fit given = over_noise(inquiry.given, factors, train);
  const auto convert = [train](const Eigen::VectorXd& by, Fit* fit) {
    if (fit->remainder.size() > 0) {
      *fit = over_noise(std::move(*fit), by, train);
    }
  };
  convert(factors, &diagnosis.choice.fit);
  convert(factors, &diagnosis.choice.begun);
  refit_in({doubtful, dictionary, inquiry.false_discovery, given}, hypotheses, way, &diagnosis);
  const Eigen::VectorXd back = factors.cwiseInverse();
  convert(back, &diagnosis.choice.fit);
  convert(back, &diagnosis.choice.begun);
  convert(back, &diagnosis.retuned);
  for (Finding& finding : diagnosis.choice.findings) {
    if (diagnosis.is_weighed_whole) {  // those before were weighed over the noise itself
      convert(back, &finding.without);
    }
  }
  return diagnosis;
}

}  // namespace

void refit(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses, const TellStage& tell,
           Diagnosis* diagnosis) {
  tell("fitting the machine's numbers together");
  const Observations& observations = inquiry.observations;
  const Eigen::VectorXd expected = least_model_error(inquiry, hypotheses);
  Way way;
  Diagnosis first = refit_over(expected, inquiry, hypotheses, &way, *diagnosis);
  const Eigen::VectorXd found =
      model_error(observations, first.updated().remainder.head(observations.train));
  // A coupled drive or a delay is no number, so that less is left than was thought.
  if (first.verdict != Verdict::explained && (found.array() < kMuchLess * expected.array()).any()) {
    tell("fitting the machine's numbers again, over what they left");
    Diagnosis second = refit_over(found, inquiry, hypotheses, &way, *diagnosis);
    if (!predicts_better(observations, second.updated(), first.updated())) {
      first = std::move(second);
    }
  }
  *diagnosis = std::move(first);
}

}  // namespace flexcomp::diagnosis
