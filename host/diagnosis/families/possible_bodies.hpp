#pragma once

#include <optional>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A fit's choices without those that cannot be; the first `given` stay in any case. A body that
/// cannot be stays while `holds_bodies`, held more firmly to the model's. Nothing where all can be.
std::optional<std::vector<Chosen>> without_impossible(const Observations& observations,
                                                      const Fit& fit, std::size_t given,
                                                      bool holds_bodies);

/// Are all bodies of a fit that have an edge within what they can be?
bool bodies_can_be(const Observations& observations, const Fit& fit);

/// The numbers of a fit, moved so that its bodies can be, at the least cost.
///
/// Torques are linear in masses, first moments and inertias, so the derivative of the fit tells
/// what a move costs and nothing is simulated. The edges of the bodies are drawn tighter until all
/// of them are inside; the other numbers give way. The tighter edges stay with the hypotheses, so
/// that a fit by simulation from there on stays inside too.
std::vector<Chosen> with_possible_bodies(const Observations& observations, const Fit& fit);

}  // namespace flexcomp::diagnosis
