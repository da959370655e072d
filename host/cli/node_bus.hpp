#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "simulation/plant_bus.hpp"

namespace flexcomp::cli {

/// Where the compensator is that a command is about.
struct NodeAddress {
  std::string bus;
  std::string key;

  /// Throws InputError as `simulation::open_plant_bus` does.
  std::unique_ptr<simulation::PlantBus> open() const {
    return simulation::open_plant_bus(bus, key);
  }
};

/// Adds --bus and --key to a command.
void add_bus(CLI::App* command, NodeAddress* address);

/// Adds `status` and `monitor` to `node`.
void add_node_views(CLI::App* node, Action* action);

}  // namespace flexcomp::cli
