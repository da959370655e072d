#include "linux/rsi_transport.hpp"

namespace flexcomp {
namespace {

RsiPeer peer_of(const sockaddr_in& address) {
  constexpr unsigned kPortBits = 16;
  return RsiPeer{address.sin_addr.s_addr} << kPortBits | address.sin_port;
}

}  // namespace

RsiTransport::Received RsiTransport::receive(Node* node, std::int64_t now) {
  sockaddr_in from{};
  const long size = socket_.receive(datagram_.data(), datagram_.size(), &from);
  if (size < 0) {
    return Received::nothing;
  }
  const std::string_view datagram(datagram_.data(), static_cast<std::size_t>(size));
  switch (link_.receive(datagram, peer_of(from), node, now)) {
    case RsiLink::Due::nothing:
      return Received::other;
    case RsiLink::Due::the_same:
      send(link_.last_answer());
      return Received::other;
    case RsiLink::Due::answer:
      controller_ = from;
      answer();
      return Received::other;
    case RsiLink::Due::tick:
      controller_ = from;
      return Received::setpoint;
  }
  return Received::other;
}

void RsiTransport::observe(const CorrectedMessage& corrected) {
  link_.observe(corrected);
  answer();
}

void RsiTransport::answer() {
  if (link_.needs_answer()) {
    send(link_.answer());
  }
}

void RsiTransport::send(std::string_view text) {
  dropped_ += socket_.send(text, controller_) ? 0U : 1U;
}

void RsiTransport::add_to(LinkState* state) const {
  link_.add_to(state);
  state->dropped_frames += dropped_;
}

}  // namespace flexcomp
