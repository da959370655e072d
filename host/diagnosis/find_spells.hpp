#pragma once

#include "diagnosis/dictionary.hpp"

namespace flexcomp::diagnosis {

/// An entry of a dictionary that accounts for a part of what a fit leaves if it comes and goes.
struct Spelled {
  std::size_t entry = 0;
  Spells spells;
  double gain = 0;  ///< by which the sum of squares falls, less what its moments are worth
};

/// For each entry of a dictionary the spells with which it accounts for most of what is left beside
/// a fit; the best first. Only of those that change while the recordings to fit to are made.
///
/// Two steps are repeated until nothing changes: sizes by least squares for given spells, and for
/// given sizes the spells of which the samples speak (dynamic programming along time). Each
/// beginning and each end must explain 50 squares over the noise. What was held out has no part in
/// the sizes, and has spells of its own.
std::vector<Spelled> find_spells(const Observations& observations, const Dictionary& dictionary,
                                 const Fit& beside);

/// The spells for an effect that changes the samples so, beside what is left without it.
/// `change`: of all samples, over the noise.
Spells spells_of(const Observations& observations, const Eigen::VectorXd& left_without,
                 const Eigen::VectorXd& change);

}  // namespace flexcomp::diagnosis
