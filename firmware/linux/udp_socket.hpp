#pragma once

#include <netinet/in.h>

#include <string>
#include <string_view>

#include "linux/file_descriptor.hpp"

namespace flexcomp {

/// A UDP socket on IPv4, never blocking.
class UdpSocket {
 public:
  UdpSocket() = default;

  /// Binds it to an address such as "udp://0.0.0.0:49152". Throws std::runtime_error, naming it, if
  /// it is none or cannot be had.
  explicit UdpSocket(const std::string& address);

  /// A socket that sends to such an address, and receives from there alone. Throws as above.
  static UdpSocket to(const std::string& address);

  bool is_open() const { return socket_.is_open(); }
  int number() const { return socket_.number(); }

  /// The next datagram that is there, cut off at `size`; its bytes, or -1 if there is none. Where
  /// it came from is in `from`. Does not allocate.
  long receive(char* data, std::size_t size, sockaddr_in* from);

  /// False if it was not taken. Does not allocate.
  bool send(std::string_view datagram, const sockaddr_in& to);

  /// The same to the address of `to`.
  bool send(std::string_view datagram);

 private:
  FileDescriptor socket_;
};

}  // namespace flexcomp
