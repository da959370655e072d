#pragma once

#include <array>
#include <string>
#include <vector>

#include "rsi/link.hpp"

namespace flexcomp {

/// Options of flexcompd for a robot controller on RSI.
struct RsiOptions {
  std::string address;            ///< to listen at, or empty: no RSI
  std::string mode = "absolute";  ///< or relative
  std::string type = "ImFree";
  std::string correction = "AK";  ///< element of the answer
  std::string wrench;   ///< element of the telegram; empty: the wrench comes over CAN or LCM
  std::string armed;    ///< element of the telegram; empty: commands come over CAN or LCM
  std::string applied;  ///< element of the telegram; empty: taken to be zero at the start
  std::string state;    ///< element of the answer, or empty
  double largest = 1.0;
  double largest_step = 0.05;
  std::vector<double> sign = {1, 1, 1, 1, 1, 1};
  std::vector<double> zero = {0, 0, 0, 0, 0, 0};
};

/// The same as a link takes it. Its names are those of `options`, which must outlive it.
RsiConfig to_config(const RsiOptions& options, std::uint32_t tolerated_losses);

class OptionList;

void add_rsi(OptionList* app, RsiOptions* options);

}  // namespace flexcomp
