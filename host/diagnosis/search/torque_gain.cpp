#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Sets where a gain by the drive's heat is sought: as large as itself while the drive gives half
/// of its largest torque for long, and soon enough to show.
void seek_by_heat(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kQuickest = 1;  // s, in which a winding warms
  const Scene& first = observations.scenes.front();
  const double duration = std::max(first.time[first.rows() - 1] - first.time[0], kQuickest);
  const double half = std::max(observations.largest_torque(hypothesis->joint), 0.01) / 2;
  const double most = 1 / (half * half);
  hypothesis->set_bounds({{-most, most, 0.01 * most}, {kQuickest, 10 * duration, 0.05 * duration}});
  hypothesis->starts.clear();
  for (const double share : {0.02, 0.05, 0.1, 0.2, 0.4, 1.0}) {
    hypothesis->starts.push_back({std::max(share * duration, kQuickest)});
  }
}

/// Needs torques of a robot that moves, and temperatures for a gain by these.
bool prepare_torque_gain(const Observations& observations, Hypothesis* hypothesis) {
  if (hypothesis->law->form == "heat") {
    seek_by_heat(observations, hypothesis);
    return sees_moving_torques(observations);
  }
  if (!hypothesis->traits().needs_temperature) {
    hypothesis->set_bounds({{-0.5, 1, 0.02}});
    return sees_moving_torques(observations);
  }
  hypothesis->set_bounds({{-0.02, 0.02, 1e-4}});
  return sees_moving_torques(observations) && observations.scenes.front().temperature.size() > 0;
}

}  // namespace

Search search::torque_gain() {
  return {prepare_torque_gain,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::torque}, {"line"}},
           {{PlaceKind::joint_torque}, "tau", {SignalKind::torque}, {"heat"}}}};
}

}  // namespace flexcomp::diagnosis
