#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "cli/command.hpp"
#include "cli/map_volume.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "model/robot.hpp"
#include "report/gnuplot.hpp"
#include "study/circularity_map.hpp"
#include "study/map_picture.hpp"
#include "study/presets.hpp"
#include "study/section_map.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MapOptions {
  RobotChoice model;
  std::string out;
  std::string preset = "strict";
  std::string plane = "xz";
  std::string sense;
  std::array<double, 3> force{};
  std::array<double, 3> moment{};
  double radius = 0.1;
  double step = 0.05;
  int points = 72;
  std::vector<double> regions = {0.1, 0.2, 0.5};
  std::vector<double> volume;
  std::vector<double> tool_axes = {0, 0, -1};
  bool has_force = false;
  bool has_moment = false;
  bool first_order = false;
  bool no_limits = false;
  bool json = false;
};

study::MilledCircle circle_of(const MapOptions& options) {
  study::MilledCircle circle = study::preset(options.preset).circle;
  circle.radius = options.radius;
  circle.points = options.points;
  circle.force = options.has_force ? Vector3<double>(options.force.data()) : circle.force;
  circle.moment = options.has_moment ? Vector3<double>(options.moment.data()) : circle.moment;
  circle.is_first_order = circle.is_first_order || options.first_order;
  circle.has_limits = !options.no_limits;
  if (!options.sense.empty()) {
    circle.sense =
        options.sense == "with" ? study::WrenchSense::with_path : study::WrenchSense::against_path;
  }
  return circle;
}

/// A map with all that is told of it.
struct Study {
  study::MilledCircle circle;
  std::optional<study::PlanarArm> arm;  ///< whose map it is, if it is of one
  study::CircularityMap map;
  study::MapSummary summary;
  std::vector<study::BestSquare> squares;

  bool is_counter() const {
    return arm && circle.is_first_order && circle.sense == study::WrenchSense::against_path;
  }
  double middle() const {
    return is_counter() ? study::counter_middle(*arm, circle) : summary.mean;
  }
};

Study study_of(const RobotModel<double, 6>& elastic, const MapOptions& options) {
  Study study;
  study.circle = circle_of(options);
  Progress progress("mapping", 1000);
  const auto show = [&](std::size_t done, std::size_t count) {
    progress.show(1000 * done / count);
  };
  if (options.plane == "xz") {
    const study::CircleStudy at(elastic, study.circle);
    study.arm = at.arm();
    study.map = study::map_circularity(at, options.step, show);
  } else {
    study.circle.point = study::ToolPoint::tcp;
    const Vector3<double> tool_axis =
        options.plane == "xy" ? Vector3<double>(0, 0, -1) : Vector3<double>(1, 0, 0);
    study.map = study::map_section(elastic, study.circle, tool_axis, options.step, show);
  }
  study.summary = study::summarize(study.map);
  for (const double size : options.regions) {
    study.squares.push_back(study::best_square(study.map, size));
  }
  return study;
}

Json summary_json(const model::Robot& robot, const MapOptions& options, const Study& study) {
  const study::MilledCircle& circle = study.circle;
  Json regions = Json::array();
  for (const study::BestSquare& square : study.squares) {
    regions.push_back(
        square.fits
            ? Json{{"size", square.size}, {"x", square.x}, {"z", square.z}, {"worst", square.worst}}
            : Json{{"size", square.size}, {"x", nullptr}, {"z", nullptr}, {"worst", nullptr}});
  }
  return {{"schema", "flexcomp/map/1"},
          {"robot", robot.name},
          {"preset", options.preset},
          {"plane", options.plane},
          {"radius", circle.radius},
          {"force", {circle.force[0], circle.force[1], circle.force[2]}},
          {"moment", {circle.moment[0], circle.moment[1], circle.moment[2]}},
          {"point", circle.point == study::ToolPoint::wrist ? "wrist" : "tcp"},
          {"wrench_sense", circle.sense == study::WrenchSense::with_path ? "with" : "against"},
          {"first_order", circle.is_first_order},
          {"joint_limits", circle.has_limits},
          {"step", study.map.step},
          {"nodes_in_reach", study.summary.reached},
          {"min", study.summary.min},
          {"max", study.summary.max},
          {"mean", study.summary.mean},
          {"median", study.summary.median},
          {"middle", study.middle()},
          {"middle_is",
           study.is_counter() ? "mean over the distance from joint 2" : "mean over the area"},
          {"regions", regions}};
}

void write_csv(const std::filesystem::path& file, const study::CircularityMap& map) {
  files::write_file(file, [&](std::ostream& out) {
    out << "x,z,circularity\n";
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const double value = map.at(column, row);
        out << fmt::format("{:.9g},{:.9g},{}\n", map.x(column), map.z(row),
                           std::isnan(value) ? "" : fmt::format("{:.9g}", value));
      }
    }
  });
}

void print_summary(const model::Robot& robot, const MapOptions& options, const Study& study) {
  const auto mm = [](double metres) { return 1e3 * metres; };
  const study::MilledCircle& circle = study.circle;
  fmt::print("{}, preset {}: circles in {} of the {}{}, {:g}, {:g}, {:g} N turning {} the path\n",
             robot.name, options.preset, options.plane,
             circle.point == study::ToolPoint::wrist ? "wrist centre" : "TCP",
             circle.is_first_order ? " to first order" : "", circle.force[0], circle.force[1],
             circle.force[2], circle.sense == study::WrenchSense::with_path ? "with" : "against");
  fmt::print("circularity (least squares), mm: min {:.3f}, max {:.3f}, middle {:.3f}\n",
             mm(study.summary.min), mm(study.summary.max), mm(study.middle()));
  for (const study::BestSquare& square : study.squares) {
    fmt::print("best place for {:g} × {:g} mm: {}\n", mm(square.size), mm(square.size),
               square.fits ? fmt::format("x {:.3f} m, z {:.3f} m, at most {:.3f} mm", square.x,
                                         square.z, mm(square.worst))
                           : "none in reach");
  }
}

study::VolumeRequest volume_request(const MapOptions& options) {
  study::VolumeRequest request;
  request.lower = {options.volume[0], options.volume[2], options.volume[4]};
  request.upper = {options.volume[1], options.volume[3], options.volume[5]};
  request.step = options.step;
  request.circle = circle_of(options);
  if (options.tool_axes.size() % 3 != 0) {
    throw InputError("--tool-axes: expected three numbers for each direction");
  }
  for (std::size_t i = 0; i < options.tool_axes.size(); i += 3) {
    request.tool_axes.emplace_back(options.tool_axes[i], options.tool_axes[i + 1],
                                   options.tool_axes[i + 2]);
  }
  return request;
}

int run(const MapOptions& options) {
  for (const double size : options.regions) {
    if (!(size > 0) || !std::isfinite(size)) {
      throw InputError("--region: expected sides above zero");
    }
  }
  const model::Robot robot = load_robot(options.model);
  if (!options.volume.empty()) {
    return map_volume(robot, volume_request(options), options.out, options.json);
  }
  if (study::ranks_from_environment().rank != 0) {
    return kDone;  // a plane is done before processes could share it
  }
  const Study study = study_of(model::six_axis_model(robot), options);
  const Json summary = summary_json(robot, options, study);
  const std::string script = study::map_script(
      study.map, study.arm, study.squares,
      fmt::format("{}: circularity of milled circles\\nin {}, radius {:g} mm, preset {}",
                  robot.name, options.plane, 1e3 * study.circle.radius, options.preset));
  const std::string svg = report::plot_svg(script, 900, 860);
  const std::string png = report::plot_png(script, 900, 860);
  const std::filesystem::path folder = output_folder(options.out);
  write_csv(folder / "map.csv", study.map);
  files::write_text(folder / "map.svg", svg);
  files::write_text(folder / "map.png", png);
  files::write_text(folder / "summary.json", summary.dump(2) + "\n");
  if (options.json) {
    fmt::print("{}\n", summary.dump(2));
  } else {
    print_summary(robot, options, study);
  }
  return kDone;
}

}  // namespace

void add_map(CLI::App* app, Action* action) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command = app->add_subcommand(
      "map",
      "How round circles become that the uncorrected robot mills, over the plane of joints 2 and "
      "3\n"
      "(y = 0, joints 1, 4, 5 and 6 at zero), and the best places for square jobs.\n\n"
      "Writes map.csv (x, z, circularity; m), map.svg, map.png and summary.json. The study by\n"
      "Klimchik et al. (2017) does not say all of its assumptions; a preset is one reading of it:\n"
      "  strict   wrist centre, the force of the study turning with the path (eq. 15 as written)\n"
      "  flange   flange (the model's TCP), 1104 N out of the circle, turning with the path\n"
      "  counter  wrist centre, first order, the force turning against the path\n"
      "With --volume a box of space instead, the tool across the circles, along each of "
      "--tool-axes:\n"
      "volume.csv and summary.json. An interrupted sweep goes on where it ended; mpirun shares "
      "one\n"
      "between processes that see the same folder.\n"
      "Example: flexcomp map --model robot.yaml --preset strict --out map\n"
      "         mpirun flexcomp map --model robot.yaml --volume 1,2.5,-1,1,0.5,2 --step 0.1 --out "
      "map");
  add_robot(command, &options->model)->required();
  command->add_option("--out", options->out, "folder to write to")->required();
  command->add_option("--preset", options->preset, "posture, point, force and its sense")
      ->check(CLI::IsMember({"strict", "flange", "counter"}));
  command->add_option("--radius", options->radius, "of the circles, m");
  CLI::Option* force = add_vector(command, "--force", &options->force,
                                  "N: out of the circle, along the feed, along the normal; "
                                  "otherwise the preset's");
  CLI::Option* moment = add_vector(command, "--moment", &options->moment,
                                   "N·m, in the same directions; otherwise the preset's");
  force->default_str("");
  moment->default_str("");
  command->add_option("--step", options->step, "of the grid, m");
  command->add_option("--points", options->points, "of a circle");
  command->add_option("--region", options->regions, "sides of square jobs, m")->delimiter(',');
  command->add_flag("--first-order", options->first_order,
                    "levers taken at the circle's centre all round");
  command
      ->add_option("--wrench-sense", options->sense,
                   "the wrench turns with the path or against it; otherwise the preset's")
      ->check(CLI::IsMember({"with", "against"}));
  CLI::Option* plane = command->add_option("--plane", options->plane,
                                           "that the circles lie in, their centres at y = 0. Other "
                                           "than xz: the TCP goes round, the tool "
                                           "stands across, pointing down (xy) or forward (yz)");
  plane->check(CLI::IsMember({"xz", "xy", "yz"}));
  CLI::Option* volume =
      command->add_option("--volume", options->volume, "a box, m: from and to along x, y and z");
  volume->delimiter(',')->expected(6)->excludes(plane);
  command
      ->add_option("--tool-axes", options->tool_axes,
                   "with --volume: directions of the tool, three numbers each")
      ->delimiter(',')
      ->needs(volume);
  command->add_flag("--no-limits", options->no_limits, "without joint limits");
  command->add_flag("--json", options->json, "print summary.json");
  command->callback([=] {
    options->has_force = force->count() > 0;
    options->has_moment = moment->count() > 0;
    *action = [=] { return run(*options); };
  });
}

}  // namespace flexcomp::cli
