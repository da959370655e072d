#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rsi/link.hpp"

namespace flexcomp::controller {

/// Facts of the node that a controller with RSI has to know.
struct RsiProject {
  std::string robot;       ///< its name, for comments
  std::string address;     ///< of the node's computer, on the controller's sensor network
  std::uint16_t port = 0;  ///< where the node listens
  std::string type;        ///< SENTYPE; the controller refuses answers of another
  RsiMode mode = RsiMode::absolute;
  double period = 0.004;   ///< s: 0.004 or 0.012
  double largest = 1.0;    ///< degrees, correction of an axis
  bool has_force = false;  ///< the wrench is in the telegram
};

/// Elements that these files give names, for the options of flexcompd.
constexpr const char* kRsiArmed = "Arm";
constexpr const char* kRsiApplied = "AxisCorrMon";
constexpr const char* kRsiWrench = "FT";
constexpr const char* kRsiState = "State";

/// Late answers that the controller bears before it stops the robot: the parameter Timeout.
constexpr int kRsiTolerated = 100;

/// The files that the controller needs, by name: flexcomp.xml (Ethernet), flexcomp.rsi.xml (the
/// context: objects and how they are wired), flexcomp.src (KRL). Objects, their numbers and
/// parameters are those of KUKA.RobotSensorInterface 3, as public contexts have them
/// (ros-industrial/kuka_experimental; RSIPI).
std::vector<std::pair<std::string, std::string>> rsi_files(const RsiProject& project);

}  // namespace flexcomp::controller
