#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.hpp"
#include "cli/frame_option.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "model/frame_numbers.hpp"
#include "planning/program_correction.hpp"
#include "programs/read_program.hpp"
#include "recording/plausible_angles.hpp"

namespace flexcomp::cli {
namespace {

struct ExportOptions {
  RobotChoice model;
  std::string program;
  std::string path;
  std::string corrected;
  std::string out;
  double tolerance = 5e-6;
  bool json = false;
};

/// A name that KRL and RAPID take: letters, digits and underscores, a letter first, 24 at most.
std::string module_name(const std::filesystem::path& file) {
  std::string name;
  for (const char c : file.stem().string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    name += is_plain ? c : '_';
  }
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) {
    name.insert(0, "p");
  }
  constexpr std::size_t kLongest = 24;
  return name.substr(0, kLongest);
}

std::optional<programs::CarriedTool> carried_tool(const model::Robot& robot) {
  if (!robot.tool) {
    return std::nullopt;
  }
  return programs::CarriedTool{robot.tool->mounting(), robot.tool->mass,
                               Vector3<double>(robot.tool->com.data())};
}

std::string correction_line(const ExportOptions& options,
                            const programs::CorrectedProgram& program) {
  return program.largest_correction > 0
             ? fmt::format("largest correction {:.3g} mm\n", 1e3 * program.largest_correction)
             : fmt::format("nothing is corrected: {} has the angles of {}\n", options.corrected,
                           options.path);
}

/// What a KRL program's own approximation does to points that it did not have.
std::string passing_line(const programs::CorrectedProgram& program, programs::Format format,
                         std::size_t added) {
  const bool is_its_own =
      format == programs::Format::krl && program.source.format == programs::Format::krl;
  return is_its_own && added > 0
             ? "the points added are passed as near as the program's own $APO.CDIS or LDAT says: a "
               "large one rounds them by more than --tolerance\n"
             : "";
}

int run(const ExportOptions& options) {
  if (!(options.tolerance > 0)) {
    throw InputError("--tolerance: expected a length above zero");
  }
  const programs::Format format = programs::format_of(options.out);
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  programs::CorrectedProgram corrected = planning::correct_program(
      elastic, programs::read_program(options.program),
      recording::read_recording_of(robot.elastic, options.path),
      recording::read_recording_of(robot.elastic, options.corrected), options.tolerance);
  corrected.tool = carried_tool(robot);
  files::write_text(options.out, programs::text_of(corrected, format, module_name(options.out)));
  std::size_t points = 0;
  for (const auto& motions : corrected.in_place) {
    points += motions.size();
  }
  const std::size_t own = corrected.source.motions.size();
  const std::array<double, 6> frame = model::frame_numbers(corrected.frame);
  if (options.json) {
    const nlohmann::ordered_json json = {{"motions", own},
                                         {"added", points - own},
                                         {"largest_correction", corrected.largest_correction},
                                         {"frame", frame}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(
        "{}: {} motions, {} points added where the correction bends\n{}{}work frame {:.6g}\n",
        options.out, own, points - own, correction_line(options, corrected),
        passing_line(corrected, format, points - own), fmt::join(frame, ","));
  }
  return kDone;
}

}  // namespace

void add_export(CLI::App* app, Action* action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app->add_subcommand(
      "export",
      "The corrected program, for a robot without an interface for corrections while it runs: KUKA "
      "KRL\n"
      "(.src), ABB RAPID (.mod), CSV or G-code, by the ending of --out. In the program's own "
      "format "
      "all\n"
      "that does not move stays as it is, comments too; points are added only where the correction "
      "bends.\n"
      "Example: flexcomp export --model robot.yaml --program pocket.nc --path path.csv\n"
      "  --corrected corrected.csv --out pocket.src");
  add_robot(command, &options->model)->required();
  command->add_option("--program", options->program, "that the path was planned from")->required();
  command->add_option("--path", options->path, "of flexcomp plan program, or place after it")
      ->required();
  command->add_option("--corrected", options->corrected, "of flexcomp compensate")->required();
  command->add_option("--out", options->out, "program to write")->required();
  command->add_option("--tolerance", options->tolerance,
                      "m, by which the program may pass the correction's bends");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
