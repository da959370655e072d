#include "cli/robot_choice.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "effects/learned.hpp"
#include "model/tool.hpp"

namespace flexcomp::cli {
namespace {

/// A file's name may hold a colon: as a whole it goes before.
model::Tool load_tool(const std::string& choice) {
  const std::size_t colon = choice.rfind(':');
  std::error_code error;
  if (colon == std::string::npos || std::filesystem::exists(choice, error)) {
    return model::load_tool(choice, "");
  }
  return model::load_tool(choice.substr(0, colon), choice.substr(colon + 1));
}

}  // namespace

CLI::Option* add_model(CLI::App* command, RobotChoice* choice, const std::string& help) {
  return command->add_option("--model", choice->file, help);
}

CLI::Option* add_robot(CLI::App* command, RobotChoice* choice) {
  CLI::Option* model = add_model(command, choice);
  command
      ->add_option("--tool", choice->tool,
                   "FILE:NAME of a file of named tools, in place of the robot's own tool")
      ->needs(model);
  return model;
}

model::Robot load_robot(const RobotChoice& choice) {
  model::Robot robot = choice.tool.empty() ? model::load_robot(choice.file)
                                           : model::load_robot(choice.file, load_tool(choice.tool));
  effects::listed_effects(robot);  // refuses what the reader, which knows no physics, cannot judge
  return robot;
}

std::string describe(const RobotChoice& choice) {
  return choice.tool.empty() ? fmt::format("--model {}", choice.file)
                             : fmt::format("--model {} --tool {}", choice.file, choice.tool);
}

}  // namespace flexcomp::cli
