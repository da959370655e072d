#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "rsi/link.hpp"
#include "simulation/plant_bus.hpp"

namespace flexcomp::simulation {

/// RSI has stopped the robot. `what()` is one line that says why.
class RsiStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A robot controller with RSI running, as the plant's bus.
struct RsiControllerOptions {
  double period = 0.004;  ///< s, of an interpolation cycle; IPOC counts it in milliseconds
  RsiMode mode = RsiMode::absolute;
  AxisConvention axes;
  std::string type = "ImFree";      ///< answers with another are not taken
  std::uint64_t tolerated = 100;    ///< late answers; the next one stops the robot
  double largest_correction = 1.5;  ///< degrees, of an axis; beyond it RSI stops the robot
};

/// Opens "udp://ADDRESS:PORT", where flexcompd listens. Each setpoint becomes a telegram with the
/// last wrench, in the elements that `flexcomp configure --rsi` names: AIPos, ASPos, Delay, Arm,
/// AxisCorrMon, FT, IPOC. The commands arm and disarm set the output Arm; the rest of what the
/// plant sends has no place there. An answer counts within its cycle, if it has the telegram's IPOC
/// and the right type; otherwise the cycle is late, and the correction stays.
///
/// A controller counts late answers for as long as RSI runs, and stops at one more than it
/// tolerates (the parameter Timeout of RSI's object ETHERNET, of which 100 is the default). `send`
/// then throws RsiStopped. Throws InputError, naming the address.
std::unique_ptr<PlantBus> open_rsi_controller(const std::string& address,
                                              const RsiControllerOptions& options);

}  // namespace flexcomp::simulation
