#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/command.hpp"

namespace flexcomp::cli {

/// A key, and the version that a table is signed as.
struct SigningOptions {
  std::string key;  ///< file; empty: not to be signed
  std::uint32_t counter = 0;
};

/// --key and --counter, each of which needs the other.
void add_signing(CLI::App* command, SigningOptions* options);

/// The bytes to write after a table: its trailer, or nothing without a key. Throws InputError
/// saying what is wrong with the key.
std::string trailer_for(const std::string& table, const SigningOptions& options);

/// The version of a table file that is signed with the key in a file. Throws InputError where it is
/// not.
std::uint32_t signed_version(const std::string& table_file, const std::string& key_file);

/// `flexcomp table sign`, below `flexcomp table`.
CLI::App* add_table_sign(CLI::App* table, Action* action);

}  // namespace flexcomp::cli
