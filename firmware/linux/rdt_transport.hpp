#pragma once

#include "force_sensor/rdt_link.hpp"
#include "linux/udp_socket.hpp"

namespace flexcomp {

/// Moves the datagrams of an RdtLink. Does not allocate, except to be made.
class RdtTransport {
 public:
  /// Takes datagrams from the sensor at `address`, such as "udp://192.168.1.1:49152", alone. Throws
  /// std::runtime_error, naming it, if it is no address.
  RdtTransport(const RdtConfig& config, const std::string& address)
      : link_(config), socket_(UdpSocket::to(address)) {}
  RdtTransport(const RdtTransport&) = delete;
  RdtTransport& operator=(const RdtTransport&) = delete;

  /// Asks the sensor to stop.
  ~RdtTransport();

  /// Takes what has come, and gives the node the newest of it: to be called before each tick. What
  /// a sensor sends in a period waits in the socket until then, so that it wakes nobody.
  void update(Node* node, std::int64_t now);

  void add_to(LinkState* state) const { link_.add_to(state); }
  void forget_conflicts() { link_.forget_conflicts(); }

 private:
  void ask(RdtCommand command);

  RdtLink link_;
  UdpSocket socket_;
};

}  // namespace flexcomp
