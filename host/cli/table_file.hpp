#pragma once

#include <filesystem>
#include <vector>

#include "flexcomp/table.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {

/// A table read from a file, with the memory it lies in.
struct TableFile {
  std::vector<std::uint32_t> words;
  Table table;
};

/// Reads and checks a table; throws InputError saying what is wrong with the file, or that it was
/// made for another robot.
TableFile read_table(const std::filesystem::path& path, const model::Robot& robot);

}  // namespace flexcomp::cli
