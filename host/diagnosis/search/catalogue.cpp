#include <algorithm>

#include "diagnosis/plausible.hpp"
#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kWholeMachine = 0;

const Search& search_of(const std::string& effect) {
  return std::find_if(searches().begin(), searches().end(),
                      [&](const auto& each) { return each.first == effect; })
      ->second;
}

bool acts_at(const effects::Law& law, const model::Robot& robot, int joint) {
  const std::vector<int> places = law.joints(robot.joints());
  return std::find(places.begin(), places.end(), joint) != places.end() &&
         (!law.impossible || law.impossible(robot, joint).empty());
}

}  // namespace

const std::vector<std::pair<std::string, Search>>& searches() {
  static const std::vector<std::pair<std::string, Search>> kSearches = {
#define FLEXCOMP_EFFECT(name) {#name, search::name()},
#include "effects/catalogue.inc"
#undef FLEXCOMP_EFFECT
  };
  return kSearches;
}

std::vector<Hypothesis> all_hypotheses(const Observations& observations) {
  const model::Robot& robot = observations.machine.robot;
  const MachineSize size = size_of(observations);
  std::vector<Hypothesis> all;
  for (const effects::Effect& effect : effects::catalogue()) {
    const Search& search = search_of(effect.name);
    for (int joint = kWholeMachine; joint <= robot.joints(); ++joint) {
      for (const effects::LawPointer& law : effect.forms) {
        if (!acts_at(*law, robot, joint)) {
          continue;
        }
        Hypothesis hypothesis(law, joint, robot);
        if (!search.prepare(observations, &hypothesis)) {
          continue;
        }
        if (search.seek != nullptr) {
          hypothesis.seek = search.seek;
          hypothesis.starts = search.seek(observations, observations.residual, hypothesis);
        }
        keep_plausible(robot, size, &hypothesis);
        all.push_back(std::move(hypothesis));
      }
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
