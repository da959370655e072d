#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "study/circularity_map.hpp"
#include "study/presets.hpp"
#include "study/selection.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGravity = 9.81;  // m/s²

struct SelectOptions {
  std::vector<std::string> robots;
  std::vector<double> forces = {500, 1000, 2000, 3000};
  std::vector<double> limits = {0.2e-3, 0.5e-3, 1e-3, 1.5e-3, 2e-3};
  std::string preset = "strict";
  double square = 0.2;
  double step = 0.05;
  double radius = 0.1;
  bool json = false;
};

/// "robot.yaml" or "robot.yaml=100", the rated payload in kg.
std::pair<std::string, double> file_and_payload(const std::string& word) {
  const std::size_t sign = word.rfind('=');
  if (sign == std::string::npos) {
    return {word, std::numeric_limits<double>::infinity()};
  }
  char* end = nullptr;
  const std::string number = word.substr(sign + 1);
  const double payload = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !(payload > 0) || !std::isfinite(payload)) {
    throw InputError(fmt::format("--robot {}: expected FILE or FILE=PAYLOAD in kg", word));
  }
  return {word.substr(0, sign), payload};
}

struct Entry {
  study::Candidate candidate;
  study::BestSquare place;
};

Entry entry_of(const std::string& word, const SelectOptions& options, study::MilledCircle circle) {
  const auto [file, payload] = file_and_payload(word);
  const model::Robot robot = model::load_robot(file);
  circle.radius = options.radius;
  const study::CircleStudy at(model::six_axis_model(robot), circle);
  Progress progress("mapping " + robot.name, 1000);
  const study::CircularityMap map = study::map_circularity(
      at, options.step,
      [&](std::size_t done, std::size_t count) { progress.show(1000 * done / count); });
  return {{robot.name, study::summarize(map).min, study::study_force(), payload * kGravity},
          study::best_square(map, options.square)};
}

void check(const SelectOptions& options) {
  const auto is_size = [](double value) { return value > 0 && std::isfinite(value); };
  if (!std::all_of(options.forces.begin(), options.forces.end(), is_size) ||
      !std::all_of(options.limits.begin(), options.limits.end(), is_size) ||
      !is_size(options.square)) {
    throw InputError("--force-levels, --limits and --square must be above zero");
  }
}

Json to_json(const SelectOptions& options, const std::vector<Entry>& entries) {
  Json robots = Json::array();
  for (const Entry& entry : entries) {
    const study::BestSquare& place = entry.place;
    const double load = entry.candidate.largest_load;
    robots.push_back(
        {{"name", entry.candidate.name},
         {"min_circularity", entry.candidate.circularity},
         {"at_force", entry.candidate.at_force},
         {"largest_load", std::isfinite(load) ? Json(load) : Json(nullptr)},
         {"place",
          place.fits
              ? Json{{"size", place.size}, {"x", place.x}, {"z", place.z}, {"worst", place.worst}}
              : Json(nullptr)}});
  }
  Json table = Json::array();
  for (const double limit : options.limits) {
    for (const double force : options.forces) {
      Json suitable = Json::array();
      for (const Entry& entry : entries) {
        if (study::suits(entry.candidate, force, limit)) {
          suitable.push_back(entry.candidate.name);
        }
      }
      table.push_back({{"circularity", limit}, {"force", force}, {"robots", suitable}});
    }
  }
  return {{"schema", "flexcomp/selection/1"},
          {"preset", options.preset},
          {"robots", robots},
          {"table", table}};
}

void print(const SelectOptions& options, const std::vector<Entry>& entries) {
  fmt::print("Robots that mill to a circularity at a force, without correction (preset {}):\n\n",
             options.preset);
  for (const double limit : options.limits) {
    for (const double force : options.forces) {
      std::string names;
      for (const Entry& entry : entries) {
        if (study::suits(entry.candidate, force, limit)) {
          names += (names.empty() ? "" : ", ") + entry.candidate.name;
        }
      }
      fmt::print("{:6.2f} mm  {:6.0f} N  {}\n", 1e3 * limit, force, names.empty() ? "-" : names);
    }
  }
  fmt::print("\nBest place for {:g} × {:g} mm at the force of the study:\n", 1e3 * options.square,
             1e3 * options.square);
  for (const Entry& entry : entries) {
    const study::BestSquare& place = entry.place;
    fmt::print("{}: {}\n", entry.candidate.name,
               place.fits
                   ? fmt::format("x {:.3f} m, z {:.3f} m, at most {:.3f} mm at {:.0f} N", place.x,
                                 place.z, 1e3 * place.worst, entry.candidate.at_force)
                   : "none in reach");
  }
}

int run(const SelectOptions& options) {
  check(options);
  const study::MilledCircle& circle = study::preset(options.preset).circle;
  std::vector<Entry> entries;
  entries.reserve(options.robots.size());
  for (const std::string& word : options.robots) {
    entries.push_back(entry_of(word, options, circle));
  }
  if (options.json) {
    fmt::print("{}\n", to_json(options, entries).dump(2));
  } else {
    print(options, entries);
  }
  return kDone;
}

}  // namespace

void add_select(CLI::App* app, Action* action) {
  auto options = std::make_shared<SelectOptions>();
  CLI::App* command = app->add_subcommand(
      "select",
      "Which robots mill a circle to which circularity at which force, without correction, and\n"
      "where each does it best: the map of each (flexcomp map), its least circularity scaled with\n"
      "the force, and the weight of its payload as the largest force.\n"
      "Example: flexcomp select --robot kr100/robot.yaml=100 --robot kr500/robot.yaml=500");
  command
      ->add_option("--robot", options->robots,
                   "robot.yaml, and after = its rated payload in kg; may be given several times")
      ->required();
  command->add_option("--force-levels", options->forces, "N")->delimiter(',');
  command->add_option("--limits", options->limits, "circularities, m")->delimiter(',');
  command->add_option("--preset", options->preset, "as of flexcomp map")
      ->check(CLI::IsMember({"strict", "flange", "counter"}));
  command->add_option("--square", options->square, "side of the square job, m");
  command->add_option("--radius", options->radius, "of the circles, m");
  command->add_option("--step", options->step, "of the maps, m");
  command->add_flag("--json", options->json, "one JSON object, m and N");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
