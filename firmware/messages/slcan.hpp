#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "messages/can_frame.hpp"

namespace flexcomp {

/// SLCAN: CAN frames as lines of text on a serial line, as the CAN232 adapters of Lawicel speak it
/// and Linux's slcan takes for an interface. `t`, three digits of identifier, one of length, two a
/// byte, all hexadecimal; a carriage return.

/// A line as it goes out.
struct SlcanLine {
  static constexpr std::size_t kLongest = 1 + 3 + 1 + 2 * 8 + 1;
  std::array<char, kLongest> text{};
  std::size_t size = 0;
};

/// A classic frame as a line; empty for an FD frame, which SLCAN has no word for.
SlcanLine to_slcan(const CanFrame& frame);

/// Takes the bytes of a serial line and finds frames in them. Fixed memory, constant time a byte;
/// whatever comes, the next whole line after it is understood.
class SlcanReader {
 public:
  enum class Event : std::uint8_t {
    nothing,  ///< in the midst of a line
    frame,    ///< a frame with an 11-bit identifier: in `frame()`
    foreign,  ///< a frame of another kind: 29-bit identifier, remote request
    command,  ///< to the adapter, such as O (open) or S6 (500 kbit/s): to be answered with a CR
    unknown,  ///< no such command: to be answered with a BEL
    corrupt,  ///< what begins like a frame but is none
  };

  Event take(std::uint8_t byte);

  /// Takes a whole line at once, where one begins and `text` holds all of it and it is a frame, in
  /// `frame()`: bytes that it took, or 0. What it does not take is for `take`.
  std::size_t take_frame(const std::uint8_t* text, std::size_t count);

  const CanFrame& frame() const { return frame_; }

 private:
  Event end_of_line();
  Event read_frame();

  static constexpr std::size_t kLongestLine = 32;
  std::array<char, kLongestLine> line_{};
  std::size_t size_ = 0;  ///< above kLongestLine: the line is too long, and dropped at its end
  CanFrame frame_;
};

}  // namespace flexcomp
