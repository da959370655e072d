#include "check/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/motion.hpp"
#include "recording/sampling.hpp"
#include "statistics/median.hpp"

namespace flexcomp::check {
namespace {

struct NamedGroup {
  const std::optional<recording::Samples> recording::Recording::*group;
  const char* name;
};

constexpr Eigen::Index kFewestForColumns = 20;  // rows

Check said_of(Severity severity, const char* name, const recording::Recording& recording,
              const std::string& what, const char* fix) {
  return {severity, "recording", name, recording.file + ": " + what, fix};
}

/// Does a row hold anything of a group? Single columns may be empty: a joint without a sensor.
bool is_there(const recording::Samples& samples, Eigen::Index row) {
  return samples.row(row).array().isFinite().any();
}

Eigen::Index count_missing(const recording::Samples& samples) {
  Eigen::Index missing = 0;
  for (Eigen::Index row = 0; row < samples.rows(); ++row) {
    missing += is_there(samples, row) ? 0 : 1;
  }
  return missing;
}

/// Is a sample there in every so many rows, as of a sensor slower than the log?
bool is_there_regularly(const recording::Samples& samples) {
  constexpr std::size_t kFewestSteps = 5;  // chosen by judgement: fewer are regular by chance
  std::vector<Eigen::Index> steps;
  Eigen::Index last = -1;
  for (Eigen::Index row = 0; row < samples.rows(); ++row) {
    if (is_there(samples, row)) {
      if (last >= 0) {
        steps.push_back(row - last);
      }
      last = row;
    }
  }
  return steps.size() >= kFewestSteps && recording::regular_step(std::move(steps)).has_value();
}

Checks check_missing(const recording::Recording& recording, const recording::Samples& samples,
                     const char* name) {
  constexpr double kMany = 0.3;  // of the samples, chosen by judgement: fewer are worth no note
  const Eigen::Index missing = count_missing(samples);
  if (missing == samples.rows()) {
    return {said_of(Severity::warning, "column.empty", recording,
                    fmt::format("{} holds no sample", name),
                    "leave the columns out, or record them")};
  }
  if (static_cast<double>(missing) < kMany * static_cast<double>(samples.rows()) ||
      is_there_regularly(samples)) {
    return {};
  }
  return {said_of(Severity::note, "samples.missing", recording,
                  fmt::format("{} of {} samples of {} are missing", missing, samples.rows(), name),
                  "nothing need be done: they are kept as missing")};
}

/// Measurements of a robot that moves do not stay the same to the last digit.
Checks check_constant(const recording::Recording& recording, const recording::Samples& samples,
                      const char* name, bool moves) {
  const Eigen::RowVectorXd range = ranges(samples);
  std::string columns;
  for (Eigen::Index column = 0; moves && column < range.size(); ++column) {
    if (range[column] == 0 && samples.col(column).array().isFinite().any()) {
      columns += fmt::format("{}{}", columns.empty() ? "" : ", ", column + 1);
    }
  }
  if (columns.empty()) {
    return {};
  }
  const bool all = range.isZero(0);
  return {said_of(all ? Severity::error : Severity::note, "column.constant", recording,
                  all ? fmt::format("{} never changes although the joints move", name)
                      : fmt::format("of {} the columns {} never change although the joints move",
                                    name, columns),
                  "check that the sensor was connected and logged")};
}

/// Rows for which a group usually repeats its sample to the last digit while the joints move.
Eigen::Index repeats(const recording::Samples& samples, const recording::Samples& q) {
  std::vector<double> runs;
  Eigen::Index first = 0;
  for (Eigen::Index row = 1; row < samples.rows(); ++row) {
    if (samples.row(row) != samples.row(first)) {
      if (q.row(row) != q.row(first)) {
        runs.push_back(static_cast<double>(row - first));
      }
      first = row;
    }
  }
  if (runs.size() < 20) {
    return 1;
  }
  return static_cast<Eigen::Index>(statistics::median(std::move(runs)));
}

/// Smallest step between values of a column that is there in many places, zero where none is.
double coarsest_step(const Eigen::VectorXd& values) {
  double least = INFINITY;
  Eigen::Index same = 0;
  Eigen::Index moved = 0;
  for (Eigen::Index row = 1; row < values.size(); ++row) {
    const double step = std::abs(values[row] - values[row - 1]);
    if (step > 0) {
      least = std::min(least, step);
      ++moved;
    } else if (step == 0) {
      ++same;
    }
  }
  return same > moved && moved > 20 ? least : 0;
}

Checks check_encoders(const recording::Recording& recording) {
  constexpr double kCoarse = 2e-5;  // rad
  if (!recording.q_meas || !moves_smoothly(*recording.q_meas)) {
    return {};
  }
  double most = 0;
  Eigen::Index worst = 0;
  for (Eigen::Index joint = 0; joint < recording.q_meas->cols(); ++joint) {
    const double step = coarsest_step(recording.q_meas->col(joint));
    if (step > most) {
      most = step;
      worst = joint;
    }
  }
  if (most < kCoarse) {
    return {};
  }
  return {
      said_of(Severity::note, "encoder.coarse", recording,
              fmt::format("the encoder of joint {} has steps of {:.2g} mrad, so that speeds and "
                          "accelerations from it are rough",
                          worst + 1, 1e3 * most),
              "log more digits or the motor's encoder, if there is one")};
}

}  // namespace

Checks check_columns(const recording::Recording& recording) {
  Checks checks;
  const recording::Samples* q = recording.angles();
  if (q == nullptr || recording.size() < kFewestForColumns) {
    return checks;
  }
  const bool moves = ranges(*q).maxCoeff() > 1e-3;
  const NamedGroup measured[] = {{&recording::Recording::tau, "tau"},
                                 {&recording::Recording::position, "x, y, z"}};
  for (const NamedGroup& each : measured) {
    const auto& samples = recording.*each.group;
    if (!samples) {
      continue;
    }
    add(check_missing(recording, *samples, each.name), &checks);
    add(check_constant(recording, *samples, each.name, moves), &checks);
    const Eigen::Index rows = repeats(*samples, *q);
    if (rows > 1) {
      checks.push_back(said_of(Severity::note, "samples.repeated", recording,
                               fmt::format("{} repeats each sample over {} rows: the sensor is "
                                           "slower than the log",
                                           each.name, rows),
                               "nothing need be done: the first of each is used"));
    }
  }
  add(check_encoders(recording), &checks);
  return checks;
}

Checks check_motion(const recording::Recording& recording) {
  constexpr double kMoves = 1e-4;  // rad
  constexpr double kTogether = 0.9995;
  const recording::Samples* q = recording.angles();
  Checks checks;
  if (q == nullptr || recording.size() < kFewestForColumns) {
    return checks;
  }
  const Eigen::RowVectorXd range = ranges(*q);
  std::string still;
  for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
    if (range[joint] < kMoves) {
      still += fmt::format("{}{}", still.empty() ? "" : ", ", joint + 1);
    }
  }
  if (!still.empty()) {
    checks.push_back(said_of(Severity::note, "motion.none", recording,
                             fmt::format("joint {} never moves: its friction, inertia and gear "
                                         "cannot be told from this recording",
                                         still),
                             "move every joint that is to be told of, both ways"));
  }
  std::string together;
  for (Eigen::Index one = 0; one < q->cols(); ++one) {
    for (Eigen::Index other = one + 1; other < q->cols(); ++other) {
      const Eigen::ArrayXd a = q->col(one).array() - q->col(one).mean();
      const Eigen::ArrayXd b = q->col(other).array() - q->col(other).mean();
      const double cosine = (a * b).sum() / std::sqrt(a.square().sum() * b.square().sum());
      if (range[one] > kMoves && range[other] > kMoves && std::abs(cosine) > kTogether) {
        together += fmt::format("{}{} and {}", together.empty() ? "" : ", ", one + 1, other + 1);
      }
    }
  }
  if (!together.empty()) {
    checks.push_back(said_of(Severity::note, "motion.together", recording,
                             fmt::format("joints {} only move together: what each does cannot be "
                                         "told apart",
                                         together),
                             "record a motion in which they move differently"));
  }
  return checks;
}

Checks check_limits(const model::Robot& robot, const recording::Recording& recording) {
  constexpr double kAngleMargin = 0.1;  // rad: limits in a model may be a little off
  // Times the limit, chosen by judgement: differentiation and noise raise a speed, an overload is
  // allowed for a while, and a wrong unit is off by far more.
  constexpr double kSpeedMargin = 1.5;
  constexpr double kTorqueMargin = 1.5;
  Checks checks;
  const recording::Samples* q = recording.angles();
  if (q == nullptr || q->cols() != joint_count(robot)) {
    return checks;
  }
  const Eigen::RowVectorXd speed = usual_top_speed(recording.time, *q);
  const bool is_timed = recording.size() >= kFewestForColumns && moves_smoothly(*q);
  for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
    const Joint<double>& limits = joint_of(robot, joint);
    const model::JointDynamics& most = robot.dynamics[static_cast<std::size_t>(joint)];
    const double low = q->col(joint).minCoeff<Eigen::PropagateNumbers>();
    const double high = q->col(joint).maxCoeff<Eigen::PropagateNumbers>();
    if (low < limits.lower - kAngleMargin || high > limits.upper + kAngleMargin) {
      checks.push_back(said_of(
          Severity::warning, "limits", recording,
          fmt::format(
              "joint {} goes from {:.4g} to {:.4g} rad, beyond the model's limits of {:.4g} "
              "to {:.4g} rad",
              joint + 1, low, high, limits.lower, limits.upper),
          "correct the limits in the URDF, or check zero and sign of the joint's angle"));
    }
    if (is_timed && most.velocity > 0 && speed[joint] > kSpeedMargin * most.velocity) {
      checks.push_back(
          said_of(Severity::warning, "limits", recording,
                  fmt::format("joint {} moves at {:.3g} rad/s, {:.2g} times the model's limit",
                              joint + 1, speed[joint], speed[joint] / most.velocity),
                  "correct the speed limit in the URDF, or check units of time and angle"));
    }
    if (recording.tau && recording.tau->cols() == q->cols() && most.effort > 0) {
      std::vector<double> torque;
      for (Eigen::Index row = 0; row < recording.size(); ++row) {
        if (std::isfinite((*recording.tau)(row, joint))) {
          torque.push_back(std::abs((*recording.tau)(row, joint)));
        }
      }
      std::sort(torque.begin(), torque.end());
      const double usual = torque.empty() ? 0 : torque[torque.size() * 19 / 20];
      if (usual > kTorqueMargin * most.effort) {
        checks.push_back(said_of(Severity::warning, "limits", recording,
                                 fmt::format("tau_{} comes to {:.4g} N·m, {:.2g} times what the "
                                             "model says the joint can give",
                                             joint + 1, usual, usual / most.effort),
                                 "correct the effort in the URDF, or check the torque's unit"));
      }
    }
  }
  return checks;
}

}  // namespace flexcomp::check
