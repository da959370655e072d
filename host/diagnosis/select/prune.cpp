#include "diagnosis/select/prune.hpp"

#include <algorithm>
#include <limits>

#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Does a finding fall because all findings that show in its place together fail on what was held
/// out there? A sum of several may fit by accident, a single law hardly: one alone never falls so,
/// and of two only the weaker.
bool falls_with_others(const Inquiry& inquiry, const Selection& selection, std::size_t index) {
  const Evidence& own = selection.findings[index].evidence;
  int others = 0;
  bool is_weakest = true;
  for (std::size_t i = 0; i < selection.findings.size(); ++i) {
    const Evidence& other = selection.findings[i].evidence;
    if (i != index && other.group == own.group) {
      ++others;
      is_weakest = is_weakest && own.delta_bic <= other.delta_bic;
    }
  }
  return (others > 1 || (others == 1 && is_weakest)) &&
         fails_held_out(inquiry.observations, selection.fit.remainder, own.group);
}

bool explains_enough(const Evidence& evidence) {
  return evidence.explained >=
         (evidence.left > kFarFromNoise ? kLeastExplained : kExplainedNearNoise);
}

/// Does a finding far from the noise show where others were withdrawn?
bool is_remnant(const Evidence& evidence, const std::vector<Group>& fallen) {
  return evidence.left > kFarFromNoise &&
         std::any_of(fallen.begin(), fallen.end(),
                     [&](const Group& other) { return are_of_one_place(other, evidence.group); });
}

/// Withdraws the findings that prove nothing, and adds the places where they showed to `fallen`.
/// Returns true where the others must be judged anew, since they may have stood by those.
bool withdraw_unproved(const Inquiry& inquiry, Proved* proved, std::vector<Group>* fallen) {
  const Selection& selection = proved->selection;
  std::vector<Chosen> kept;
  std::vector<Group> falling;
  for (std::size_t i = 0; i < selection.findings.size(); ++i) {
    const Evidence& evidence = selection.findings[i].evidence;
    const bool explains = explains_enough(evidence);
    const bool fails = explains && falls_with_others(inquiry, selection, i);
    proved->explained =
        explains ? proved->explained : std::max(proved->explained, evidence.explained);
    proved->mispredicts = proved->mispredicts || fails;
    if (explains && !fails && !is_remnant(evidence, *fallen)) {
      kept.push_back(selection.findings[i].chosen);
    } else {
      proved->withdrawn.push_back(selection.findings[i].chosen);
      falling.insert(falling.end(), evidence.shows.begin(), evidence.shows.end());
    }
  }
  fallen->insert(fallen->end(), falling.begin(), falling.end());
  if (kept.size() == selection.findings.size()) {
    return false;
  }
  proved->selection = prune(inquiry, fit(inquiry.observations, std::move(kept), kLastSteps));
  return true;
}

}  // namespace

Selection prune(const Inquiry& inquiry, Fit fit) {
  Selection selection{std::move(fit), {}};
  while (true) {
    selection.findings.clear();
    const std::size_t count = selection.fit.chosen.size();
    std::size_t weakest = count;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      selection.findings.push_back(judge(inquiry, selection.fit, i));
      const Evidence& evidence = selection.findings.back().evidence;
      const double worth =
          evidence.impossible.empty() ? evidence.delta_bic : std::numeric_limits<double>::lowest();
      if (!stands(inquiry, evidence) && worth < least) {
        least = worth;
        weakest = i;
      }
    }
    if (weakest == count) {
      return selection;
    }
    selection.fit = fit_without(inquiry, selection.fit, weakest);
  }
}

Proved prove(const Inquiry& inquiry, Selection selection) {
  Proved proved;
  proved.selection = std::move(selection);
  std::vector<Group> fallen;
  while (withdraw_unproved(inquiry, &proved, &fallen)) {
  }
  return proved;
}

}  // namespace flexcomp::diagnosis
