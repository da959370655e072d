#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/grammar/budget.hpp"
#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis::grammar {

/// What is added first: whatever accounts for more, or a law, even where an effect of the catalogue
/// accounts for more. An effect may take a part of what two causes do, and leave of the other what
/// no law is.
enum class First { any, law };

/// Explains what a fit leaves by laws that nobody listed, and by effects of the catalogue beside
/// them.
///
/// Adds the one that accounts for more, one at a time, as long as it holds. A law must be far
/// better than the best effect of the catalogue. In the end all are judged as every finding is, and
/// an effect that does as well as a law takes its place.
///
/// What was sought beside a fit is not sought beside it again: choices made anew often come to
/// nothing else, and a search that begins otherwise to the same fit.
class LawSearch {
 public:
  /// `inquiry` and `budget` must outlive it. Once the budget is spent nothing more is begun.
  LawSearch(const Inquiry& inquiry, Budget* budget, TellStage tell);

  /// There are no findings unless a law is among them.
  Choice choose(const Fit& begun, First first);

 private:
  /// A fit with one law more that holds, nothing chosen where there is none; and the effect of the
  /// catalogue that the law's constant, or its factor with a constant in the place of the shape, is
  /// by itself; empty where it has none.
  struct WithLaw {
    Fit fit;
    std::string constant;
  };
  /// What was found beside fits, each told by its choices.
  template <typename Found>
  using Memory = std::vector<std::pair<std::vector<Chosen>, Found>>;
  /// Is a choice to be made anew?
  using IsDue = std::function<bool(const Fit& fit, std::size_t index)>;

  const WithLaw& with_law(const Fit& before);
  WithLaw new_law(const Fit& before) const;
  /// A fit with one law or effect more; nothing chosen where none holds.
  const Fit& with_one(const Fit& before);
  Fit new_one(const Fit& before);
  Fit with_constant(const Attempt& before, const WithLaw& law) const;
  Fit chosen_anew(const Fit& grown, std::size_t index);
  bool choose_anew(Fit* grown, const IsDue& is_due);
  Fit revised(Fit grown);
  Fit without_half_truths(Fit grown);

  const Inquiry& inquiry_;
  Budget* budget_;
  TellStage tell_;
  Material material_;
  Memory<WithLaw> laws_;
  Memory<Fit> ones_;
};

/// Is a law among the findings that nobody listed?
bool has_law(const Choice& choice);

}  // namespace flexcomp::diagnosis::grammar
