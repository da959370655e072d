#include "diagnosis/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kWidth = 1.96;    // 95 % of a normal distribution
constexpr double kUseless = 0.5;   // of a joint's compliance: not even a guess
constexpr double kBlurred = 2e-3;  // rad, beyond any error of an encoder's zero
constexpr double kUnknownSize = std::numeric_limits<double>::infinity();

int reversals_of(const Observations& observations, int joint) {
  int count = 0;
  for (const Scene& scene : observations.scenes) {
    int direction = 0;
    for (Eigen::Index row = 0; row < scene.rows() && !scene.is_static; ++row) {
      const int now = simulation::direction_of_motion(scene.velocity(row, joint - 1));
      count += now * direction < 0 ? 1 : 0;
      direction = now != 0 ? now : direction;
    }
  }
  return count;
}

/// Of the first parameter of an effect at a joint.
double resolution(const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                  const char* effect, int joint) {
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = hypotheses[entry.hypothesis];
    if (hypothesis.effect == effect && hypothesis.joint == joint) {
      return kWidth / std::sqrt(dictionary.gram(entry.first, entry.first));
    }
  }
  return kUnknownSize;
}

}  // namespace

bool Excitation::tells_nothing() const {
  return !(stiffness < kUseless) && !(zero < kBlurred) && !std::isfinite(friction);
}

std::vector<Excitation> excitation(const Observations& observations,
                                   const std::vector<Hypothesis>& hypotheses,
                                   const Dictionary& dictionary) {
  std::vector<Excitation> all;
  for (int joint = 1; joint <= 6; ++joint) {
    const auto of = [&](const char* effect) {
      return resolution(hypotheses, dictionary, effect, joint);
    };
    const double compliance =
        observations.machine.robot.elastic.joints[static_cast<std::size_t>(joint - 1)].compliance;
    all.push_back({joint, observations.range(joint), observations.largest_speed(joint),
                   observations.largest_load(joint), reversals_of(observations, joint),
                   compliance > 0 ? of("joint_stiffness") / compliance : kUnknownSize,
                   of("joint_offset"), of("coulomb_friction")});
  }
  return all;
}

std::string verdict(const Excitation& excitation) {
  if (excitation.tells_nothing()) {
    return excitation.largest_speed > 0 ? "nothing: what it does is lost in the noise"
                                        : "nothing: it bears too little load and does not move";
  }
  std::string clause;
  const auto add = [&](const std::string& what) { clause += (clause.empty() ? "" : ", ") + what; };
  if (excitation.stiffness < kUseless) {
    add(fmt::format("stiffness to {:.2g} %", 100 * excitation.stiffness));
  }
  if (excitation.zero < kBlurred) {
    add("zero to " + readable(excitation.zero, "rad"));
  }
  if (std::isfinite(excitation.friction)) {
    add("friction to " + readable(excitation.friction, "N·m"));
  }
  if (excitation.largest_speed > 0) {
    add(excitation.reversals > 0
            ? fmt::format("{} reversals of its motion", excitation.reversals)
            : "no reversal of its motion, so play and hysteresis of motion cannot show");
  }
  return clause;
}

}  // namespace flexcomp::diagnosis
