#pragma once

#include <array>

#include "linux/udp_socket.hpp"
#include "rsi/link.hpp"

namespace flexcomp {

/// Moves the datagrams of an RsiLink. Does not allocate, except to be made.
class RsiTransport {
 public:
  RsiTransport(const RsiConfig& config, UdpSocket socket)
      : link_(config), socket_(std::move(socket)) {}

  int number() const { return socket_.number(); }

  enum class Received : std::uint8_t {
    nothing,
    setpoint,  ///< which the node uses
    other,
  };

  /// Takes the next datagram that is there, and answers it if it needs no tick.
  Received receive(Node* node, std::int64_t now);

  /// To be called after each tick with what the node sends. Answers the telegram that waits for it.
  void observe(const CorrectedMessage& corrected);

  /// Answers the telegram that waits, if one does, though there was no tick.
  void answer();

  void add_to(LinkState* state) const;
  void forget_conflicts() { link_.forget_conflicts(); }

 private:
  void send(std::string_view text);

  RsiLink link_;
  UdpSocket socket_;
  sockaddr_in controller_{};
  std::uint32_t dropped_ = 0;
  std::array<char, kLongestTelegram + 1> datagram_{};  // one more tells what is too long
};

}  // namespace flexcomp
