#pragma once

#include <string>

#include "linux/file_descriptor.hpp"
#include "messages/can_frame.hpp"

namespace flexcomp {

/// A raw SocketCAN socket, classic and FD, never blocking.
class CanSocket {
 public:
  /// What a call to `receive` found.
  enum class Received {
    nothing,
    frame,
    bus_off,       ///< error frame: the controller has left the bus
    bus_passive,   ///< error frame: close to that
    bus_restarted  ///< error frame: back again
  };

  CanSocket() = default;

  /// Opens it on an interface such as "can0". Throws std::runtime_error, naming it, if there is no
  /// such interface, it is no CAN interface, or `fd` is asked for and it carries classic frames
  /// only.
  CanSocket(const std::string& interface, bool fd);

  bool is_open() const { return socket_.is_open(); }
  int number() const { return socket_.number(); }

  /// Receives only identifiers with (id & mask) == value, for each of the pairs.
  struct Filter {
    std::uint32_t value;
    std::uint32_t mask;
  };
  void receive_only(const Filter* filters, std::size_t count);

  /// The next frame that is there. Does not allocate.
  Received receive(CanFrame* frame);

  /// False if the frame was not taken: the queue is full (ENOBUFS) or the interface down. Does not
  /// allocate.
  bool send(const CanFrame& frame);

 private:
  FileDescriptor socket_;
};

}  // namespace flexcomp
