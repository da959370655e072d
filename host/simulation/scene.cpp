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
#include "simulation/differentiation.hpp"
#include "statistics/median.hpp"

namespace flexcomp::simulation {
namespace {

/// Contract: t counts 0, 1, 2, … in static load tests.
bool is_load_test(const Eigen::VectorXd& time) {
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    if (time[i] != static_cast<double>(i)) {
      return false;
    }
  }
  return true;
}

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
/// what stays the same in a motion, or at rest, does not.
bool is_held(const std::vector<Eigen::Index>& runs) {
  constexpr std::size_t kFewest = 20;
  if (runs.size() < kFewest) {
    return false;
  }
  std::vector<Eigen::Index> sorted = runs;
  std::sort(sorted.begin(), sorted.end());
  const Eigen::Index typical = sorted[sorted.size() / 2];
  return typical > 1 && sorted[sorted.size() * 9 / 10] <= typical + 1;
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

/// Some of these rows, by where they stand among them.
std::vector<Eigen::Index> those_at(const std::vector<Eigen::Index>& rows,
                                   const std::vector<Eigen::Index>& places) {
  std::vector<Eigen::Index> some;
  some.reserve(places.size());
  for (const Eigen::Index place : places) {
    some.push_back(rows[static_cast<std::size_t>(place)]);
  }
  return some;
}

const recording::Samples& angles_of(const recording::Recording& recording) {
  return recording.q_meas ? *recording.q_meas : *recording.q_cmd;
}

/// The rows that have all joint angles and samples of their own, at the times of these; which rows
/// they are of the recording.
recording::Recording sampled(const recording::Recording& recording, std::vector<Eigen::Index>* rows,
                             Preparation* preparation) {
  std::vector<Eigen::Index> whole;
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    if (angles_of(recording).row(row).allFinite()) {
      whole.push_back(row);
    }
  }
  recording::Recording own = picked(recording, whole);
  // A command that stays is meant so.
  if (recording.q_meas && !is_load_test(recording.time)) {
    const recording::Sampling sampling = recording::sampling_of(own.time, angles_of(own));
    own = picked(own, sampling.rows);
    own.time = sampling.time;
    preparation->period = sampling.period;
    preparation->repeats = those_at(whole, sampling.repeats);
    whole = those_at(whole, sampling.rows);
  }
  *rows = std::move(whole);
  return own;
}

Scene scene_of(const recording::Recording& given, Eigen::Index most_rows,
               Preparation* preparation) {
  std::vector<Eigen::Index> recorded;
  const recording::Recording recording = sampled(given, &recorded, preparation);
  const recording::Samples& q = angles_of(recording);
  const std::vector<Eigen::Index> rows = usable_rows(recording, most_rows, preparation);
  preparation->rows = given.size();
  preparation->incomplete +=
      given.size() - recording.size() - static_cast<Eigen::Index>(preparation->repeats.size());
  describe_times(recording.time, preparation);
  Scene scene;
  scene.file = recording.file;
  scene.recorded = those_at(recorded, rows);
  scene.time = picked(recording.time, rows);
  scene.is_static = is_load_test(given.time);
  scene.follows_command = !recording.q_meas;
  scene.has_wrench = recording.wrench.has_value();
  scene.q = picked(q, rows);
  const Eigen::Index n = scene.rows();
  scene.velocity = Eigen::MatrixXd::Zero(n, scene.joints());
  scene.acceleration = Eigen::MatrixXd::Zero(n, scene.joints());
  scene.stands = Eigen::MatrixXi::Zero(n, scene.joints());
  Eigen::RowVectorXd angle_noise(scene.joints());
  for (Eigen::Index joint = 0; joint < scene.joints(); ++joint) {
    angle_noise[joint] = recording::encoder_noise(recording.time, q.col(joint));
  }
  const auto windows_of = static_cast<std::size_t>(scene.joints());
  const std::vector<std::size_t> windows = scene.is_static
                                               ? std::vector<std::size_t>(windows_of, 0)
                                               : best_windows(recording.time, q, angle_noise);
  for (const std::size_t window : windows) {
    scene.half_window = std::max(scene.half_window, kHalfWindows[window]);
  }
  scene.acceleration_doubt = Eigen::MatrixXd::Zero(n, scene.joints());
  scene.velocity_noise = scene.acceleration_noise = Eigen::RowVectorXd::Zero(scene.joints());
  for (Eigen::Index i = 0; i < n && !scene.is_static; ++i) {
    for (std::size_t k = 0; k < kHalfWindows.size(); ++k) {
      if (std::find(windows.begin(), windows.end(), k) == windows.end()) {
        continue;
      }
      const LocalMotion motion = local_motion(recording.time, q, angle_noise, kHalfWindows[k],
                                              rows[static_cast<std::size_t>(i)]);
      for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
        if (windows[static_cast<std::size_t>(joint)] == k) {
          take(motion, joint, i, &scene);
          if (i == n / 2) {
            scene.velocity_noise[joint] = motion.gain[0] * angle_noise[joint];
            scene.acceleration_noise[joint] = motion.gain[1] * angle_noise[joint];
          }
        }
      }
    }
  }
  mark_creeping(&scene);
  scene.wrench = scene.has_wrench ? picked(*recording.wrench, rows) : Eigen::MatrixXd::Zero(n, 6);
  if (recording.temperature) {
    scene.temperature = filled(picked(*recording.temperature, rows));
  }
  if (recording.position) {
    scene.measured[tcp_position] = picked(*recording.position, rows);
  }
  if (recording.tau) {
    scene.measured[joint_torque] = picked(*recording.tau, rows);
  }
  if (recording.q_link && recording.q_meas) {
    scene.measured[joint_deflection] = picked(*recording.q_link, rows) - scene.q;
  }
  return scene;
}

}  // namespace

Scene prepare(const recording::Recording& recording, Eigen::Index most_rows,
              Preparation* preparation) {
  refuse_unusable(recording);
  return scene_of(without_repeats(recording), most_rows, preparation);
}

}  // namespace flexcomp::simulation
