#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// The numbers of a fit that stand by their own evidence beside all others, each judged as a
/// finding; the strongest first. The forms of a joint's friction of which none stands beside the
/// others are judged together.
///
/// A machine that is a little off in many places shows no single cause that accounts for most of
/// the mismatch; its numbers stand together then, or not at all. So none stands unless they account
/// for enough of the mismatch (kLeastByFamilies) in what was fitted to and in what was held out,
/// and are several: one or two causes are the search's business.
std::vector<Finding> members_that_stand(const Inquiry& inquiry, const Fit& whole);

}  // namespace flexcomp::diagnosis
