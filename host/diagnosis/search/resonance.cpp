#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/search/search.hpp"
#include "effects/inertia.hpp"
#include "simulation/history.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Frequency of a mode at every row of every scene, over a typical one.
using Courses = std::vector<Eigen::VectorXd>;

/// Fall of a residual's squares by a vibration; below zero where it adds to them.
double explained(const std::vector<JointResidual>& residual, const Observations& observations,
                 int joint, const std::vector<Eigen::VectorXd>& frequency, double damping,
                 bool torque) {
  double sum = 0;
  for (std::size_t s = 0; s < residual.size(); ++s) {
    const Prediction& prediction = observations.predictions[s];
    const bool by_motion = prediction.dynamic_load.cols() > 0 &&
                           (torque || !observations.has(simulation::tcp_position));
    const Eigen::VectorXd load =
        (by_motion ? prediction.dynamic_load : prediction.load).col(joint - 1);
    const double scale = torque ? -1 : observations.simulations[s].joint_compliance[joint - 1];
    const Eigen::VectorXd wave =
        scale * (simulation::mode(observations.scenes[s].time, load, frequency[s], damping) - load);
    sum += 2 * wave.dot(residual[s].product) - wave.cwiseAbs2().dot(residual[s].weight);
  }
  return sum;
}

/// Mean frequency and damping whose vibration explains most, of a grid; the best three.
std::vector<Values> resonant_modes(const Observations& observations,
                                   const Eigen::VectorXd& unexplained, int joint,
                                   const Courses& courses) {
  const Eigen::VectorXd& time = observations.scenes.front().time;
  const double rate =
      static_cast<double>(time.size() - 1) / std::max(time[time.size() - 1] - time[0], 1e-9);
  const std::vector<JointResidual> angle = observations.angle_residual(joint, unexplained);
  const std::vector<JointResidual> torque = observations.torque_residual(joint, unexplained);
  std::vector<std::pair<double, Values>> found;
  for (double frequency = 1.5; frequency < std::min(0.35 * rate, 120.0); frequency *= 1.03) {
    Courses frequencies = courses;
    for (Eigen::VectorXd& each : frequencies) {
      each *= frequency;
    }
    for (const double damping : {0.01, 0.04}) {
      double sum = 0;
      if (sees_angles(observations)) {
        sum += explained(angle, observations, joint, frequencies, damping, false);
      }
      if (observations.has(simulation::joint_torque)) {
        sum += explained(torque, observations, joint, frequencies, damping, true);
      }
      found.push_back({-sum, {frequency, damping}});
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Values> starts;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, found.size()); ++i) {
    if (found[i].first < 0) {
      starts.push_back(found[i].second);
    }
  }
  return starts;
}

/// Inertia (kg·m²) that a joint carries along the recordings.
struct CarriedInertia {
  Courses course;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;

  double typical() const { return std::sqrt(least * most); }
};

CarriedInertia inertia_along(const Observations& observations, int joint) {
  CarriedInertia inertia;
  for (const Scene& scene : observations.scenes) {
    inertia.course.push_back(effects::carried_inertia(observations.machine.robot, scene, joint));
    inertia.least = std::min(inertia.least, inertia.course.back().minCoeff());
    inertia.most = std::max(inertia.most, inertia.course.back().maxCoeff());
  }
  return inertia;
}

/// Stiffness (N·m/rad) by which a typical inertia vibrates at a frequency (Hz).
double stiffness(double typical, double hertz) { return typical * std::pow(2 * M_PI * hertz, 2); }

bool is_by_posture(const Hypothesis& hypothesis) { return hypothesis.law->form == "posture"; }

std::vector<Values> seek_resonance(const Observations& observations,
                                   const Eigen::VectorXd& unexplained,
                                   const Hypothesis& hypothesis) {
  if (!is_by_posture(hypothesis)) {
    Courses constant;
    for (const Scene& scene : observations.scenes) {
      constant.emplace_back(Eigen::VectorXd::Ones(scene.rows()));
    }
    return resonant_modes(observations, unexplained, hypothesis.joint, constant);
  }
  CarriedInertia inertia = inertia_along(observations, hypothesis.joint);
  const double typical = inertia.typical();
  for (Eigen::VectorXd& each : inertia.course) {
    each = (typical / each.array()).sqrt().eval();
  }
  std::vector<Values> starts =
      resonant_modes(observations, unexplained, hypothesis.joint, inertia.course);
  for (Values& start : starts) {
    start[0] = stiffness(typical, start[0]);
  }
  return starts;
}

/// Needs motion or changing loads, sampled several times a period; by posture, an inertia that is
/// known and changes along the recordings.
bool prepare_resonance(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kLeastChange = 0.02;  // of the inertia: the frequency moves by half of it, 1 %
  const Bounds damping{1e-3, 0.5, 0.01};
  if (observations.is_static) {
    return false;
  }
  if (!is_by_posture(*hypothesis)) {
    hypothesis->set_bounds({{0.5, 300, 0.1}, damping});
    return true;
  }
  const CarriedInertia inertia = inertia_along(observations, hypothesis->joint);
  if (!(inertia.least > 0) || inertia.most < (1 + kLeastChange) * inertia.least) {
    return false;
  }
  const double typical = inertia.typical();
  hypothesis->set_bounds(
      {{stiffness(typical, 0.5), stiffness(typical, 300), 0.04 * stiffness(typical, 4)}, damping});
  return true;
}

}  // namespace

Search search::resonance() { return {prepare_resonance, seek_resonance}; }

}  // namespace flexcomp::diagnosis
