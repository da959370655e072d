#pragma once

#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// One component of a channel, and by how much it is off at most (SI).
struct Excursion {
  Channel channel;
  Eigen::Index component;
  double most = 0;
};

/// Something that happened once and passed, as a bump: rows of a scene in which far more than noise
/// is left, though little is elsewhere.
struct Event {
  std::size_t scene = 0;
  Part rows{};                        ///< of the scene
  double begin = 0, end = 0;          ///< s, of the recording
  std::vector<Excursion> excursions;  ///< the largest over its noise first
};

/// The events of which what is left of motions consists but for noise; none where it is elsewhere
/// as well, or where it lasts too long to have passed.
std::vector<Event> find_events(const Observations& observations, const Eigen::VectorXd& remainder);

}  // namespace flexcomp::diagnosis
