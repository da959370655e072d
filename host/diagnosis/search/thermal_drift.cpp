#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, or for a joint's zero whatever shows its angle. Time stands in for the
/// temperature where none was recorded. The growth of each link by itself takes more than the few
/// poses of a load test: with three numbers a link nothing would be left to tell the noise by.
bool prepare_thermal_drift(const Observations& observations, Hypothesis* hypothesis) {
  const Scene& first = observations.scenes.front();
  const bool has_temperature = first.temperature.size() > 0;
  const bool is_of_zero = hypothesis->parameters.front().name == "zero";
  const bool is_of_link = hypothesis->joint > 0 && !is_of_zero;
  const bool is_share = hypothesis->parameters.front().name == "growth";
  const bool shows =
      is_of_zero ? sees_angles(observations) : observations.has(simulation::tcp_position);
  if (!shows || (is_of_link && observations.is_static) ||
      hypothesis->law->traits.needs_temperature != has_temperature) {
    return false;
  }
  const double step = (has_temperature ? 1e-5 : 1e-4) * (is_of_zero || is_share ? 0.1 : 1);
  std::vector<Bounds> bounds(hypothesis->linear, {-0.1, 0.1, step});
  if (!has_temperature) {
    constexpr double kQuickest = 10;  // s, in which anything of an arm warms
    const double duration = first.time[first.rows() - 1] - first.time[0];
    bounds.push_back({0.02 * duration, 20 * std::max(duration, kQuickest), 0.05 * duration});
    hypothesis->starts.clear();
    for (const double share : {0.2, 0.4, 0.8, 1.6, 5.0}) {
      hypothesis->starts.push_back({std::max(share * duration, kQuickest)});
    }
  }
  hypothesis->set_bounds(bounds);
  return true;
}

}  // namespace

Search search::thermal_drift() {
  return {prepare_thermal_drift,
          nullptr,
          {{{PlaceKind::tcp_base, PlaceKind::tcp_tool},
            "",
            {SignalKind::temperature, SignalKind::time},
            {"line"}},
           {{PlaceKind::tcp_base, PlaceKind::tcp_tool}, "", {SignalKind::time}, {"approach"}}}};
}

}  // namespace flexcomp::diagnosis
