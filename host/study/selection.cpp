#include "study/selection.hpp"

namespace flexcomp::study {

double circularity_at(const Candidate& candidate, double force) {
  return candidate.circularity * force / candidate.at_force;
}

bool suits(const Candidate& candidate, double force, double circularity,
           const Tolerance& tolerance) {
  return circularity_at(candidate, force) <= (1 + tolerance.circularity) * circularity &&
         force <= (1 + tolerance.load) * candidate.largest_load;
}

}  // namespace flexcomp::study
