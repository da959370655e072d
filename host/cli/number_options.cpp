#include "cli/number_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace flexcomp::cli {
namespace {

/// `shown`: in the help, behind the kind of number.
template <typename IsInRange>
CLI::Validator expecting(const char* what, const char* shown, IsInRange is_in_range) {
  return {[=](std::string& text) {
            double value = 0;
            const bool is_good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                                 is_in_range(value);
            return is_good ? std::string() : std::string("expected ") + what + ", not " + text;
          },
          shown};
}

/// By what the help shows for its value: a number, or several with names of their own.
bool takes_numbers(const CLI::Option& option) {
  constexpr std::array<const char*, 3> kShown = {"FLOAT", "X,Y,Z", "T,R,A"};
  return std::any_of(kShown.begin(), kShown.end(), [&option](const char* name) {
    return option.get_type_name().rfind(name, 0) == 0;
  });
}

}  // namespace

CLI::Validator above_zero() {
  return expecting("a number above zero", "POSITIVE", [](double value) { return value > 0; });
}

CLI::Validator zero_or_above() {
  return expecting("a number of zero or above", "NONNEGATIVE",
                   [](double value) { return value >= 0; });
}

void expect_finite_numbers(CLI::App* command) {
  for (CLI::Option* option : command->get_options()) {
    if (takes_numbers(*option)) {
      option->check(expecting("a finite number", "", [](double) { return true; }));
    }
  }
  for (CLI::App* subcommand : command->get_subcommands(nullptr)) {
    expect_finite_numbers(subcommand);
  }
}

}  // namespace flexcomp::cli
