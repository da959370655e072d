#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/messages.hpp"
#include "recording/recording.hpp"

namespace flexcomp::recording {

/// Rows of a recording as messages come in: each holds what came last since the row before.
class BusRows {
 public:
  /// Keeps a wrench, measured joints or a measured position for the row under way.
  void take(const Message& message);

  /// Ends the row under way at `time` (ns), with `q` as its q_cmd.
  void end_row(std::int64_t time, const JointAngles& q);

  /// May a row end at this time? A recording's time strictly increases.
  bool is_after_last(std::int64_t time) const { return time_.empty() || time > time_.back(); }

  /// All rows, from time zero; groups of which nothing was seen are left out. Throws InputError,
  /// naming the file, if there are fewer than two.
  Recording finish(const std::string& file) const;

 private:
  static constexpr std::size_t kColumns = 21;
  using Row = std::array<double, kColumns>;

  static Row missing_row();
  template <std::size_t Width>
  void put(std::size_t column, const std::array<double, Width>& values);

  Row row_ = missing_row();
  std::vector<std::int64_t> time_;
  std::vector<Row> rows_;
};

}  // namespace flexcomp::recording
