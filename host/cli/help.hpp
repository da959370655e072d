#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace flexcomp::cli {

/// How --help and `flexcomp help` show an option: its value as a word or a range, its default where
/// it has one that says something, and REQUIRED.
class OptionFormat : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

/// Makes options required of a command itself, but not of its subcommands. To be called when it has
/// them all.
void require_without_subcommand(CLI::App* command, const std::vector<CLI::Option*>& options);

}  // namespace flexcomp::cli
