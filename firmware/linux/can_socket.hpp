#pragma once

#include <linux/can.h>

#include <array>
#include <string>

#include "linux/file_descriptor.hpp"
#include "messages/can_frame.hpp"

namespace flexcomp {

/// A raw SocketCAN socket, classic and FD, never blocking.
class CanSocket {
 public:
  /// Result of a call to `receive`.
  enum class Received {
    nothing,
    frame,
    warning,       ///< error frame: some errors, nothing lost yet
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

  /// The next frame that is there; `nothing` once after the last. Does not allocate. Frames are
  /// fetched many at a time, so that the system is asked once where it would be once a frame.
  Received receive(CanFrame* frame);

  /// Sends frames in order; how many were taken before one was not: the queue is full (ENOBUFS) or
  /// the interface down. Does not allocate.
  std::size_t send(const CanFrame* frames, std::size_t count);
  bool send(const CanFrame& frame) { return send(&frame, 1) == 1; }

 private:
  static constexpr std::size_t kBatch = 16;

  void fetch();

  FileDescriptor socket_;
  std::array<canfd_frame, kBatch> fetched_{};
  std::array<unsigned, kBatch> sizes_{};  ///< bytes of each, which tell classic from FD
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace flexcomp
