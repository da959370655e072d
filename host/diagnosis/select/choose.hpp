#pragma once

#include "diagnosis/select/grow.hpp"

namespace flexcomp::diagnosis {

/// The findings, and the candidates beside them.
struct Choice {
  std::vector<Ranked> ranking;    ///< of all effects at all places before any is chosen, best first
  std::vector<Finding> findings;  ///< the strongest first
  Fit fit;                        ///< of all findings
  /// The fit at which growth ended because a machine's numbers together account for more than
  /// another finding could; nothing chosen where it ended otherwise.
  Fit begun;
  /// Hypotheses that stood each beside the others, but together left most of the mismatch.
  std::vector<Chosen> withdrawn;
  double explained = 0;      ///< most of the power there that was accounted for
  bool mispredicts = false;  ///< some came near the noise there, but not of what was held out
};

/// Chooses what explains the residual.
///
/// 1. Grow: the hypothesis with the largest gain in BIC is added, after a fit of all chosen; where
///    it fails on what was held out, the next best. Then each choice is tried against all
///    others anew. Starts that are sought in the residual are sought anew after every step.
///    Growth ends where a machine's numbers together account for more than a finding could.
/// 2. Pairs: what grows from two hypotheses is taken if it is better, since a third may look better
///    than either of the two alone.
/// 3. Prune: what no longer stands beside the others is dropped, and findings that account for too
///    little of the mismatch where they show, or fail together on what was held out, are withdrawn.
/// 4. Simplify: a plainer finding takes the place of what the evidence does not prefer to it.
/// 5. Doubt: a finding whose interval holds nothing goes, the weakest first, and 3 and 4 are done
/// again.
///
/// A hypothesis holds if its gain is strong, its chance (times the hypotheses looked at) is below
/// `false_discovery`, what was held out confirms it, it can be (plausible.hpp), and it is large
/// enough; select/standards.hpp says by how much.
Choice choose(const Inquiry& inquiry, const TellStage& tell);

/// Prunes, simplifies and doubts (3 to 5) what has grown.
Choice conclude(const Inquiry& inquiry, const Attempt& grown);

}  // namespace flexcomp::diagnosis
