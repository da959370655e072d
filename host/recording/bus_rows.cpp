#include "recording/bus_rows.hpp"

#include <algorithm>
#include <limits>

#include "error.hpp"

namespace flexcomp::recording {
namespace {

constexpr double kNanosecondsASecond = 1e9;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Where each group of columns begins.
constexpr std::size_t kCommanded = 0;
constexpr std::size_t kMeasured = 6;
constexpr std::size_t kWrench = 12;
constexpr std::size_t kPosition = 18;

}  // namespace

void BusRows::take(const Message& message) {
  if (const auto* wrench = std::get_if<WrenchMessage>(&message)) {
    put(kWrench, wrench->wrench);
  } else if (const auto* joints = std::get_if<MeasuredJointsMessage>(&message)) {
    put(kMeasured, joints->q);
  } else if (const auto* position = std::get_if<MeasuredPositionMessage>(&message)) {
    put(kPosition, position->position);
  }
}

void BusRows::end_row(std::int64_t time, const JointAngles& q) {
  put(kCommanded, q);
  time_.push_back(time);
  rows_.push_back(row_);
  row_.fill(kMissing);
}

Recording BusRows::finish(const std::string& file) const {
  if (rows_.size() < 2) {
    throw InputError(file + ": expected at least two setpoints on the bus");
  }
  Recording recording;
  recording.file = file;
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  recording.time.resize(rows);
  Samples samples(rows, static_cast<Eigen::Index>(kColumns));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    recording.time[row] = static_cast<double>(time_[i] - time_[0]) / kNanosecondsASecond;
    std::copy(rows_[i].begin(), rows_[i].end(), samples.row(row).data());
  }
  const auto group = [&](std::size_t column, Eigen::Index width) -> std::optional<Samples> {
    const Samples part = samples.middleCols(static_cast<Eigen::Index>(column), width);
    return part.array().isNaN().all() ? std::nullopt : std::optional(part);
  };
  recording.q_cmd = group(kCommanded, 6);
  recording.q_meas = group(kMeasured, 6);
  recording.wrench = group(kWrench, 6);
  recording.position = group(kPosition, 3);
  return recording;
}

BusRows::Row BusRows::missing_row() {
  Row row{};
  row.fill(kMissing);
  return row;
}

template <std::size_t Width>
void BusRows::put(std::size_t column, const std::array<double, Width>& values) {
  std::copy(values.begin(), values.end(), row_.begin() + static_cast<std::ptrdiff_t>(column));
}

}  // namespace flexcomp::recording
