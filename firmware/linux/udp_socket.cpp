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

sockaddr_in address_of(const std::string& text) {
  sockaddr_in address{};
  if (!read_address(text, &address)) {
    throw std::runtime_error("'" + text + "': expected udp://ADDRESS:PORT in numbers");
  }
  return address;
}

FileDescriptor open_socket() {
  FileDescriptor result(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!result.is_open()) {
    throw std::runtime_error(std::string("cannot have a socket: ") + std::strerror(errno));
  }
  return result;
}

}  // namespace

UdpSocket::UdpSocket(const std::string& address) : socket_(open_socket()) {
  const sockaddr_in bound = address_of(address);
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&bound), sizeof bound) != 0) {
    throw std::runtime_error("cannot listen at '" + address + "': " + std::strerror(errno));
  }
}

UdpSocket UdpSocket::to(const std::string& address) {
  UdpSocket result;
  result.socket_ = open_socket();
  const sockaddr_in peer = address_of(address);
  if (connect(result.number(), reinterpret_cast<const sockaddr*>(&peer), sizeof peer) != 0) {
    throw std::runtime_error("cannot send to '" + address + "': " + std::strerror(errno));
  }
  return result;
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

bool UdpSocket::send(std::string_view datagram) {
  return ::send(socket_.number(), datagram.data(), datagram.size(), 0) ==
         static_cast<long>(datagram.size());
}

}  // namespace flexcomp
