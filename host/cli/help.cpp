#include "cli/help.hpp"

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "cli/command.hpp"
#include "cli/effects_help.hpp"
#include "error.hpp"

namespace flexcomp::cli {
namespace {

/// "FLOAT in [0 - 1]" of CLI11's "FLOAT:FLOAT in [0 - 1]".
std::string value_name(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const std::size_t colon = name.find(':');
  const bool is_twice =
      colon != std::string::npos && name.compare(colon + 1, colon, name, 0, colon) == 0;
  return is_twice ? name.substr(colon + 1) : name;
}

/// A required option has no default, and an empty list says nothing.
std::string default_text(const CLI::Option& option) {
  const std::string text = option.get_default_str();
  return text.empty() || text == "[]" || option.get_required() ? "" : "=" + text;
}

std::string count_text(const CLI::Option& option) {
  if (option.get_expected_max() == CLI::detail::expected_max_vector_size) {
    return " ...";
  }
  return option.get_expected_min() > 1 ? fmt::format(" x {}", option.get_expected()) : "";
}

const CLI::App* find_command(const CLI::App* app, const std::vector<std::string>& words,
                             std::string* before) {
  for (const std::string& word : words) {
    const auto is_asked_for = [&](const CLI::App* each) { return each->get_name() == word; };
    const std::vector<const CLI::App*> found = app->get_subcommands(is_asked_for);
    *before += (before->empty() ? "" : " ") + app->get_name();
    if (found.empty()) {
      throw InputError(
          fmt::format("'{}' has no command '{}' (see {} --help)", *before, word, *before));
    }
    app = found.front();
  }
  return app;
}

int show(const CLI::App* app, const std::vector<std::string>& words) {
  if (words.size() == 1 && !words.front().empty()) {
    const std::string effects = effects_help(words.front() == "effects" ? "" : words.front());
    if (!effects.empty()) {
      fmt::print("{}", effects);
      return kDone;
    }
  }
  std::string before;
  const CLI::App* command = find_command(app, words, &before);
  const std::string name = before + (before.empty() ? "" : " ") + command->get_name();
  fmt::print("{}", command->get_formatter()->make_help(command, name, CLI::AppFormatMode::Normal));
  return kDone;
}

}  // namespace

std::string OptionFormat::make_option_opts(const CLI::Option* option) const {
  std::string text;
  if (option->get_type_size() != 0) {
    text = fmt::format(" {}{}{}{}", value_name(*option), default_text(*option), count_text(*option),
                       option->get_required() ? " REQUIRED" : "");
  }
  for (const CLI::Option* other : option->get_needs()) {
    text += fmt::format(" (with {})", other->get_name());
  }
  return text;
}

void require_without_subcommand(CLI::App* command, const std::vector<CLI::Option*>& options) {
  for (CLI::Option* option : options) {
    option->required();
  }
  for (CLI::App* subcommand : command->get_subcommands(nullptr)) {
    subcommand->preparse_callback([options](std::size_t) {
      for (CLI::Option* option : options) {
        option->required(false);
      }
    });
  }
}

void add_help(CLI::App* app, Action* action) {
  CLI::App* command = app->add_subcommand(
      "help",
      "What a command does and takes, as --help after it says too. `help effects` lists the "
      "effects\n"
      "that a robot.yaml may have, with their parameters; the name of one shows it alone.\n"
      "Example: flexcomp help table");
  auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *words, "and its subcommand")->type_name("COMMAND");
  command->callback([=] { *action = [=] { return show(app, *words); }; });
}

}  // namespace flexcomp::cli
