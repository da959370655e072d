#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

bool has_group(const Observations& observations, const std::string& group) {
  if (group == "wrench") {
    return observations.has_wrench();
  }
  const auto* const channel =
      std::find(simulation::kChannels.begin(), simulation::kChannels.end(), group);
  return observations.has(static_cast<Channel>(channel - simulation::kChannels.begin()));
}

/// Needs motion or, for the wrench, a changing load.
bool prepare_time_offset(const Observations& observations, Hypothesis* hypothesis) {
  if (observations.is_static || !has_group(observations, hypothesis->law->form)) {
    return false;
  }
  hypothesis->set_bounds({{-0.5, 0.5, 1e-3}});
  if (hypothesis->linear == 0) {
    hypothesis->starts.clear();
    for (double delay = 1e-3; delay < 0.1; delay *= 1.35) {
      hypothesis->starts.push_back({delay});
      hypothesis->starts.push_back({-delay});
    }
  }
  return true;
}

}  // namespace

Search search::time_offset() { return {prepare_time_offset}; }

}  // namespace flexcomp::diagnosis
