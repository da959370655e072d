#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/grammar/composed.hpp"

namespace flexcomp::diagnosis::grammar {

constexpr std::size_t kMostTerms = 6;  ///< of a law with a second driver: more is no physics

/// Fits every shape to each lead, except shapes that have the name of one of these effects of the
/// catalogue, and second drivers to the best shape of the first leads. Returns the laws that are
/// worth a fit by simulation: of each lead its best at most, and the one that predicts best. First
/// come those that are proved, the best first: a richer law stands before a simpler one only if it
/// predicts better in most of the halves. Then come those of the others that predict best. After
/// each stands its twin, before each that has a second driver the same without, and before each
/// that bends next to nothing the line.
std::vector<Composed> compose(const Material& material, const std::vector<Lead>& leads,
                              const std::set<std::string>& effects, std::size_t* looked_at);

}  // namespace flexcomp::diagnosis::grammar
