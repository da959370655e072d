#pragma once

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// Judges what was chosen: sets groups that cannot be told apart, the verdict and its reason.
///
/// Findings are withdrawn where large effects only cancel each other, or where a form without
/// physics (a jump, a sum of terms) accounts for far more by as few numbers.
void judge(const Observations& observations, Diagnosis* diagnosis);

/// A diagnosis with another choice in the place of its own, judged.
Diagnosis with_choice(const Observations& observations, Diagnosis diagnosis, Choice choice);

/// Takes all findings back.
void withdraw(const Observations& observations, const std::string& reason, Diagnosis* diagnosis);

/// Is something left that no finding accounts for?
bool is_open(const Diagnosis& diagnosis);

}  // namespace flexcomp::diagnosis
