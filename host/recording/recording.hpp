#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/csv.hpp"

namespace flexcomp::recording {

/// Rows of samples; NaN for a missing one.
using Samples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A recording of a robot: time and any of the groups below, one row a sample, and a column a joint
/// in those about joints. SI units, angles in rad, vectors in the robot base frame; m and N in
/// place of rad and N·m for joints that slide.
struct Recording {
  std::string file;                     ///< where it came from, for messages
  std::vector<std::size_t> lines;       ///< line of the file that each row stood in; empty if made
  Eigen::VectorXd time;                 ///< s, strictly increasing
  std::optional<Samples> q_cmd;         ///< commanded joint angles
  std::optional<Samples> q_meas;        ///< motor-side encoders reflected to the joint
  std::optional<Samples> q_link;        ///< link-side encoders
  std::optional<Samples> tau;           ///< motor torques on the joint side
  std::optional<Samples> wrench;        ///< n×6, force and moment on the tool at the TCP
  std::optional<Samples> position;      ///< n×3, measured TCP position
  std::optional<Samples> temperature;   ///< n×1, °C
  std::optional<Samples> program_line;  ///< n×1, line of the program that a row belongs to

  Eigen::Index size() const { return time.size(); }

  /// Measured joint angles, else commanded ones; null without either.
  const Samples* angles() const;

  /// "file:line" of a row, for messages.
  std::string place(Eigen::Index row) const;
};

/// Do the times count 0, 1, 2, …, as those of a static load test do?
bool counts_rows(const Eigen::VectorXd& time);

/// Reads a recording of a robot of so many joints. Throws InputError with file, line and column if
/// it is no table of numbers, time is missing or does not increase, a column is unknown, or a group
/// is there only in part.
Recording read_recording(const std::filesystem::path& path, int joints = 6);

/// The same of a table that was read already.
Recording recording_of(const NumberTable& table, int joints = 6);

/// Writes a recording, whole or not at all, with numbers that read back to the same bits. Throws
/// InputError where the file cannot be written, std::invalid_argument for a recording that
/// `read_recording` would refuse: times that do not increase, a group of the wrong size,
/// groups of unlike numbers of joints, infinities.
void write_recording(const std::filesystem::path& path, const Recording& recording);

/// The group a command cannot do without; throws InputError, naming its columns, where the
/// recording lacks it or a sample in it is missing.
const Samples& require(const Recording& recording, const std::optional<Samples>& group,
                       std::string_view columns);

}  // namespace flexcomp::recording
