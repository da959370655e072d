#include "check/positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/readings.hpp"
#include "effects/machine_size.hpp"

namespace flexcomp::check {
namespace {

constexpr Eigen::Index kMostRows = 240;  // time: dozens of readings are tried on each
constexpr Eigen::Index kFewestRows = 3;  // points that tell where a frame is
/// m: springs, lengths and zeros of a robot that is not calibrated put its TCP this far off at
/// most; what is within is for a diagnosis.
constexpr double kPhysical = 0.02;
/// Share of the distance that may stay under a reading.
constexpr double kFits = 0.1;

std::vector<Eigen::Index> spread(const std::vector<Eigen::Index>& all) {
  const auto count = static_cast<Eigen::Index>(all.size());
  const Eigen::Index each = std::max<Eigen::Index>(1, (count + kMostRows - 1) / kMostRows);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < count; i += each) {
    kept.push_back(all[static_cast<std::size_t>(i)]);
  }
  return kept;
}

PoseRows pose_rows(const model::Robot& robot, const recording::Samples& q,
                   const recording::Samples& positions) {
  std::vector<Eigen::Index> all;
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    if (q.row(row).allFinite() && positions.row(row).allFinite()) {
      all.push_back(row);
    }
  }
  const std::vector<Eigen::Index> kept = spread(all);
  const auto count = static_cast<Eigen::Index>(kept.size());
  PoseRows rows;
  rows.q.resize(count, q.cols());
  rows.measured.resize(count, 3);
  rows.predicted.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    rows.q.row(i) = q.row(kept[static_cast<std::size_t>(i)]);
    rows.measured.row(i) = positions.row(kept[static_cast<std::size_t>(i)]);
    rows.tcp.push_back(tcp_at(robot, rows.q.row(i)));
    rows.predicted.row(i) = rows.tcp.back().position.transpose();
  }
  return rows;
}

/// The reading with the fewest assumptions under which angles and positions fit.
const Reading* most_likely(const Readings& readings, double off) {
  const auto fits = [&](const Reading& each) {
    return each.left < std::max(kFits * off, 0.25 * kPhysical) && each.left < 0.5 * off;
  };
  const Reading* best = nullptr;
  for (const Reading& each : readings) {
    const bool is_better = best == nullptr || each.steps < best->steps ||
                           (each.steps == best->steps && each.left < best->left);
    best = fits(each) && is_better ? &each : best;
  }
  if (best == nullptr) {
    return nullptr;
  }
  // More assumptions are made only where they leave far less.
  for (const Reading& each : readings) {
    if (each.steps > best->steps && each.left < 0.1 * best->left && best->left > kPhysical) {
      best = &each;
    }
  }
  return best;
}

void mend(const Reading& reading, recording::Recording* recording) {
  if (reading.mend_angles) {
    for (auto* group : {&recording->q_cmd, &recording->q_meas, &recording->q_link}) {
      if (*group) {
        Eigen::MatrixXd q = **group;
        reading.mend_angles(&q);
        **group = q;
      }
    }
  }
  if (reading.mend_positions) {
    Points positions = *recording->position;
    reading.mend_positions(&positions);
    *recording->position = positions;
  }
}

Check unlike_any(const recording::Recording& recording, double off) {
  return {Severity::warning, "recording", "model.other",
          fmt::format("{}: the measured positions lie {:.3g} m from where the model puts the TCP, "
                      "and no other unit, axes, frame or tool accounts for it, nor other signs of "
                      "joints or another zero of one",
                      recording.file, off),
          "check that model and recording are of the same robot, that all joints are counted as in "
          "the URDF (a KUKA counts other signs and zeros), and what x, y and z are measured from "
          "and to"};
}

}  // namespace

Checks check_positions(const model::Robot& robot, recording::Recording* recording, bool* fits) {
  *fits = false;
  const recording::Samples* q = recording->angles();
  if (q == nullptr || !recording->position || q->cols() != joint_count(robot)) {
    return {};
  }
  const PoseRows rows = pose_rows(robot, *q, *recording->position);
  if (rows.q.rows() < kFewestRows) {
    return {};
  }
  const double off = median_distance(rows.measured, rows.predicted);
  if (off < kPhysical) {
    *fits = true;
    return {};
  }
  Readings readings;
  for (Readings more : {unit_readings(rows), axis_readings(rows), joint_readings(robot, rows),
                        frame_readings(robot, rows)}) {
    readings.insert(readings.end(), more.begin(), more.end());
  }
  const Reading* found = most_likely(readings, off);
  if (found == nullptr) {
    const double reach = effects::size_of(robot).reach;
    return off > 0.05 * reach ? Checks{unlike_any(*recording, off)} : Checks{};
  }
  Check said = found->check;
  said.what = fmt::format("{}: {} (now {:.3g} m from where the model puts the TCP, so {:.2g} mm)",
                          recording->file, said.what, off, 1e3 * found->left);
  mend(*found, recording);
  *fits = true;
  return {said};
}

}  // namespace flexcomp::check
