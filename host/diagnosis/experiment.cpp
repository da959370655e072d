#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/parameters.hpp"
#include "diagnosis/select/standards.hpp"
#include "error.hpp"

namespace flexcomp::diagnosis {
namespace {

/// N, the most of a load test: it bends an industrial arm by a millimetre.
constexpr double kMostForce = 1000;
/// Of the largest torque of a drive, by a load test's force: about what an arm's payload asks of
/// it.
constexpr double kShareOfDrive = 0.25;

/// Something that could be recorded, and how a person would be told to.
struct Experiment {
  std::string description;
  recording::Recording recording;
};

/// Where a joint can go; half a turn either way where it turns without end.
std::pair<double, double> range_of(const model::ChainJoint& joint) {
  return joint.type == model::JointType::continuous ? std::pair(-M_PI, M_PI)
                                                    : std::pair(joint.lower, joint.upper);
}

/// The largest force (N, in one digit) along an axis of the base that a load test may have at joint
/// angles: no drive holds more than its share of it, as far as the URDF tells what drives hold.
double force_at(const model::Robot& robot, const model::JointValues& q, Eigen::Index axis) {
  const model::ChainJacobian jacobian =
      geometric_jacobian(robot.elastic, forward_kinematics(robot.elastic, q));
  double force = kMostForce;
  for (Eigen::Index joint = 0; joint < q.size(); ++joint) {
    const double effort = robot.dynamics[static_cast<std::size_t>(joint)].effort;
    const double lever = std::abs(jacobian(axis, joint));
    if (effort > 0 && std::isfinite(effort) && lever > 0) {
      force = std::min(force, kShareOfDrive * effort / lever);
    }
  }
  const double digit = std::pow(10.0, std::floor(std::log10(force)));
  return digit * std::floor(force / digit);
}

/// Poses within the middle of the joint limits, each under a force along and against an axis.
std::vector<Experiment> load_tests(const model::Robot& robot) {
  // To choose from, each simulated: time.
  constexpr int kPoses = 12;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(0.2, 0.8);
  std::vector<Experiment> all;
  for (int pose = 0; pose < kPoses; ++pose) {
    Eigen::RowVectorXd q(robot.elastic.size());
    for (Eigen::Index joint = 0; joint < q.size(); ++joint) {
      const auto [lower, upper] = range_of(robot.elastic.joint(joint));
      q[joint] = lower + within(random) * (upper - lower);
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Experiment experiment;
      recording::Recording& recording = experiment.recording;
      recording.time = Eigen::VectorXd::LinSpaced(4, 0, 3);
      recording.q_meas = recording::Samples(q.replicate(4, 1));
      recording.wrench = recording::Samples(recording::Samples::Zero(4, 6));
      const double force = force_at(robot, q.transpose(), axis);
      recording.wrench->col(axis) << force, -force, 0.5 * force, -0.5 * force;
      experiment.description = fmt::format(
          "a load test with {:.3g} and {:.3g} N along and against {} at the joint angles {:.2f} "
          "{}",
          0.5 * force, force, "xyz"[axis], fmt::join(q.data(), q.data() + q.size(), ", "),
          unit_of(robot.elastic, "rad"));
      all.push_back(std::move(experiment));
    }
  }
  return all;
}

/// How far a joint goes to and fro: rad; of one that slides a share of its travel, m.
double swing_of(const model::ChainJoint& joint) {
  return joint.slides() ? std::min(0.3, 0.2 * (joint.upper - joint.lower)) : 0.3;
}

/// One joint at a time to and fro about where the recording began, slowly and fast.
std::vector<Experiment> motions(const model::Robot& robot, const Scene& scene) {
  constexpr Eigen::Index kRows = 600;  // time: dozens of motions are simulated
  std::vector<Experiment> all;
  for (Eigen::Index joint = 0; joint < scene.joints(); ++joint) {
    const double swing = swing_of(robot.elastic.joint(joint));
    for (const double speed : {0.02, 0.1, 0.5}) {
      Experiment experiment;
      recording::Recording& recording = experiment.recording;
      const double omega = speed / swing;
      recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, 4 * M_PI / omega);
      recording.q_meas = recording::Samples(scene.q.row(0).replicate(kRows, 1));
      recording.q_meas->col(joint).array() += swing * (omega * recording.time.array()).sin();
      experiment.description = fmt::format(
          "joint {0} alone to and fro in both directions by {1:.2g} {3}, at up to {2} {3}/s",
          joint + 1, swing, speed, unit_of(robot.elastic.joint(joint), "rad"));
      all.push_back(std::move(experiment));
    }
  }
  return all;
}

std::vector<Experiment> experiments(const Observations& observations) {
  std::vector<Experiment> all = load_tests(observations.machine.robot);
  for (Experiment& motion : motions(observations.machine.robot, observations.scenes.front())) {
    all.push_back(std::move(motion));
  }
  for (Experiment& experiment : all) {
    recording::Recording& recording = experiment.recording;
    const auto nothing = [&](Eigen::Index columns) {
      return recording::Samples(recording::Samples::Zero(recording.size(), columns));
    };
    if (observations.has(simulation::tcp_position)) {
      recording.position = nothing(3);
    }
    if (observations.has(simulation::joint_torque)) {
      recording.tau = nothing(observations.machine.robot.joints());
    }
    if (observations.has(simulation::joint_deflection)) {
      recording.q_link = nothing(observations.machine.robot.joints());
    }
    // A drift by temperature can be simulated only where there is one; it stays as it is.
    const Eigen::VectorXd& temperature = observations.scenes.front().temperature;
    if (temperature.size() > 0) {
      recording.temperature =
          recording::Samples(recording::Samples::Constant(recording.size(), 1, temperature.mean()));
    }
  }
  return all;
}

/// Root mean square noise of each channel.
std::array<double, 3> noises(const Observations& observations) {
  std::array<double, 3> all{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto channel = static_cast<Channel>(i);
    all[i] = observations.rms(Eigen::VectorXd::Ones(observations.size()), channel, false);
  }
  return all;
}

/// Largest difference of two machines' predictions over the noise, and where.
double separation(const Observations& observations, const Machine& first, const Machine& second,
                  const Scene& scene, const std::array<double, 3>& noise, std::string* where) {
  const Prediction a = with_terms(first.terms, scene, simulate(first, scene));
  const Prediction b = with_terms(second.terms, scene, simulate(second, scene));
  double most = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] > 0 && a.channel[i].cols() > 0) {
      const double apart = (a.channel[i] - b.channel[i]).cwiseAbs().maxCoeff();
      if (apart / noise[i] > most) {
        most = apart / noise[i];
        *where = fmt::format("{:.2g} {}", apart, unit_of(observations, static_cast<Channel>(i)));
      }
    }
  }
  return most;
}

}  // namespace

std::string suggest_experiment(const Observations& observations, const Diagnosis& diagnosis,
                               std::size_t finding) {
  const Finding& found = diagnosis.choice.findings[finding];
  if (found.alternatives.empty()) {
    return "";
  }
  std::vector<Chosen> rivals = found.without.chosen;
  rivals.push_back(found.alternatives.front().chosen);
  // What else is fitted was fitted without it, and would tell the two apart everywhere.
  const Machine rival = fit(observations, rivals, kSteps).machine;
  const std::array<double, 3> noise = noises(observations);
  double most = 1;
  std::string text;
  for (const Experiment& experiment : experiments(observations)) {
    simulation::Preparation preparation;
    const Scene scene =
        simulation::prepare(experiment.recording, experiment.recording.size(), &preparation);
    std::string where;
    try {
      const double apart =
          separation(observations, diagnosis.choice.fit.machine, rival, scene, noise, &where);
      if (apart > most) {
        most = apart;
        text = fmt::format(
            "Record {}: as fitted so far, {} and {} differ there by up to {}, {:.0f} times the "
            "noise.",
            experiment.description, found.chosen.hypothesis.effect(),
            found.alternatives.front().effect, where, apart);
      }
    } catch (const InputError&) {
      continue;  // a pose in which the robot would not bear the load
    }
  }
  return text;
}

}  // namespace flexcomp::diagnosis
