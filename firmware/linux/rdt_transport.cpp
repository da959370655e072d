#include "linux/rdt_transport.hpp"

#include <array>

namespace flexcomp {
namespace {

constexpr int kRecordsAtOnce = 512;   // of which a socket holds fewer
constexpr std::size_t kLongest = 64;  // bytes; one that is longer than a record is cut, and is none

}  // namespace

RdtTransport::~RdtTransport() { ask(RdtCommand::stop); }

void RdtTransport::update(Node* node, std::int64_t now) {
  std::array<char, kLongest> datagram{};
  sockaddr_in from{};
  for (int i = 0; i < kRecordsAtOnce; ++i) {
    const long size = socket_.receive(datagram.data(), datagram.size(), &from);
    if (size < 0) {
      break;
    }
    link_.receive({datagram.data(), static_cast<std::size_t>(size)}, now);
  }
  link_.hand_over(node, now);
  if (link_.wants_request(now)) {
    ask(RdtCommand::stream);
  }
}

/// One that is lost is sent again: the sensor stays silent then.
void RdtTransport::ask(RdtCommand command) {
  const RdtRequest request = rdt_request(command);
  socket_.send({request.data(), request.size()});
}

}  // namespace flexcomp
