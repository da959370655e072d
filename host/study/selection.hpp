#pragma once

#include <string>

namespace flexcomp::study {

/// A robot that is to be chosen or not.
struct Candidate {
  std::string name;
  double circularity = 0;   ///< m, the least anywhere in its workspace, without correction
  double at_force = 0;      ///< N, the force it was found with
  double largest_load = 0;  ///< N, weight of its rated payload; infinite where it is not known
};

/// How much of a shortfall is overlooked.
struct Tolerance {
  double circularity = 0;  ///< part of the limit
  double load = 0;         ///< part of the largest load
};

/// The circularity (m) at a force: the springs are linear.
double circularity_at(const Candidate& candidate, double force);

/// Does a robot mill to a circularity (m) at a force (N) somewhere, and can it bear that force?
/// (Klimchik et al. 2017, table 4.)
bool suits(const Candidate& candidate, double force, double circularity,
           const Tolerance& tolerance = {});

}  // namespace flexcomp::study
