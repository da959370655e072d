#include <algorithm>
#include <limits>
#include <map>

#include "diagnosis/families/candidates.hpp"
#include "diagnosis/families/elimination.hpp"
#include "diagnosis/families/widths.hpp"

// Which of the sets that an elimination comes by predicts best, by which tolerance.
namespace flexcomp::diagnosis {
namespace {

/// Tolerances of each number, in units by which it alone would change as much as is to be
/// explained: the scale of the ridge (Hoerl and Kennard 1970).
constexpr double kTolerances[] = {0.1, 0.3, 1, 3, 10, 30};
constexpr double kNoTolerance = 1e6;  // such units hold nothing
/// A smaller set, or a tighter tolerance, is taken where it predicts worse by less than this:
/// simplicity against error.
constexpr double kSameError = 1.0002;
constexpr double kClearlyLess = 0.95;  // of squares, that numbers of other sizes are worth

/// Is an error the least one, but for what simplicity is worth? Of samples that leave none, and of
/// those that no error can be computed of, every set is as good as any.
bool is_as_good(double error, double least) { return !(error > kSameError * least); }

}  // namespace

/// Leaves out members one at a time; the smallest of the sets that predict best.
Elimination::Set Elimination::best_on_path() {
  Set best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> members = all_members();
  solve(members);
  parts_ = weighted_parts();
  const Eigen::VectorXd wide = widenings();
  while (true) {
    hold_impossible(members);
    const double error = error_elsewhere(members);
    least = std::min(least, error);
    if (is_as_good(error, least)) {
      best = {members, is_held_, tolerance_, widest_, error};
    }
    const std::vector<std::size_t> weakest = weakest_of(members, wide);
    if (weakest.empty()) {
      return best;
    }
    members.erase(std::remove_if(members.begin(), members.end(),
                                 [&](std::size_t member) {
                                   return std::count(weakest.begin(), weakest.end(), member) > 0;
                                 }),
                  members.end());
  }
}

/// Learns how large the numbers of each kind are from what all of them together leave. It hangs
/// together over time, so that it tells less of them than its samples are many.
void Elimination::learn_widths() {
  tolerance_ = kNoTolerance;
  solve(all_members());
  std::map<std::string, std::size_t> kinds;
  std::vector<std::size_t> kind;
  std::vector<Eigen::Index> columns;
  for (const Member& member : members_) {
    for (std::size_t i = 0; i < member.columns.size() && !member.is_given; ++i) {
      kind.push_back(
          kinds.emplace(kind_of(member.chosen.hypothesis, i), kinds.size()).first->second);
      columns.push_back(member.columns[i]);
    }
  }
  if (columns.empty()) {
    return;  // where no number could matter, as of positions in mm, there are no widths
  }
  const double variance = spread_ * spread_ * widenings()(columns).mean();
  widest_(columns) = diagnosis::learn_widths({gram_(columns, columns), moment_(columns), variance},
                                             widest_(columns), kind);
}

/// The best set, with the widths in use, by the tightest tolerance that predicts as well as any.
Elimination::Set Elimination::best_of_tolerances() {
  std::vector<Set> sets;
  for (const double tolerance : kTolerances) {
    tolerance_ = tolerance;
    std::fill(is_held_.begin(), is_held_.end(), false);
    begin_anew();
    sets.push_back(best_on_path());
  }
  const auto is_less = [](const Set& a, const Set& b) { return a.error < b.error; };
  const double least = std::min_element(sets.begin(), sets.end(), is_less)->error;
  return *std::find_if(sets.begin(), sets.end(),
                       [&](const Set& set) { return is_as_good(set.error, least); });
}

/// By learnt widths, unless the usual ones predict clearly better, as where one of a few poses'
/// numbers is far larger than its like.
Elimination::Set Elimination::best_set() {
  if (observations_.has(simulation::joint_torque)) {
    return best_of_tolerances();
  }
  const Set wide = best_of_tolerances();
  learn_widths();
  Set learnt = best_of_tolerances();
  return wide.error < kClearlyLess * learnt.error ? wide : learnt;
}

Eigen::VectorXd Elimination::fullest_remainder() {
  constexpr double kUsual = 3;  // of kTolerances
  tolerance_ = kUsual;
  solve(all_members());
  return remainder_;
}

std::vector<Chosen> Elimination::best() { return chosen_of(best_set()); }

double Elimination::least_error() { return best_set().error; }

}  // namespace flexcomp::diagnosis
