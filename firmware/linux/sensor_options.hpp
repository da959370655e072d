#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "force_sensor/rdt_link.hpp"

namespace flexcomp {

/// Options of flexcompd for a force sensor that streams records (RDT).
struct SensorOptions {
  std::string address;  ///< of the sensor, or empty: none
  std::vector<double> counts = {1e6, 1e6};
  std::vector<double> zero = {0, 0, 0, 0, 0, 0};
  std::vector<double> frame = {0, 0, 0, 0, 0, 0};
  std::vector<double> tcp;  ///< empty: not given
  double mass = 0;
  std::vector<double> center_of_mass = {0, 0, 0};
  std::vector<double> gravity = {0, 0, -9.80665};
  std::array<std::vector<double>, 6> joints;  ///< each empty where it is not given
};

/// The same as a link takes it.
RdtConfig to_config(const SensorOptions& options);

class OptionList;

void add_sensor(OptionList* app, SensorOptions* options);

/// An option, and what is wrong with it.
struct OptionFault {
  std::string option;
  std::string fault;
};

/// The first option of the arm's geometry that is missing or impossible; nothing if there is none.
std::optional<OptionFault> fault_in(const SensorOptions& options);

}  // namespace flexcomp
