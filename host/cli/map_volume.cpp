#include "cli/map_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "cli/command.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;
using Layers = std::vector<std::vector<double>>;

void write_csv(const std::filesystem::path& file, const study::VolumeMap& map,
               const Layers& layers) {
  files::write_file(file, [&](std::ostream& out) {
    out << "x,y,z,tool_x,tool_y,tool_z,circularity\n";
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
      const Vector3<double>& axis = map.tool_axis(layer);
      for (std::size_t i = 0; i < layers[layer].size(); ++i) {
        const Vector3<double> node = map.node(layer, i);
        const double value = layers[layer][i];
        out << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", node[0], node[1],
                           node[2], axis[0], axis[1], axis[2],
                           std::isnan(value) ? "" : fmt::format("{:.17g}", value));
      }
    }
  });
}

Json triple(const Vector3<double>& vector) { return {vector[0], vector[1], vector[2]}; }

Json summary_of(const model::Robot& robot, const study::VolumeMap& map, const Layers& layers) {
  study::CircularityMap all;
  std::size_t best_layer = 0;
  std::size_t best_index = 0;
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    for (std::size_t i = 0; i < layers[layer].size(); ++i) {
      all.circularity.push_back(layers[layer][i]);
      const double best = layers[best_layer][best_index];
      if (std::isnan(best) || layers[layer][i] < best) {
        best_layer = layer;
        best_index = i;
      }
    }
  }
  const study::MapSummary summary = study::summarize(all);
  return {{"schema", "flexcomp/volume/1"},
          {"robot", robot.name},
          {"circles", map.circles()},
          {"in_reach", summary.reached},
          {"min", summary.min},
          {"max", summary.max},
          {"mean", summary.mean},
          {"median", summary.median},
          {"best",
           {{"center", triple(map.node(best_layer, best_index))},
            {"tool_axis", triple(map.tool_axis(best_layer))},
            {"circularity", layers[best_layer][best_index]}}}};
}

void print(const Json& summary) {
  const auto mm = [&](const char* key) { return 1e3 * summary[key].get<double>(); };
  const Json& best = summary["best"];
  fmt::print("{} of {} circles in reach\n", summary["in_reach"].get<std::size_t>(),
             summary["circles"].get<std::size_t>());
  fmt::print(
      "circularity (least squares), mm: min {:.3f}, max {:.3f}, mean {:.3f}, median {:.3f}\n",
      mm("min"), mm("max"), mm("mean"), mm("median"));
  fmt::print(
      "best: {:.3f} mm about {:.3f}, {:.3f}, {:.3f} m, the tool along {:.2f}, {:.2f}, {:.2f}\n",
      1e3 * best["circularity"].get<double>(), best["center"][0].get<double>(),
      best["center"][1].get<double>(), best["center"][2].get<double>(),
      best["tool_axis"][0].get<double>(), best["tool_axis"][1].get<double>(),
      best["tool_axis"][2].get<double>());
}

}  // namespace

int map_volume(const model::Robot& robot, const study::VolumeRequest& request,
               const std::string& folder, bool json) {
  const study::VolumeMap map(model::six_axis_model(robot), request);
  const study::Ranks ranks = study::ranks_from_environment();
  const std::filesystem::path out = output_folder(folder);
  const std::filesystem::path unfinished =
      output_folder((out / ("unfinished-" + map.fingerprint())).string());
  if (ranks.rank == 0 && !json) {
    fmt::print("{} × {} × {} nodes, {} tool axes: {} circles of {} points, {} process{}\n",
               map.columns(), map.rows(), map.heights(), request.tool_axes.size(), map.circles(),
               request.circle.points, ranks.size, ranks.size > 1 ? "es" : "");
    std::fflush(stdout);
  }
  Progress progress("mapping", 1000);
  const Layers layers = study::compute_layers(
      map, unfinished, ranks,
      [&](std::size_t done, std::size_t count) { progress.show(1000 * done / count); });
  if (ranks.rank != 0) {
    return kDone;
  }
  const Json summary = summary_of(robot, map, layers);
  write_csv(out / "volume.csv", map, layers);
  files::write_text(out / "summary.json", summary.dump(2) + "\n");
  std::error_code ignored;
  std::filesystem::remove_all(unfinished, ignored);
  if (json) {
    fmt::print("{}\n", summary.dump(2));
  } else {
    print(summary);
  }
  return kDone;
}

}  // namespace flexcomp::cli
