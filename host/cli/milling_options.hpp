#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>
#include <vector>

#include "study/milling_force.hpp"

namespace flexcomp::cli {

/// A mill in its cut, as options give it.
struct MillingOptions {
  study::EndMilling milling;
  std::array<double, 3> shear{};
  std::array<double, 3> edge{};
  std::string mode = "slot";
};

/// Adds --diameter, --teeth, --helix, --depth, --mode, --width, --feed-per-tooth, --runout,
/// --runout-angle, --shear and --edge; returns those that have no default.
std::vector<CLI::Option*> add_milling(CLI::App* command, MillingOptions* options);

/// The mill; throws InputError for one that cannot be.
study::EndMilling milling_of(const MillingOptions& options);

}  // namespace flexcomp::cli
