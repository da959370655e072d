#include "diagnosis/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kUseless = 0.5;   // of a joint's compliance: not even a guess
constexpr double kBlurred = 2e-3;  // rad, beyond any error of an encoder's zero
constexpr double kSureSpeed = 4;   // deviations: noise alone reverses in one of 16,000 rows
constexpr double kUnknownSize = std::numeric_limits<double>::infinity();

int reversals_of(const Observations& observations, int joint) {
  int count = 0;
  for (const Scene& scene : observations.scenes) {
    int direction = 0;
    for (Eigen::Index row = 0; row < scene.rows() && !scene.is_static; ++row) {
      const double speed = scene.velocity(row, joint - 1);
      const bool is_noise = std::abs(speed) < kSureSpeed * scene.velocity_noise[joint - 1];
      const int now = is_noise ? 0 : simulation::direction_of_motion(speed);
      count += now * direction < 0 ? 1 : 0;
      direction = now != 0 ? now : direction;
    }
  }
  return count;
}

/// Half-width of the 95 % interval of the first parameter that measures a property of a joint.
double resolution(const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                  effects::Measures property, int joint) {
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = hypotheses[entry.hypothesis];
    if (hypothesis.traits().measures == property && hypothesis.joint == joint) {
      return kTold / std::sqrt(dictionary.gram(entry.first, entry.first));
    }
  }
  return kUnknownSize;
}

}  // namespace

bool Excitation::tells_nothing() const {
  return !(stiffness < kUseless) && !(zero < kBlurred) && !shows_friction();
}

/// A joint that bears nothing by its model shows friction by the torque that was measured.
bool Excitation::shows_friction() const {
  return friction < std::max(largest_load, largest_torque);
}

std::vector<Excitation> excitation(const Observations& observations,
                                   const std::vector<Hypothesis>& hypotheses,
                                   const Dictionary& dictionary) {
  std::vector<Excitation> all;
  for (int joint = 1; joint <= observations.machine.robot.joints(); ++joint) {
    const auto of = [&](effects::Measures property) {
      return observations.noise_is_known ? resolution(hypotheses, dictionary, property, joint)
                                         : kUnknownSize;
    };
    const double compliance =
        observations.machine.robot.elastic.joints[static_cast<std::size_t>(joint - 1)].compliance;
    all.push_back({joint, observations.range(joint), observations.largest_speed(joint),
                   observations.largest_load(joint), observations.largest_torque(joint),
                   reversals_of(observations, joint),
                   compliance > 0 ? of(effects::Measures::stiffness) / compliance : kUnknownSize,
                   of(effects::Measures::zero), of(effects::Measures::friction),
                   observations.machine.robot.elastic.joint(joint - 1).slides()});
  }
  return all;
}

std::string verdict(const Excitation& excitation) {
  if (excitation.tells_nothing()) {
    const bool shows = std::isfinite(excitation.stiffness) || std::isfinite(excitation.zero) ||
                       std::isfinite(excitation.friction);
    return shows ? "nothing: what it does is lost in the noise"
                 : "nothing: none of its errors would show in what was measured";
  }
  std::string clause;
  const auto add = [&](const std::string& what) { clause += (clause.empty() ? "" : ", ") + what; };
  if (excitation.stiffness < kUseless) {
    add(fmt::format("stiffness to {:.2g} %", 100 * excitation.stiffness));
  }
  if (excitation.zero < kBlurred) {
    add("zero to " + readable(excitation.zero, excitation.slides ? "m" : "rad"));
  }
  if (excitation.shows_friction()) {
    add("friction to " + readable(excitation.friction, excitation.slides ? "N" : "N·m"));
  }
  if (excitation.largest_speed > 0) {
    add(excitation.reversals > 0
            ? fmt::format("{} reversal{} of its motion", excitation.reversals,
                          excitation.reversals > 1 ? "s" : "")
            : "no reversal of its motion, so play and hysteresis of motion cannot show");
  }
  return clause;
}

}  // namespace flexcomp::diagnosis
