#include "linux/udp_socket.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace flexcomp {
namespace {

constexpr std::string_view kScheme = "udp://";

/// False if `text` is not "udp://ADDRESS:PORT" in numbers.
bool read_address(const std::string& text, sockaddr_in* address) {
  const std::size_t colon = text.rfind(':');
  if (text.compare(0, kScheme.size(), kScheme) != 0 || colon < kScheme.size()) {
    return false;
  }
  const std::string host = text.substr(kScheme.size(), colon - kScheme.size());
  const char* const end = text.data() + text.size();
  std::uint16_t port = 0;
  const auto [read_to, error] = std::from_chars(text.data() + colon + 1, end, port);
  address->sin_family = AF_INET;
  address->sin_port = htons(port);
  return error == std::errc() && read_to == end && port != 0 &&
         inet_pton(AF_INET, host.c_str(), &address->sin_addr) == 1;
}

}  // namespace

UdpSocket::UdpSocket(const std::string& address) {
  sockaddr_in bound{};
  if (!read_address(address, &bound)) {
    throw std::runtime_error("'" + address + "': expected udp://ADDRESS:PORT in numbers");
  }
  socket_ = FileDescriptor(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_.is_open() ||
      bind(socket_.number(), reinterpret_cast<const sockaddr*>(&bound), sizeof bound) != 0) {
    throw std::runtime_error("cannot listen at '" + address + "': " + std::strerror(errno));
  }
}

long UdpSocket::receive(char* data, std::size_t size, sockaddr_in* from) {
  socklen_t length = sizeof *from;
  return recvfrom(socket_.number(), data, size, 0, reinterpret_cast<sockaddr*>(from), &length);
}

bool UdpSocket::send(std::string_view datagram, const sockaddr_in& to) {
  return sendto(socket_.number(), datagram.data(), datagram.size(), 0,
                reinterpret_cast<const sockaddr*>(&to),
                sizeof to) == static_cast<long>(datagram.size());
}

}  // namespace flexcomp
