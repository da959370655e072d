#include <algorithm>
#include <functional>
#include <limits>

#include "diagnosis/effects/effects.hpp"
#include "simulation/inverse_dynamics.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Natural frequencies (Hz) of a mode at the rows of a scene.
using Frequencies = std::function<Eigen::VectorXd(const Scene&)>;

/// Inertia (kg·m²) about a joint of all that it carries, at every row; the other joints stand.
Eigen::VectorXd carried_inertia(const model::Robot& robot, const Scene& scene, int joint) {
  model::Robot weightless = robot;
  weightless.elastic.gravity.setZero();
  const JointVector<double, 6> at_rest = JointVector<double, 6>::Zero();
  const JointVector<double, 6> unit = JointVector<double, 6>::Unit(joint - 1);
  Eigen::VectorXd inertia(scene.rows());
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    inertia[row] = simulation::inverse_dynamics(weightless, scene.q.row(row).transpose(), at_rest,
                                                unit)[joint - 1];
  }
  return inertia;
}

Frequencies everywhere(double frequency) {
  return [=](const Scene& scene) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(scene.rows(), frequency);
  };
}

Eigen::VectorXd frequency_of(double stiffness, const Eigen::VectorXd& inertia) {
  return (stiffness / inertia.array()).sqrt() / (2 * M_PI);
}

simulation::Term vibration(int joint, const Frequencies& frequencies, double damping) {
  return {simulation::Term::load,
          [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            if (scene.is_static) {
              return;
            }
            const double compliance = at.joint_compliance[joint - 1];
            const Eigen::VectorXd frequency = frequencies(scene);
            const auto beyond_static = [&](const Eigen::VectorXd& load) {
              return Eigen::VectorXd(simulation::mode(scene.time, load, frequency, damping) - load);
            };
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& load) {
                  return Eigen::VectorXd(compliance * beyond_static(load));
                },
                prediction);
            if (prediction->channel[simulation::joint_torque].cols() > 0) {
              add_torque(joint, -beyond_static(prediction->dynamic_load.col(joint - 1)),
                         prediction);
            }
          }};
}

/// What the whole vibration explains of a residual; less than nothing where it adds to it.
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

/// Relative frequency at every row of every scene.
using Courses = std::vector<Eigen::VectorXd>;

/// Mean frequency and damping whose vibration explains most, of a grid; the best three.
std::vector<Values> resonant_modes(const Observations& observations, int joint,
                                   const Courses& courses) {
  const Eigen::VectorXd& time = observations.scenes.front().time;
  const double rate =
      static_cast<double>(time.size() - 1) / std::max(time[time.size() - 1] - time[0], 1e-9);
  const std::vector<JointResidual> angle = observations.angle_residual(joint);
  const std::vector<JointResidual> torque = observations.torque_residual(joint);
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

Hypothesis constant_mode(const Observations& observations, int joint) {
  Courses constant;
  for (const Scene& scene : observations.scenes) {
    constant.emplace_back(Eigen::VectorXd::Ones(scene.rows()));
  }
  Hypothesis hypothesis;
  hypothesis.effect = "resonance";
  hypothesis.joint = joint;
  hypothesis.parameters = {{"frequency", "Hz", 0.5, 300, 0.1}, {"damping", "1", 1e-3, 0.5, 0.01}};
  hypothesis.linear = 0;
  hypothesis.is_sought = true;
  hypothesis.starts = resonant_modes(observations, joint, constant);
  hypothesis.statement = fmt::format("joint {} vibrates in a lightly damped mode", joint);
  hypothesis.apply = [joint](const Values& values, Machine* machine) {
    machine->terms.push_back(vibration(joint, everywhere(values[0]), values[1]));
  };
  return hypothesis;
}

/// No hypothesis where the inertia is not known, or hardly changes along the recordings.
std::vector<Hypothesis> mode_by_posture(const Observations& observations, int joint) {
  constexpr double kLeastChange = 0.02;
  Courses inertia;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const Scene& scene : observations.scenes) {
    inertia.push_back(carried_inertia(observations.machine.robot, scene, joint));
    least = std::min(least, inertia.back().minCoeff());
    most = std::max(most, inertia.back().maxCoeff());
  }
  if (!(least > 0) || most < (1 + kLeastChange) * least) {
    return {};
  }
  const double typical = std::sqrt(least * most);
  Courses relative = inertia;
  for (Eigen::VectorXd& each : relative) {
    each = (typical / each.array()).sqrt();
  }
  Hypothesis hypothesis;
  hypothesis.effect = "resonance";
  hypothesis.joint = joint;
  hypothesis.form = "posture";
  const auto stiffness = [typical](double hertz) {
    return typical * std::pow(2 * M_PI * hertz, 2);
  };
  hypothesis.parameters = {
      {"stiffness", "N·m/rad", stiffness(0.5), stiffness(300), 0.04 * stiffness(4)},
      {"damping", "1", 1e-3, 0.5, 0.01}};
  hypothesis.linear = 0;
  hypothesis.is_sought = true;
  hypothesis.starts = resonant_modes(observations, joint, relative);
  for (Values& start : hypothesis.starts) {
    start[0] = stiffness(start[0]);
  }
  hypothesis.statement = fmt::format(
      "joint {} vibrates in a lightly damped mode, slower the more inertia it carries", joint);
  hypothesis.apply = [joint](const Values& values, Machine* machine) {
    const model::Robot robot = machine->robot;
    const Frequencies frequencies = [=](const Scene& scene) {
      return frequency_of(values[0], carried_inertia(robot, scene, joint));
    };
    machine->terms.push_back(vibration(joint, frequencies, values[1]));
  };
  return {hypothesis};
}

}  // namespace

// A lightly damped mode of a joint's spring and what it carries: wind-up follows its load as a
// second-order system does, and the drive feels the vibrating torque (Spong 1987). Simulated along
// the load, with one frequency, or with one that follows the inertia that the joint carries in each
// posture. Needs motion or changing loads, sampled several times a period.
std::vector<Hypothesis> resonance(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (observations.is_static) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    all.push_back(constant_mode(observations, joint));
    for (Hypothesis& hypothesis : mode_by_posture(observations, joint)) {
      all.push_back(std::move(hypothesis));
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
