#pragma once

#include "linux/can_socket.hpp"
#include "messages/can_frame.hpp"

namespace flexcomp {

/// Sends frames or drops them; never keeps any for later, because a setpoint that is sent late is
/// worse than one that is not.
///
/// When the bus is off or takes no frames: nothing is sent for a while, twice as long after every
/// failed try, up to 64 periods. The fault ends once a number of frames in a row have been taken.
class CanSender {
 public:
  explicit CanSender(CanSocket* socket) : socket_(socket) {}

  void send(const CanFrame* frames, std::size_t count);

  /// To be told what the bus says of itself.
  void observe(CanSocket::Received event);

  /// To be told every tick.
  void tick();

  bool has_fault() const { return fault_; }
  std::uint32_t dropped() const { return dropped_; }

 private:
  void back_off(std::uint32_t frames_to_recover);

  CanSocket* socket_;
  bool fault_ = false;
  std::uint32_t waiting_ = 0;  ///< ticks
  std::uint32_t wait_ = 0;     ///< ticks, after the last failure
  std::uint32_t frames_to_recover_ = 0;
  std::uint32_t taken_ = 0;  ///< frames since the last failure
  std::uint32_t dropped_ = 0;
};

}  // namespace flexcomp
