#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rsi/axes.hpp"

namespace flexcomp {

/// RSI expects it back within the cycle: `<Sen Type="…">` with the axis corrections, an element
/// that is usually `AK`, and the `IPOC` of the telegram that it answers.
struct RsiAnswer {
  std::string_view type;    ///< as in the controller's configuration (SENTYPE)
  AxisAngles correction{};  ///< degrees, absolute or relative as the RSI context is started
  std::string_view correction_name = "AK";
  std::string_view state_name;  ///< of an element with the node's state; empty for none
  std::uint8_t state = 0;       ///< State of compensator.hpp
  std::uint64_t ipoc = 0;
};

/// Text of an answer, in memory of its own.
class RsiAnswerText {
 public:
  static constexpr std::size_t kLongestName = 32;  ///< of the type and of an element

  /// Writes an answer over the one before. Six decimals of a degree, which are 17 nrad. A
  /// correction must be a number of at most 360 in size; names have at most kLongestName
  /// characters, and hold none that XML would have to quote.
  void write(const RsiAnswer& answer);

  std::string_view text() const { return {text_.data(), size_}; }

 private:
  void add(std::string_view text);
  void add_whole(std::uint64_t number);
  void add_degrees(double degrees);

  static constexpr std::size_t kRoom = 384;
  std::array<char, kRoom> text_{};
  std::size_t size_ = 0;
};

}  // namespace flexcomp
