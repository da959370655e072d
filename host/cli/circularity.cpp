#include "geometry/circularity.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/position_columns.hpp"
#include "error.hpp"
#include "geometry/polar_profile.hpp"

namespace flexcomp::cli {
namespace {

struct CircularityOptions {
  std::string path;
  std::vector<std::string> columns;
  double filter = 0;
  bool json = false;
};

struct Method {
  const char* key;
  const char* name;
  geometry::Circularity (*measure)(const geometry::Points&);
};

constexpr Method kMethods[] = {
    {"lsc", "LSC  least squares", geometry::least_squares_circularity},
    {"mzc", "MZC  minimum zone", geometry::minimum_zone_circularity},
    {"mic", "MIC  maximum inscribed", geometry::maximum_inscribed_circularity},
    {"mcc", "MCC  minimum circumscribed", geometry::minimum_circumscribed_circularity},
};

/// The path, filtered if that is asked for.
geometry::Points points_of(const recording::NumberTable& table, const CircularityOptions& options) {
  const geometry::Points points = points_in(table, plane_columns(table, options.columns));
  try {
    return options.filter == 0 ? points : geometry::filtered(points, options.filter);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", options.path, error.what()));
  }
}

std::string filter_name(double cutoff) {
  return cutoff > 0 ? fmt::format(", Gaussian filter of {:g} undulations per revolution", cutoff)
                    : std::string(", no filter");
}

int run(const CircularityOptions& options) {
  const recording::NumberTable table = recording::read_csv(options.path);
  const geometry::Points points = points_of(table, options);
  nlohmann::ordered_json json = {{"points", points.size()}};
  if (options.filter > 0) {
    json["filter"] = options.filter;
  }
  std::string text =
      fmt::format("{} points{}; mm\n{:28} {:>13} {:>13} {:>13}   center\n", points.size(),
                  filter_name(options.filter), "", "circularity", "r_min", "r_max");
  for (const Method& method : kMethods) {
    geometry::Circularity result;
    try {
      result = method.measure(points);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", options.path, error.what()));
    }
    json[method.key] = {{"center", {result.center.x(), result.center.y()}},
                        {"r_min", result.r_min},
                        {"r_max", result.r_max},
                        {"circularity", result.value()}};
    text += fmt::format("{:28} {:13.6f} {:13.6f} {:13.6f}   ({:.6f}, {:.6f})\n", method.name,
                        1e3 * result.value(), 1e3 * result.r_min, 1e3 * result.r_max,
                        1e3 * result.center.x(), 1e3 * result.center.y());
  }
  fmt::print("{}", options.json ? json.dump(2) + "\n" : text);
  return kDone;
}

}  // namespace

void add_circularity(CLI::App* app, Action* action) {
  auto options = std::make_shared<CircularityOptions>();
  CLI::App* command = app->add_subcommand(
      "circularity",
      "How round a path is, about the four reference circles of ISO 12181-1, exactly.\n"
      "Without --filter every point counts.\n"
      "Example: flexcomp circularity recording.csv --columns x,z --json");
  command->add_option("path", options->path, "CSV with a header and position columns in m")
      ->required();
  command->add_option("--columns", options->columns, "the two columns of the circle's plane")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--filter", options->filter,
                      "Gaussian filter (ISO 16610-21): cut-off, undulations per revolution");
  command->add_flag("--json", options->json, "one JSON object, lengths in m");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
