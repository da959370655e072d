#pragma once

#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "diagnosis/swinging_robot.hpp"
#include "recording/sampling.hpp"

namespace flexcomp::test {

/// The swinging robot under gravity, its torques alone recorded: 25 a second, with noise that is
/// spread evenly, so that no sample has less weight than another.
struct DrivenRobot {
  static constexpr Eigen::Index kRows = 1000;
  static constexpr double kNoise = 2;  ///< N·m, standard deviation

  model::Robot robot;
  recording::Recording recording;
  simulation::Scene scene;  ///< of what is predicted

  DrivenRobot() {
    SwingingRobot swinging(1);
    robot = swinging.robot;
    robot.elastic.gravity = {0, 0, -9.81};
    recording = swinging.recording;
    recording.position.reset();
    recording.tau = recording::Samples::Zero(recording.size(), 6);
    scene = prepared(recording);
  }

  /// Observations of a machine that the robot's model stands for.
  diagnosis::Observations observed(const simulation::Machine& truth) const {
    return diagnosis::Observations(machine(), {prepared(measured(truth))}, 0);
  }

  /// Two recordings, cut from the midst of one; the second is to check with.
  diagnosis::Observations observed_in_parts(const simulation::Machine& truth) const {
    const recording::Recording all = measured(truth);
    const auto part = [&](Eigen::Index begin, Eigen::Index end) {
      std::vector<Eigen::Index> rows(static_cast<std::size_t>(end - begin));
      std::iota(rows.begin(), rows.end(), begin);
      return prepared(recording::picked(all, rows));
    };
    const Eigen::Index rows = all.size();
    return diagnosis::Observations(machine(), {part(rows / 5, rows / 2), part(rows / 2, rows)}, 1);
  }

  simulation::Machine machine() const { return effects::machine_of(robot, {scene}); }

 private:
  recording::Recording measured(const simulation::Machine& truth) const {
    recording::Recording shown = recording;
    simulation::Preparation preparation;
    const simulation::Scene whole = simulation::prepare(shown, shown.size(), &preparation);
    shown.tau = simulation::predict(truth, {whole}).front().channel[simulation::joint_torque];
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-std::sqrt(3.0) * kNoise, std::sqrt(3.0) * kNoise);
    *shown.tau = shown.tau->unaryExpr([&](double value) { return value + noise(random); });
    return shown;
  }

  static simulation::Scene prepared(const recording::Recording& recording) {
    simulation::Preparation preparation;
    return simulation::prepare(recording, kRows, &preparation);
  }
};

/// Torques that a machine shows in a scene (n×joints, N·m).
inline Eigen::MatrixXd shown_torques(const simulation::Machine& machine,
                                     const simulation::Scene& scene) {
  return simulation::predict(machine, {scene}).front().channel[simulation::joint_torque];
}

/// A torque (N·m) by the time (s), by itself or per unit of a parameter.
using Course = std::function<double(double time)>;

/// Adds a course of torque to a joint's, `size` times.
inline void add_torque(int joint, const Course& course, simulation::Machine* machine,
                       double size = 1) {
  machine->terms.push_back(
      {simulation::Term::output, [=](const simulation::Scene& scene, const simulation::Simulation&,
                                     simulation::Prediction* prediction) {
         prediction->channel[simulation::joint_torque].col(joint - 1) +=
             size * scene.time.unaryExpr(course);
       }});
}

/// A law that adds courses in proportion to its parameters to a joint's torque.
inline effects::LawPointer adding(const char* name, const std::vector<Course>& courses) {
  effects::Law law;
  law.effect = name;
  law.traits.linear_in = courses.size();
  law.traits.is_in_family = true;
  law.parameters = [count = courses.size()](const model::Robot&, int) {
    return std::vector<effects::Parameter>(count, {"size", "1"});
  };
  law.apply = [courses](const effects::Values& values, int joint, simulation::Machine* machine) {
    for (std::size_t i = 0; i < courses.size(); ++i) {
      add_torque(joint, courses[i], machine, values[i]);
    }
  };
  return std::make_shared<const effects::Law>(std::move(law));
}

/// Courses in samples, over the noise, computed without the law: a column each.
inline Eigen::MatrixXd columns_of(const diagnosis::Observations& observations, int joint,
                                  const std::vector<Course>& courses) {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(observations.train, static_cast<Eigen::Index>(courses.size()));
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const diagnosis::Sample& at = observations.samples[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < courses.size() && at.component == joint - 1; ++k) {
      columns(i, static_cast<Eigen::Index>(k)) =
          courses[k](observations.scenes[at.scene].time[at.row]) / observations.noise[i];
    }
  }
  return columns;
}

}  // namespace flexcomp::test
