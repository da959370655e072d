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

/// Takes what is there, up to a batch.
void CanSocket::fetch() {
  std::array<iovec, kBatch> places{};
  std::array<mmsghdr, kBatch> messages{};
  for (std::size_t i = 0; i < kBatch; ++i) {
    places[i] = {&fetched_[i], sizeof(canfd_frame)};
    messages[i].msg_hdr.msg_iov = &places[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int received = recvmmsg(socket_.number(), messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  next_ = 0;
  count_ = received > 0 ? static_cast<std::size_t>(received) : 0;
  for (std::size_t i = 0; i < count_; ++i) {
    sizes_[i] = messages[i].msg_len;
  }
}

CanSocket::Received CanSocket::receive(CanFrame* frame) {
  if (next_ == count_) {
    // After less than a whole batch there was nothing more: that needs no second question.
    const bool was_last = count_ > 0 && count_ < kBatch;
    count_ = 0;
    next_ = 0;
    if (was_last) {
      return Received::nothing;
    }
    fetch();
    if (count_ == 0) {
      return Received::nothing;
    }
  }
  const canfd_frame& raw = fetched_[next_];
  const unsigned size = sizes_[next_++];
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    const bool is_warning = (raw.can_id & CAN_ERR_CRTL) != 0 && !is_passive(raw);
    return is_warning ? Received::warning : error_kind(raw);
  }
  frame->id = raw.can_id & CAN_EFF_MASK;
  frame->fd = size == CANFD_MTU;
  frame->size = std::min<std::uint8_t>(raw.len, CANFD_MAX_DLEN);
  std::copy_n(std::begin(raw.data), frame->data.size(), frame->data.begin());
  return Received::frame;
}

std::size_t CanSocket::send(const CanFrame* frames, std::size_t count) {
  std::array<canfd_frame, kBatch> raw{};
  std::array<iovec, kBatch> places{};
  std::array<mmsghdr, kBatch> messages{};
  count = std::min(count, kBatch);
  for (std::size_t i = 0; i < count; ++i) {
    const CanFrame& frame = frames[i];
    raw[i].can_id = frame.id;
    raw[i].len = frame.fd ? fd_length(frame.size) : frame.size;
    raw[i].flags = frame.fd ? CANFD_BRS : 0;
    std::copy_n(frame.data.begin(), frame.size, std::begin(raw[i].data));
    places[i] = {&raw[i], static_cast<std::size_t>(frame.fd ? CANFD_MTU : CAN_MTU)};
    messages[i].msg_hdr.msg_iov = &places[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int sent =
      sendmmsg(socket_.number(), messages.data(), static_cast<unsigned>(count), MSG_DONTWAIT);
  return sent > 0 ? static_cast<std::size_t>(sent) : 0;
}

}  // namespace flexcomp
