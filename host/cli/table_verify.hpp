#pragma once

#include "cli/command.hpp"

namespace flexcomp::cli {

/// `flexcomp table verify`, below `flexcomp table`.
CLI::App* add_table_verify(CLI::App* table, Action* action);

}  // namespace flexcomp::cli
