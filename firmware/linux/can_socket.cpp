#include "linux/can_socket.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace flexcomp {
namespace {

constexpr std::size_t kMaxFilters = 8;

std::runtime_error failure(const std::string& interface, const std::string& what) {
  return std::runtime_error("CAN interface '" + interface + "': " + what);
}

std::runtime_error system_failure(const std::string& interface) {
  return failure(interface, std::strerror(errno));
}

/// A length that an FD frame can have, at least `size`.
std::uint8_t fd_length(std::uint8_t size) {
  constexpr std::array<std::uint8_t, 16> kLengths = {0, 1,  2,  3,  4,  5,  6,  7,
                                                     8, 12, 16, 20, 24, 32, 48, 64};
  return *std::lower_bound(kLengths.begin(), kLengths.end() - 1, size);
}

CanSocket::Received error_kind(const canfd_frame& raw) {
  if ((raw.can_id & CAN_ERR_BUSOFF) != 0) {
    return CanSocket::Received::bus_off;
  }
  if ((raw.can_id & CAN_ERR_RESTARTED) != 0) {
    return CanSocket::Received::bus_restarted;
  }
  return CanSocket::Received::bus_passive;
}

bool is_passive(const canfd_frame& raw) {
  return (raw.data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
}

}  // namespace

CanSocket::CanSocket(const std::string& interface, bool fd)
    : socket_(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)) {
  if (!socket_.is_open()) {
    throw failure(interface, "this kernel has no CAN");
  }
  ifreq request{};
  if (interface.empty() || interface.size() >= sizeof request.ifr_name) {
    throw failure(interface, "no name of an interface");
  }
  std::copy(interface.begin(), interface.end(), request.ifr_name);
  if (ioctl(socket_.number(), SIOCGIFMTU, &request) < 0) {
    throw system_failure(interface);
  }
  const int on = 1;
  if (fd && (request.ifr_mtu != CANFD_MTU ||
             setsockopt(socket_.number(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) < 0)) {
    throw failure(interface, "carries classic frames only; give it an MTU of 72 or use them");
  }
  const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL;
  setsockopt(socket_.number(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) < 0) {
    throw system_failure(interface);
  }
}

void CanSocket::receive_only(const Filter* filters, std::size_t count) {
  std::array<can_filter, kMaxFilters> list{};
  count = std::min(count, list.size());
  for (std::size_t i = 0; i < count; ++i) {
    list[i] = {filters[i].value, filters[i].mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
  }
  setsockopt(socket_.number(), SOL_CAN_RAW, CAN_RAW_FILTER, list.data(),
             static_cast<socklen_t>(count * sizeof(can_filter)));
}

CanSocket::Received CanSocket::receive(CanFrame* frame) {
  canfd_frame raw{};
  const ssize_t size = read(socket_.number(), &raw, sizeof raw);
  if (size != CAN_MTU && size != CANFD_MTU) {
    return Received::nothing;
  }
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    const bool is_warning = (raw.can_id & CAN_ERR_CRTL) != 0 && !is_passive(raw);
    return is_warning ? receive(frame) : error_kind(raw);
  }
  frame->id = raw.can_id & CAN_EFF_MASK;
  frame->fd = size == CANFD_MTU;
  frame->size = std::min<std::uint8_t>(raw.len, CANFD_MAX_DLEN);
  std::copy_n(std::begin(raw.data), frame->data.size(), frame->data.begin());
  return Received::frame;
}

bool CanSocket::send(const CanFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id;
  raw.len = frame.fd ? fd_length(frame.size) : frame.size;
  raw.flags = frame.fd ? CANFD_BRS : 0;
  std::copy_n(frame.data.begin(), frame.size, std::begin(raw.data));
  const ssize_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  return write(socket_.number(), &raw, static_cast<std::size_t>(size)) == size;
}

}  // namespace flexcomp
