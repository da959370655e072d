#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// Judges every choice of a fit, and drops those that do not stand beside the others: what cannot
/// be first, then the weakest, one at a time.
Selection prune(const Inquiry& inquiry, Fit fit);

/// The findings that are left where some prove nothing.
struct Proved {
  Selection selection;
  std::vector<Chosen> withdrawn;  ///< held, but leave most of the mismatch there standing
  double explained = 0;           ///< most of the power there that was accounted for
  bool mispredicts = false;       ///< some came near the noise there, but not of what was held out
};

/// Withdraws findings until all that is left is proved: what leaves most of the mismatch standing
/// where it shows, several that fail together on what was held out, and what remains where others
/// were withdrawn, unless it comes near the noise by itself.
Proved prove(const Inquiry& inquiry, Selection selection);

}  // namespace flexcomp::diagnosis
