#pragma once

#include <utility>

#include "diagnosis/search/hypothesis.hpp"
#include "effects/law_place.hpp"
#include "effects/signals.hpp"

namespace flexcomp::diagnosis {

using effects::PlaceKind;
using effects::SignalKind;

/// Laws that an effect has a name for, as composed laws are written (grammar/).
struct Known {
  std::vector<PlaceKind> places;
  const char* factor;  ///< that the law begins with, such as sign(v; empty: it has none
  std::vector<SignalKind> drivers;  ///< of the joint, or component, that it acts at
  std::vector<std::string> shapes;  ///< by their names (grammar/shape.cpp)
};

/// How the laws of one effect are looked for in observations.
struct Search {
  /// Sets where the parameters of a law at a joint are sought, and the starts that are the same
  /// whatever the residual; false where it could not show.
  bool (*prepare)(const Observations&, Hypothesis*);
  Seek seek = nullptr;  ///< starts by the residual
  // NOLINTNEXTLINE(readability-redundant-member-init): a search without may leave it out
  std::vector<Known> known = {};  ///< no such law is composed where the effect is sought
  // NOLINTNEXTLINE(readability-redundant-member-init): the same
  std::vector<PlaceKind> constant_at = {};  ///< it does there what the constant of a law does
};

namespace search {

#define FLEXCOMP_EFFECT(name) Search name();
#include "effects/catalogue.inc"
#undef FLEXCOMP_EFFECT

}  // namespace search

/// The search for each effect of the catalogue, by the effect's name.
const std::vector<std::pair<std::string, Search>>& searches();

/// Can wind-up and position errors of the joints be seen, at the TCP or by link encoders?
bool sees_angles(const Observations& observations);

/// Are torques measured of a robot that moves?
bool sees_moving_torques(const Observations& observations);

/// Does a wrench or the robot's weight load its springs?
bool is_loaded(const Observations& observations);

/// A torque (N·m) of a joint that matters: a fiftieth of the largest, at least `least`.
double torque_step(const Observations& observations, int joint, double least = 0.01);

/// Each share of a size as a start of one parameter.
std::vector<Values> starts_at(const std::vector<double>& shares, double size);

/// Orders (periods a turn) whose sinusoids of a joint's angle explain most of a residual, the best
/// first; none where fewer than two periods of any would be seen.
std::vector<Values> ripple_orders(const Observations& observations, int joint,
                                  const std::vector<JointResidual>& residual);

}  // namespace flexcomp::diagnosis
