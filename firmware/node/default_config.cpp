#include "node/default_config.hpp"

namespace flexcomp {

NodeConfig default_node_config() {
  NodeConfig config;
  config.compensator = default_compensator_config<float>();
  config.deflection_warning = 0.004;
  config.deflection_error = 0.006;
  config.wrench.stuck_time = 0.5;
  return config;
}

}  // namespace flexcomp
