#pragma once

#include <CLI/CLI.hpp>

namespace flexcomp::cli {

/// Ranges of an option's number. CLI11's own let nan pass, and name the largest double in digits.
CLI::Validator above_zero();
CLI::Validator zero_or_above();

/// Every option of a command and of its subcommands that takes numbers takes finite ones only. To
/// be called when it has them all.
void expect_finite_numbers(CLI::App* command);

}  // namespace flexcomp::cli
