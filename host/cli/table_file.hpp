#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "flexcomp/table_builder.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {

/// A table read from a file, with the memory it lies in.
struct TableFile {
  std::vector<std::uint32_t> words;
  Table table;
};

/// A certificate, derived again from a table's own content.
struct Certificate {
  TableError<double> error;    ///< on the chords between the nodes; of a grid everywhere
  TableError<double> inside;   ///< path: at all angles that a tick takes for inside
  bool states_inside = false;  ///< Does the header state the second? Older tables do not.
  bool inside_holds = false;   ///< Does it state no less than was found, or nothing?
  bool holds = false;          ///< Does the header state no less in all that it states?
};

/// Reads a table, whatever robot it is of; throws InputError for what is no table, or damaged.
TableFile read_any_table(const std::filesystem::path& path);

/// Reads a table and checks its header against the model; throws InputError saying what is wrong
/// with the file, or that it was made for another robot.
TableFile read_unproven_table(const std::filesystem::path& path, const model::Robot& robot);

/// Throws InputError, naming `path`, for records that no builder writes.
Certificate derive_certificate(const std::filesystem::path& path, const model::Robot& robot,
                               const Table& table);

/// Chart, sizes, model hash, bounds, certificates and the largest gain with what it follows from.
nlohmann::ordered_json to_json(const Table& table);

/// Same as the first, and refuses a table whose certificate does not hold: what every command that
/// corrects with a table reads it by.
TableFile read_table(const std::filesystem::path& path, const model::Robot& robot);

}  // namespace flexcomp::cli
