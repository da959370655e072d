#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/position_columns.hpp"
#include "error.hpp"
#include "geometry/circular_test.hpp"
#include "geometry/flatness.hpp"
#include "geometry/polar_profile.hpp"
#include "geometry/straightness.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;

struct FormOptions {
  std::string path;
  std::string other;
  std::vector<std::string> columns;
  double radius = 0;
  double filter = 0;
  bool json = false;
};

/// Result of `measure`; its complaints get the file's name before them.
template <typename Measure>
auto measured(const std::string& file, const Measure& measure) {
  try {
    return measure();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

void print(const FormOptions& options, const Json& json, const std::string& text) {
  fmt::print("{}", options.json ? json.dump(2) + "\n" : text);
}

void print_form(const FormOptions& options, const char* form, const char* norm, std::size_t points,
                double least_squares, double zone) {
  print(options,
        {{"points", points},
         {"least_squares", least_squares},
         {"minimum_zone", zone},
         {"filter", nullptr}},
        fmt::format("{} of {} points ({}, no filter), mm\n"
                    "least squares  {:.6f}\nminimum zone   {:.6f}\n",
                    form, points, norm, 1e3 * least_squares, 1e3 * zone));
}

int run_straightness(const FormOptions& options) {
  const recording::NumberTable table = recording::read_csv(options.path);
  const geometry::Points points = points_in(table, plane_columns(table, options.columns));
  return measured(options.path, [&] {
    print_form(options, "straightness", "ISO 12780-1", points.size(),
               geometry::least_squares_straightness(points).value(),
               geometry::minimum_zone_straightness(points).value());
    return kDone;
  });
}

int run_flatness(const FormOptions& options) {
  const recording::NumberTable table = recording::read_csv(options.path);
  const geometry::SpacePoints points = points_in_space(table);
  return measured(options.path, [&] {
    print_form(options, "flatness", "ISO 12781-1", points.size(),
               geometry::least_squares_flatness(points).value(),
               geometry::minimum_zone_flatness(points).value());
    return kDone;
  });
}

/// The points of one direction of a circular test, filtered if that is asked for.
geometry::Points circle_points(const FormOptions& options, const std::string& file) {
  const recording::NumberTable table = recording::read_csv(file);
  const geometry::Points points = points_in(table, plane_columns(table, options.columns));
  return measured(file, [&] {
    return options.filter != 0 ? geometry::filtered(points, options.filter) : points;
  });
}

int run_circular(const FormOptions& options) {
  const geometry::CircularTest test = geometry::circular_test(
      circle_points(options, options.path), circle_points(options, options.other), options.radius);
  const std::string filter =
      options.filter > 0
          ? fmt::format("Gaussian filter, {:g} undulations per revolution", options.filter)
          : std::string("no filter");
  print(options,
        {{"radius", options.radius},
         {"filter", options.filter > 0 ? Json(options.filter) : Json(nullptr)},
         {"circular_deviation", {{"cw", test.clockwise}, {"ccw", test.counterclockwise}}},
         {"bidirectional_circular_deviation", test.bidirectional},
         {"circular_hysteresis", test.hysteresis},
         {"mean_bidirectional_radial_deviation", test.mean_radial},
         {"radial_deviation",
          {{"cw", {test.clockwise_least, test.clockwise_most}},
           {"ccw", {test.counterclockwise_least, test.counterclockwise_most}}}}},
        fmt::format("circular test (ISO 230-4, {}), mm\n"
                    "circular deviation G            clockwise {:.6f}, counterclockwise {:.6f}\n"
                    "bidirectional deviation G(b)    {:.6f}\n"
                    "circular hysteresis H           {:.6f}\n"
                    "mean radial deviation D         {:.6f}\n"
                    "radial deviation F              clockwise {:.6f} to {:.6f}, "
                    "counterclockwise {:.6f} to {:.6f}\n",
                    filter, 1e3 * test.clockwise, 1e3 * test.counterclockwise,
                    1e3 * test.bidirectional, 1e3 * test.hysteresis, 1e3 * test.mean_radial,
                    1e3 * test.clockwise_least, 1e3 * test.clockwise_most,
                    1e3 * test.counterclockwise_least, 1e3 * test.counterclockwise_most));
  return kDone;
}

}  // namespace

void add_form(CLI::App* app, Action* action) {
  auto options = std::make_shared<FormOptions>();
  CLI::App* form = app->add_subcommand(
      "form",
      "Straightness, flatness, and circles run both ways; circularity has its own command.");
  form->require_subcommand(1);
  const auto add_columns = [&](CLI::App* command) {
    command->add_option("--columns", options->columns, "the two columns of the plane")
        ->delimiter(',')
        ->expected(2);
  };
  const auto add_json = [&](CLI::App* command) {
    command->add_flag("--json", options->json, "one JSON object, lengths in m");
  };

  CLI::App* straightness = form->add_subcommand(
      "straightness",
      "How straight a profile is, about the least-squares line and between the closest two\n"
      "parallel lines (ISO 12780-1), exactly. No filter is applied.\n"
      "Example: flexcomp form straightness recording.csv --columns x,z");
  straightness->add_option("path", options->path, "CSV with position columns in m")->required();
  add_columns(straightness);
  add_json(straightness);
  straightness->callback([=] { *action = [=] { return run_straightness(*options); }; });

  CLI::App* flatness = form->add_subcommand(
      "flatness",
      "How flat a surface is, about the least-squares plane and between the closest two parallel\n"
      "planes (ISO 12781-1), exactly. No filter is applied.\n"
      "Example: flexcomp form flatness surface.csv");
  flatness->add_option("path", options->path, "CSV with x, y, z in m")->required();
  add_json(flatness);
  flatness->callback([=] { *action = [=] { return run_flatness(*options); }; });

  CLI::App* circle = form->add_subcommand(
      "circle",
      "A circle run clockwise and counterclockwise (ISO 230-4): circular deviation G each way and\n"
      "both ways, hysteresis H, mean radial deviation D, radial deviation F.\n"
      "Example: flexcomp form circle --cw cw.csv --ccw ccw.csv --radius 0.1 --columns x,z");
  circle->add_option("--cw", options->path, "CSV of the clockwise circle")->required();
  circle->add_option("--ccw", options->other, "CSV of the counterclockwise circle")->required();
  circle->add_option("--radius", options->radius, "nominal radius, m")->required();
  circle->add_option("--filter", options->filter,
                     "Gaussian filter (ISO 16610-21): cut-off, undulations per revolution");
  add_columns(circle);
  add_json(circle);
  circle->callback([=] { *action = [=] { return run_circular(*options); }; });
}

}  // namespace flexcomp::cli
