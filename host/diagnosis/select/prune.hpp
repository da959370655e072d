#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// Judges every choice of a fit, and drops those that do not stand beside the others, one at a
/// time: first the ones that cannot be, then the weakest.
Selection prune(const Inquiry& inquiry, Fit fit);

/// The findings that are left where some prove nothing.
struct Proved {
  Selection selection;
  std::vector<Chosen> withdrawn;  ///< held, but leave most of the mismatch there standing
  double explained = 0;           ///< most of the power there that was accounted for
  bool mispredicts = false;       ///< some came near the noise there, but not of what was held out
};

/// Withdraws findings until all that are left are proved. A finding is withdrawn if it leaves most
/// of the mismatch where it shows; if it shows where several fail together on what was held out;
/// and if it shows where others were withdrawn, unless it comes near the noise by itself.
Proved prove(const Inquiry& inquiry, Selection selection);

}  // namespace flexcomp::diagnosis
