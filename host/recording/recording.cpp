#include "recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "model/chain.hpp"
#include "recording/csv.hpp"

namespace flexcomp::recording {
namespace {

using Group = std::optional<Samples> Recording::*;

struct Columns {
  Group group;
  std::vector<std::string> names;
};

std::vector<std::string> numbered(const std::string& prefix, int joints) {
  std::vector<std::string> names;
  for (int joint = 1; joint <= joints; ++joint) {
    names.push_back(fmt::format("{}_{}", prefix, joint));
  }
  return names;
}

/// The groups of a robot of so many joints, in the order in which they are written.
std::vector<Columns> layout(int joints) {
  return {
      {&Recording::q_cmd, numbered("q_cmd", joints)},
      {&Recording::q_meas, numbered("q_meas", joints)},
      {&Recording::q_link, numbered("q_link", joints)},
      {&Recording::tau, numbered("tau", joints)},
      {&Recording::wrench, {"fx", "fy", "fz", "mx", "my", "mz"}},
      {&Recording::position, {"x", "y", "z"}},
      {&Recording::temperature, {"temp_c"}},
      {&Recording::program_line, {"line"}},
  };
}

/// Joints of a recording by the first of its groups that tells; as many as any robot has if none
/// does.
int joints_of(const Recording& recording) {
  for (const Group group :
       {&Recording::q_cmd, &Recording::q_meas, &Recording::q_link, &Recording::tau}) {
    if (recording.*group) {
      return static_cast<int>((recording.*group)->cols());
    }
  }
  return model::kMostJoints;
}

std::optional<std::size_t> find_column(const NumberTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - table.columns.begin());
}

void refuse_unknown_columns(const NumberTable& table, const std::vector<Columns>& groups,
                            int joints) {
  for (const std::string& column : table.columns) {
    bool known = column == "t";
    for (const Columns& group : groups) {
      known = known || std::count(group.names.begin(), group.names.end(), column) > 0;
    }
    if (!known) {
      const std::string all = joints == 1 ? "1" : fmt::format("1..{}", joints);
      throw InputError(
          fmt::format("{0}:1: column '{1}' is unknown; expected t, q_cmd_{2}, q_meas_{2}, "
                      "q_link_{2}, tau_{2}, fx..mz, x,y,z, temp_c or line",
                      table.file, files::one_line(column), all));
    }
  }
}

Eigen::VectorXd read_time(const NumberTable& table) {
  const auto column = find_column(table, "t");
  if (!column) {
    throw InputError(fmt::format("{}:1: column 't' is missing", table.file));
  }
  Eigen::VectorXd time(static_cast<Eigen::Index>(table.rows.size()));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double t = table.rows[row][*column];
    if (std::isnan(t)) {
      throw InputError(
          fmt::format("{}:{}: column 't': a time is missing", table.file, table.line(row)));
    }
    if (row > 0 && t <= table.rows[row - 1][*column]) {
      throw InputError(fmt::format("{}:{}: column 't': time must increase, found {} after {}",
                                   table.file, table.line(row), t, table.rows[row - 1][*column]));
    }
    time[static_cast<Eigen::Index>(row)] = t;
  }
  return time;
}

std::optional<Samples> read_group(const NumberTable& table, const std::vector<std::string>& names) {
  std::vector<std::size_t> columns;
  std::string missing;
  for (const std::string& name : names) {
    if (const auto column = find_column(table, name)) {
      columns.push_back(*column);
    } else {
      missing = name;
    }
  }
  if (columns.empty()) {
    return std::nullopt;
  }
  if (!missing.empty()) {
    throw InputError(fmt::format("{}:1: column '{}' is missing; {} to {} belong together",
                                 table.file, missing, names.front(), names.back()));
  }
  Samples samples(static_cast<Eigen::Index>(table.rows.size()),
                  static_cast<Eigen::Index>(columns.size()));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      samples(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) =
          table.rows[row][columns[i]];
    }
  }
  return samples;
}

[[noreturn]] void fail_to_write(const std::string& what) {
  throw std::invalid_argument("a recording to be written " + what);
}

/// A recording that could not be read back is a fault of the program that made it.
void check_readable(const Recording& recording) {
  if (recording.size() == 0) {
    fail_to_write("has no rows");
  }
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    if (!std::isfinite(recording.time[row]) ||
        (row > 0 && recording.time[row] <= recording.time[row - 1])) {
      fail_to_write("has a time that does not increase");
    }
  }
  const int joints = joints_of(recording);
  if (joints < 1 || joints > model::kMostJoints) {
    fail_to_write(fmt::format("has {} joints", joints));
  }
  for (const Columns& group : layout(joints)) {
    const std::optional<Samples>& samples = recording.*group.group;
    if (samples && (samples->rows() != recording.size() ||
                    samples->cols() != static_cast<Eigen::Index>(group.names.size()))) {
      fail_to_write(fmt::format("has {}×{} samples from {} on, not {}×{}", samples->rows(),
                                samples->cols(), group.names.front(), recording.size(),
                                group.names.size()));
    }
    if (samples && (samples->array().abs() > kLargestCell).any()) {
      fail_to_write(
          fmt::format("has a sample beyond {:g} from {} on", kLargestCell, group.names.front()));
    }
  }
}

}  // namespace

const Samples* Recording::angles() const { return q_meas ? &*q_meas : q_cmd ? &*q_cmd : nullptr; }

std::string Recording::place(Eigen::Index row) const {
  const auto index = static_cast<std::size_t>(row);
  return index < lines.size() ? fmt::format("{}:{}", file, lines[index])
                              : fmt::format("{}: row {}", file, row + 1);
}

bool counts_rows(const Eigen::VectorXd& time) {
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    if (time[i] != static_cast<double>(i)) {
      return false;
    }
  }
  return true;
}

Recording read_recording(const std::filesystem::path& path, int joints) {
  return recording_of(read_csv(path), joints);
}

Recording recording_of(const NumberTable& table, int joints) {
  const std::vector<Columns> groups = layout(joints);
  refuse_unknown_columns(table, groups, joints);
  Recording recording;
  recording.file = table.file;
  recording.lines = table.lines;
  recording.time = read_time(table);
  for (const Columns& group : groups) {
    recording.*group.group = read_group(table, group.names);
  }
  return recording;
}

void write_recording(const std::filesystem::path& path, const Recording& recording) {
  check_readable(recording);
  files::write_file(path, [&](std::ostream& stream) {
    std::string line = "t";
    const std::vector<Columns> groups = layout(joints_of(recording));
    for (const Columns& group : groups) {
      if (recording.*group.group) {
        for (const std::string& name : group.names) {
          line += "," + name;
        }
      }
    }
    stream << line << '\n';
    for (Eigen::Index row = 0; row < recording.size(); ++row) {
      line.clear();
      append_number(recording.time[row], &line);
      for (const Columns& group : groups) {
        const std::optional<Samples>& samples = recording.*group.group;
        for (Eigen::Index column = 0; samples && column < samples->cols(); ++column) {
          line += ',';
          append_number((*samples)(row, column), &line);
        }
      }
      stream << line << '\n';
    }
  });
}

const Samples& require(const Recording& recording, const std::optional<Samples>& group,
                       std::string_view columns) {
  if (!group) {
    throw InputError(fmt::format("{}: columns {} are needed", recording.file, columns));
  }
  for (Eigen::Index row = 0; row < group->rows(); ++row) {
    if (!group->row(row).allFinite()) {
      throw InputError(fmt::format("{}: a sample of {} is missing; all are needed",
                                   recording.place(row), columns));
    }
  }
  return *group;
}

}  // namespace flexcomp::recording
