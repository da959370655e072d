#include "simulation/scene.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "error.hpp"
#include "model/chain.hpp"
#include "recording/noise.hpp"
#include "recording/sampling.hpp"
#include "simulation/windows.hpp"
#include "statistics/median.hpp"

namespace flexcomp::simulation {
namespace {

/// At creeping speed friction depends on what went before, not on the speed: contacts wind up and
/// break away (Armstrong-Helouvry, Dupont and Canudas de Wit 1994, presliding).
void mark_creeping(Scene* scene) {
  constexpr double kCreeping = 0.02;  // of the largest speed
  for (Eigen::Index joint = 0; joint < scene->joints(); ++joint) {
    const auto speed = scene->velocity.col(joint).array().abs();
    const double limit = kCreeping * speed.maxCoeff();
    scene->stands.col(joint) = (speed < limit).select(1, scene->stands.col(joint).array());
  }
}

/// Does a sensor repeat its last sample in a log that is faster than it? Then it does so regularly;
/// what stays the same in a motion, or at rest, does not. `runs`: rows that each sample lasts.
bool is_held(const std::vector<Eigen::Index>& runs) {
  constexpr std::size_t kFewest = 20;  // chosen by judgement: fewer are regular by chance
  return runs.size() >= kFewest && recording::regular_step(runs).value_or(1) > 1;
}

/// Only the first of repeated samples tells anything: the others are taken for missing.
void drop_held(std::optional<recording::Samples>* samples) {
  if (!*samples) {
    return;
  }
  std::vector<Eigen::Index> runs;
  Eigen::Index first = 0;
  for (Eigen::Index row = 1; row < (*samples)->rows(); ++row) {
    if ((*samples)->row(row) != (*samples)->row(first)) {
      runs.push_back(row - first);
      first = row;
    }
  }
  if (!is_held(runs)) {
    return;
  }
  for (Eigen::Index row = (*samples)->rows() - 1; row > 0; --row) {
    if ((*samples)->row(row) == (*samples)->row(row - 1)) {
      (*samples)->row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

template <typename Group>
Eigen::MatrixXd picked(const Group& group, const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(rows.size()), group.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    values.row(static_cast<Eigen::Index>(i)) = group.row(rows[i]);
  }
  return values;
}

/// Missing values between those that are there, held at the ends: warmth changes slowly. Empty if
/// there is none at all.
Eigen::VectorXd filled(Eigen::VectorXd values) {
  Eigen::Index known = -1;
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    if (!std::isfinite(values[row])) {
      continue;
    }
    for (Eigen::Index gap = known + 1; gap < row; ++gap) {
      const double share =
          known < 0 ? 1 : static_cast<double>(gap - known) / static_cast<double>(row - known);
      values[gap] = known < 0 ? values[row] : (1 - share) * values[known] + share * values[row];
    }
    known = row;
  }
  if (known < 0) {
    return {};
  }
  values.tail(values.size() - known).setConstant(values[known]);
  return values;
}

void refuse_unusable(const recording::Recording& recording) {
  if (!recording.q_meas && !recording.q_cmd) {
    throw InputError(fmt::format("{}: joint angles are needed: columns q_meas_1..n or q_cmd_1..n",
                                 recording.file));
  }
  if (!recording.position && !recording.tau && !(recording.q_link && recording.q_meas)) {
    throw InputError(
        fmt::format("{}: nothing to compare with: columns x,y,z or tau_1..n or q_link_1..n with "
                    "q_meas_1..n are needed",
                    recording.file));
  }
}

/// Values that a row has of what a simulation can be compared with.
Eigen::Index measured_at(const recording::Recording& recording, Eigen::Index row) {
  const auto known = [row](const auto& group) {
    return group ? group->row(row).array().isFinite().count() : 0;
  };
  return known(recording.position) + known(recording.tau) + known(recording.q_link);
}

/// The first of every so many rows that shows most: a slow sensor may be there in some only.
std::vector<Eigen::Index> thinned(const recording::Recording& recording,
                                  const std::vector<Eigen::Index>& rows, Eigen::Index each) {
  std::vector<Eigen::Index> kept;
  for (std::size_t first = 0; first < rows.size(); first += static_cast<std::size_t>(each)) {
    const std::size_t end = std::min(rows.size(), first + static_cast<std::size_t>(each));
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
    kept.push_back(*std::max_element(begin, rows.begin() + static_cast<std::ptrdiff_t>(end),
                                     [&](Eigen::Index a, Eigen::Index b) {
                                       return measured_at(recording, a) < measured_at(recording, b);
                                     }));
  }
  return kept;
}

std::vector<Eigen::Index> usable_rows(const recording::Recording& recording, Eigen::Index most_rows,
                                      Preparation* preparation) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    if (!recording.wrench || recording.wrench->row(row).allFinite()) {
      rows.push_back(row);
    }
  }
  if (rows.empty()) {
    throw InputError(fmt::format("{}: no row has all joint angles{}", recording.file,
                                 recording.wrench ? " and the whole wrench" : ""));
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  preparation->incomplete = recording.size() - count;
  preparation->kept_each = std::max<Eigen::Index>(1, (count + most_rows - 1) / most_rows);
  return thinned(recording, rows, preparation->kept_each);
}

void describe_times(const Eigen::VectorXd& time, Preparation* preparation) {
  if (time.size() < 2) {
    return;
  }
  const Eigen::VectorXd steps = time.tail(time.size() - 1) - time.head(time.size() - 1);
  preparation->largest_gap = steps.maxCoeff();
  preparation->median_step = statistics::median({steps.begin(), steps.end()});
}

recording::Recording without_repeats(recording::Recording recording) {
  for (auto* samples : {&recording.position, &recording.tau, &recording.q_link}) {
    drop_held(samples);
  }
  return recording;
}

/// A joint's motion at a row of a scene.
void take(const LocalMotion& motion, Eigen::Index joint, Eigen::Index row, Scene* scene) {
  scene->velocity(row, joint) = motion.values(0, joint);
  scene->acceleration(row, joint) = motion.values(1, joint);
  scene->acceleration_doubt(row, joint) = motion.doubt[joint];
  scene->stands(row, joint) = motion.stands[joint];
}

void set_at_rest(Scene* scene) {
  const Eigen::Index n = scene->rows();
  const Eigen::Index joints = scene->joints();
  scene->velocity = Eigen::MatrixXd::Zero(n, joints);
  scene->acceleration = Eigen::MatrixXd::Zero(n, joints);
  scene->acceleration_doubt = Eigen::MatrixXd::Zero(n, joints);
  scene->stands = Eigen::MatrixXi::Zero(n, joints);
  scene->velocity_noise = scene->acceleration_noise = Eigen::RowVectorXd::Zero(joints);
}

/// Differentiates the angles of a recording, each joint over the window that suits its noise;
/// `rows` of them become the scene's.
void differentiate(const Eigen::VectorXd& time, const recording::Samples& q,
                   const std::vector<Eigen::Index>& rows, Scene* scene) {
  Eigen::RowVectorXd angle_noise(q.cols());
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    angle_noise[joint] = recording::encoder_noise(time, q.col(joint));
  }
  const std::vector<JointPolynomials> suited = best_polynomials(time, q, angle_noise);
  for (auto own = suited.begin(); own != suited.end(); ++own) {
    if (std::find(suited.begin(), own, *own) != own) {
      continue;  // with a joint before
    }
    scene->half_window = std::max(scene->half_window, own->inner.half_window);
    for (Eigen::Index row = 0; row < scene->rows(); ++row) {
      const LocalMotion motion =
          local_motion(time, q, angle_noise, *own, rows[static_cast<std::size_t>(row)]);
      for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
        if (!(suited[static_cast<std::size_t>(joint)] == *own)) {
          continue;
        }
        take(motion, joint, row, scene);
        if (row == scene->rows() / 2) {
          scene->velocity_noise[joint] = motion.gain[0] * angle_noise[joint];
          scene->acceleration_noise[joint] = suited[static_cast<std::size_t>(joint)].noise_scale *
                                             motion.gain[1] * angle_noise[joint];
        }
      }
    }
  }
}

/// The measurements that the scene is compared with.
void take_measured(const recording::Recording& recording, const std::vector<Eigen::Index>& rows,
                   Scene* scene) {
  if (recording.position) {
    scene->measured[tcp_position] = picked(*recording.position, rows);
  }
  if (recording.tau) {
    scene->measured[joint_torque] = picked(*recording.tau, rows);
  }
  if (recording.q_link && recording.q_meas) {
    scene->measured[joint_deflection] = picked(*recording.q_link, rows) - scene->q;
  }
}

Scene scene_of(const recording::Recording& given, Eigen::Index most_rows,
               Preparation* preparation) {
  const recording::Sampling sampling = recording::sampling_of(given);
  recording::Recording recording = picked(given, sampling.rows);
  recording.time = sampling.time;
  const std::vector<Eigen::Index> rows = usable_rows(recording, most_rows, preparation);
  preparation->period = sampling.period;
  preparation->repeats = sampling.repeats;
  preparation->rows = given.size();
  preparation->incomplete +=
      given.size() - recording.size() - static_cast<Eigen::Index>(sampling.repeats.size());
  describe_times(recording.time, preparation);
  Scene scene;
  scene.file = recording.file;
  for (const Eigen::Index row : rows) {
    scene.recorded.push_back(sampling.rows[static_cast<std::size_t>(row)]);
  }
  scene.time = picked(recording.time, rows);
  scene.is_static = recording::counts_rows(given.time);
  scene.follows_command = !recording.q_meas;
  scene.has_wrench = recording.wrench.has_value();
  scene.q = picked(*recording.angles(), rows);
  set_at_rest(&scene);
  if (!scene.is_static) {
    differentiate(recording.time, *recording.angles(), rows, &scene);
  }
  mark_creeping(&scene);
  scene.wrench =
      scene.has_wrench ? picked(*recording.wrench, rows) : Eigen::MatrixXd::Zero(scene.rows(), 6);
  if (recording.temperature) {
    scene.temperature = filled(picked(*recording.temperature, rows));
  }
  take_measured(recording, rows, &scene);
  return scene;
}

}  // namespace

Scene prepare(const recording::Recording& recording, Eigen::Index most_rows,
              Preparation* preparation) {
  refuse_unusable(recording);
  return scene_of(without_repeats(recording), most_rows, preparation);
}

}  // namespace flexcomp::simulation
