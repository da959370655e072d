#pragma once

#include <functional>
#include <memory>

#include "diagnosis/dictionary.hpp"
#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {

struct Alternative {
  std::string effect;
  int joint = 0;
  double delta_bic = 0;  ///< how much worse than the chosen one
  Chosen chosen;
};

/// What was chosen, why, and what else would have done.
struct Finding {
  Evidence evidence;
  Fit without;
  std::vector<Alternative> alternatives;
};

/// How much an effect at a place would explain alone, by its linear part.
struct Ranked {
  std::string effect;
  int joint = 0;
  double gain = 0;  ///< in BIC
};

struct Choice {
  std::vector<Ranked> ranking;  ///< of all effects at all places before any is chosen, best first
  /// Hypotheses with starts sought along the way; what was chosen may point to them.
  std::vector<std::shared_ptr<const std::vector<Hypothesis>>> sought;
  Fit fit;
  std::vector<Finding> findings;  ///< in the order of `fit.chosen`, the strongest first
  /// What held beside the others, but with all of them left most of the mismatch there standing.
  std::vector<Chosen> withdrawn;
  double explained = 0;      ///< most of the power there that was accounted for
  bool mispredicts = false;  ///< some came near the noise there, but not of what was held out
};

/// Tells how far it is: done, of how many.
using Tell = std::function<void(std::size_t, std::size_t)>;

/// Chooses what explains the residual: one hypothesis at a time, the one with the largest gain in
/// BIC after a fit of all that are chosen, or, where that fails on what was held out, the next
/// best; then each choice is tried against all others anew, and dropped if it no longer holds. A
/// hypothesis holds if its gain is strong, its chance (times the hypotheses looked at) is below
/// `false_discovery`, what was held out confirms it, and it moves some component by more than a
/// third of its noise; it can be (plausible.hpp); and if, where it shows most, it accounts for a
/// tenth of what was left beyond the noise, for a fiftieth of the whole fit, and takes away what is
/// beyond the noise rather than noise. In the end nine tenths of the mismatch there must be
/// accounted for by all of them together, or four fifths where they leave less than twice the
/// noise, or it is withdrawn; and so are several that come near the noise there together, but fail
/// on what was held out (of two the weaker), and what remains there then if it leaves more than
/// twice the noise.
///
/// The starts of hypotheses that are sought in the residual are sought anew after every step. In
/// the end the best pairs of hypotheses are tried too: a third may look better than either of the
/// two alone. What grows from a pair that is better is taken; in a load test, whose fits are quick,
/// the best pair grows even if it is not better yet, and is taken if it is in the end. What is
/// plainer takes the place of what the evidence does not prefer to it: one hypothesis of two, or
/// one with fewer parameters.
Choice choose(const Observations* observations, const std::vector<Hypothesis>& hypotheses,
              const Dictionary& dictionary, double false_discovery, const Tell& tell);

}  // namespace flexcomp::diagnosis
