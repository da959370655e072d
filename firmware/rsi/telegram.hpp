#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "rsi/axes.hpp"

namespace flexcomp {

/// KUKA's RobotSensorInterface (RSI) sends it each interpolation cycle: `<Rob …>`, one UDP
/// datagram of XML. All in the controller's units.
struct RsiTelegram {
  AxisAngles actual{};    ///< AIPos, degrees
  AxisAngles setpoint{};  ///< ASPos, degrees
  std::uint64_t ipoc = 0;
  std::optional<std::uint64_t> late;            ///< Delay: answers that came late, as it counts
  std::optional<std::array<double, 6>> wrench;  ///< N, N·m, on the tool at the TCP, base frame
  std::optional<bool> armed;                    ///< an output of the robot's program
  std::optional<AxisAngles> applied;  ///< degrees, the correction that the controller moves by
};

/// Which elements a telegram must have beside `AIPos`, `ASPos` and `IPOC`. A name that is empty
/// stands for an element that is not asked for.
struct RsiSchema {
  std::string_view wrench;   ///< element with the attributes Fx Fy Fz Mx My Mz
  std::string_view armed;    ///< element with the text 1 or 0, TRUE or FALSE
  std::string_view applied;  ///< element with the attributes A1 to A6, as of RSI's AXISCORRMON
  bool needs_late = false;   ///< Delay must be there
};

/// Result of reading a telegram. The numbers are stable.
enum class RsiReading : std::uint8_t {
  ok = 0,
  too_long = 1,   ///< above kLongestTelegram
  no_xml = 2,     ///< not well-formed, or a part of XML that no controller sends
  too_deep = 3,   ///< elements within elements within elements
  no_rob = 4,     ///< the root is another element
  missing = 5,    ///< an element or an attribute of the schema is not there
  repeated = 6,   ///< an element or an attribute of the schema is there twice
  no_number = 7,  ///< where one must be
};

/// A few words for a person; never null.
const char* describe(RsiReading reading);

constexpr std::size_t kLongestTelegram = 4096;  ///< bytes

/// Reads a telegram by a schema. Elements and attributes that the schema does not name are passed
/// over, whatever they hold, as long as they are well-formed; so is a declaration (`<?xml …?>`).
/// Comments, CDATA and document types are refused. One pass, no allocation, bounded depth.
/// `telegram` is untouched unless the result is ok.
RsiReading read_telegram(std::string_view text, const RsiSchema& schema, RsiTelegram* telegram);

}  // namespace flexcomp
