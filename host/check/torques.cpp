#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/loads.hpp"
#include "check/motion.hpp"
#include "check/torque_fit.hpp"

namespace flexcomp::check {
namespace {

using simulation::Scene;

constexpr Eigen::Index kMostTorqueRows = 2500;  // time: each regression takes all of them

std::string listed(const std::vector<Eigen::Index>& joints) {
  std::string text = joints.size() > 1 ? "joints " : "joint ";
  for (std::size_t i = 0; i < joints.size(); ++i) {
    text += fmt::format("{}{}", i > 0 ? ", " : "", joints[i] + 1);
  }
  return text;
}

/// A way in which the joints' angles may have been rearranged.
struct Rearranged {
  Check check;
  Eigen::Index one, other;  ///< swapped; the same where turned

  void apply(Eigen::MatrixXd* values) const {
    if (one == other) {
      values->col(one) *= -1;
    } else {
      values->col(one).swap(values->col(other));
    }
  }
  Scene of(Scene scene) const {
    for (Eigen::MatrixXd* values : {&scene.q, &scene.velocity, &scene.acceleration}) {
      apply(values);
    }
    return scene;
  }
};

std::vector<Rearranged> rearrangements(const Scene& scene) {
  std::vector<Rearranged> all;
  for (Eigen::Index one = 0; one < scene.q.cols(); ++one) {
    all.push_back(
        {{Severity::error, "recording", "joint.sign",
          fmt::format("{}: all joints' loads fit the model far better with the angle of joint {} "
                      "turned in sign",
                      scene.file, one + 1),
          fmt::format("turn the sign of joint {}'s angle, or of its axis in the URDF", one + 1)},
         one,
         one});
    for (Eigen::Index other = one + 1; other < scene.q.cols(); ++other) {
      all.push_back(
          {{Severity::error, "recording", "joint.order",
            fmt::format("{}: all joints' loads fit the model far better with the angles of "
                        "joints {} and {} swapped",
                        scene.file, one + 1, other + 1),
            "put the columns into the order of the joints, base to tip"},
           one,
           other});
    }
  }
  return all;
}

/// Can a joint's torque tell how the angles stand? Not where it fits by many times the model's
/// weight or inertia: a rotor or a payload that the model lacks does that at a wrist, and follows
/// whatever turns alike.
bool is_of_model_size(const TorqueFit& fit) {
  constexpr double kLeastPartial = 0.3;
  constexpr double kFar = 8;
  const auto is_far = [&](Part part) {
    return fit.fit.is_told(part, kLeastPartial) && std::abs(fit.fit.value[part]) > kFar;
  };
  return !is_far(kWeight) && !is_far(kInertia);
}

/// By how much torques fit better with the angles rearranged, in logarithms of what is left: those
/// of all joints, or less those that were rearranged.
double improvement(const std::vector<TorqueFit>& fits, const std::vector<TorqueFit>& with,
                   const Rearranged& beside, bool all) {
  const auto left = [](const TorqueFit& each) {
    return std::log(std::max(each.fit.left, 1e-9 * each.rms + 1e-15));
  };
  double sum = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const bool is_asked = all || (joint != beside.one && joint != beside.other);
    if (is_asked && fits[i].is_there && is_of_model_size(fits[i]) && is_of_model_size(with[i])) {
      sum += left(fits[i]) - left(with[i]);
    }
  }
  return sum;
}

/// How many torques are turned against what moves and holds the arm.
int turned_torques(const std::vector<TorqueFit>& fits) {
  return static_cast<int>(std::count_if(fits.begin(), fits.end(), [](const TorqueFit& each) {
    return each.is_there && witnesses_of(each).all_turned();
  }));
}

/// The angle by whose change the torques fit far better than they do; of the other joints too,
/// which a turned or swapped torque does not make them do.
Checks check_angles_by_torque(const model::Robot& robot, const Scene& scene,
                              recording::Recording* recording) {
  constexpr double kBetter = 0.6;         // of misfits, each up to 1; chosen by judgement, as
  constexpr double kOthersBetter = 0.25;  // of those of the other joints
  constexpr double kTurned = 0.7;         // what a torque counts that then has the right sign
  const std::vector<TorqueFit> fits = fit_torques(robot, scene);
  const std::vector<Rearranged> all = rearrangements(scene);
  const Rearranged* best = nullptr;
  double most = kBetter;
  for (const Rearranged& each : all) {
    const std::vector<TorqueFit> with = fit_torques(robot, each.of(scene));
    const double gain = improvement(fits, with, each, true) +
                        kTurned * (turned_torques(fits) - turned_torques(with));
    if (gain > most && improvement(fits, with, each, false) > kOthersBetter) {
      most = gain;
      best = &each;
    }
  }
  if (best == nullptr) {
    return {};
  }
  for (auto* group : {&recording->q_cmd, &recording->q_meas, &recording->q_link}) {
    if (*group) {
      Eigen::MatrixXd q = **group;
      best->apply(&q);
      **group = q;
    }
  }
  return {best->check};
}

Checks check_signs(const Scene& scene, const std::vector<TorqueFit>& fits,
                   recording::Samples* tau) {
  std::vector<Eigen::Index> turned;
  std::vector<Eigen::Index> told;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (!fits[i].is_there) {
      continue;
    }
    const Witnesses witnesses = witnesses_of(fits[i]);
    if (witnesses.all_turned()) {
      turned.push_back(static_cast<Eigen::Index>(i));
      tau->col(turned.back()) *= -1;
    }
    if (witnesses.weight != 0 || witnesses.inertia != 0 || witnesses.friction != 0) {
      told.push_back(static_cast<Eigen::Index>(i));
    }
  }
  if (turned.empty()) {
    return {};
  }
  return {
      {Severity::error, "recording", "torque.sign",
       fmt::format("{}: the torque of {} has the opposite sign of what moves and holds the arm{}",
                   scene.file,
                   turned.size() == told.size() && turned.size() > 1 ? "all joints that tell"
                                                                     : listed(turned),
                   turned.size() == 1 ? " (or the joint's angle has)" : ""),
       fmt::format("turn the sign of tau of {}: it is the torque that the motor gives",
                   listed(turned))}};
}

Checks check_scales(const Scene& scene, const std::vector<TorqueFit>& fits,
                    recording::Samples* tau) {
  constexpr double kFar = 8;  // chosen by judgement: beyond what masses are off by, within a unit
  std::vector<Eigen::Index> far;
  std::vector<double> scales;
  std::size_t told = 0;
  std::size_t larger = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const double scale = fits[i].is_there ? scale_of(fits[i]) : 0;
    told += scale > 0 ? 1 : 0;
    if (scale > kFar || (scale > 0 && scale < 1 / kFar)) {
      far.push_back(static_cast<Eigen::Index>(i));
      scales.push_back(scale);
      larger += scale > 1 ? 1 : 0;
    }
  }
  // A payload that the model lacks makes the torques of a wrist many times as large, not all.
  if (far.empty() || (larger > 0 && (larger < 2 || larger < told))) {
    return {};
  }
  std::string times;
  for (std::size_t i = 0; i < far.size(); ++i) {
    times += fmt::format("{}{:.2g}", i > 0 ? ", " : "", scales[i]);
    tau->col(far[i]) /= scales[i];
  }
  return {{Severity::error, "recording", "torque.unit",
           fmt::format("{}: tau of {} goes with the model's torque, but is {} times as large",
                       scene.file, listed(far), times),
           scales.front() < 1
               ? "give torques in N·m on the joint side: multiply motor torques by the gear ratio, "
                 "currents by the torque constant too"
               : "give torques in N·m on the joint side: are they in another unit?"}};
}

/// Weight that the torques carry though the model has no gravity.
Checks check_gravity(const model::Robot& robot, const Scene& scene) {
  constexpr double kStandard = 9.81;  // m/s²
  constexpr double kLeastPartial = 0.8;
  if (robot.elastic.gravity.norm() > 0) {
    return {};
  }
  const std::vector<TorqueFit> fits =
      fit_torques(with_gravity(robot, Vector3<double>(0, 0, -kStandard)), scene);
  std::vector<Eigen::Index> bearing;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].is_there && fits[i].fit.is_told(kWeight, kLeastPartial) &&
        fits[i].fit.value[kWeight] > 0.3 && fits[i].fit.value[kWeight] < 3) {
      bearing.push_back(static_cast<Eigen::Index>(i));
    }
  }
  if (bearing.empty()) {
    return {};
  }
  return {{Severity::error, "model", "gravity.missing",
           fmt::format("{}: gravity is zero in the model, but the torque of {} carries the arm's "
                       "weight",
                       scene.file, listed(bearing)),
           "set gravity in the model to [0, 0, -9.81], in the base frame"}};
}

}  // namespace

Checks check_torques(const model::Robot& robot, bool proved, recording::Recording* recording) {
  constexpr Eigen::Index kRowsToTryWith = 600;  // time: every change of an angle is simulated
  const bool has_deflections = recording->q_link && recording->q_meas;
  const bool has_angles = recording->q_meas || recording->q_cmd;
  if ((!recording->tau && !has_deflections) || !has_angles || !has_masses(robot) ||
      recording->angles()->cols() != joint_count(robot)) {
    return {};
  }
  simulation::Preparation preparation;
  Checks checks;
  if (!proved) {
    checks = check_angles_by_torque(
        robot, simulation::prepare(*recording, kRowsToTryWith, &preparation), recording);
  }
  if (!recording->tau) {
    return checks;
  }
  const Scene scene = simulation::prepare(*recording, kMostTorqueRows, &preparation);
  const std::vector<TorqueFit> fits = fit_torques(robot, scene);
  add(check_signs(scene, fits, &*recording->tau), &checks);
  add(check_scales(scene, fits, &*recording->tau), &checks);
  add(check_gravity(robot, scene), &checks);
  return checks;
}

}  // namespace flexcomp::check
