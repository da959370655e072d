#pragma once

#include <filesystem>
#include <string>

#include "flexcomp/arc.hpp"
#include "simulation/flexible_arm.hpp"

namespace flexcomp::control {

/// A controller's parameters as a file: gains, and the weight and load they were made for.
struct ArcParameters {
  ArcGains<double, 6> gains;
  std::uint64_t model_hash = 0;  ///< of the nominal robot, with gravity and payload as below
  Vector3<double> gravity = Vector3<double>::Zero();
  double payload_mass = 0;
  Vector3<double> payload_center = Vector3<double>::Zero();
};

ArcParameters arc_parameters(const simulation::FlexibleArm<6>& arm,
                             const ArcGains<double, 6>& gains);

/// Writes them as YAML (schema flexcomp/arc/1), numbers that read back to the same bits.
void write_arc_parameters(const std::filesystem::path& file, const ArcParameters& parameters);

/// Throws InputError naming file, line and key.
ArcParameters read_arc_parameters(const std::filesystem::path& file);

/// The controller that a file describes, for the robot with the file's gravity and payload. Throws
/// InputError if the file was made for another robot or the core refuses it.
AdaptiveRobustController<double, 6> make_controller(const ArcParameters& parameters,
                                                    simulation::FlexibleArm<6> arm);

/// The gains as a C header that defines `flexcomp_arc_gains_t arc_gains`, for a controller without
/// files.
std::string c_header(const ArcParameters& parameters, const std::string& robot);

}  // namespace flexcomp::control
