#include "messages/message_authentication.hpp"

#include <algorithm>

#include "flexcomp_can.h"
#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr unsigned kFreshnessBits = 20;
constexpr unsigned kFreshnessBitsFd = 32;
constexpr std::size_t kLongestMessage = std::max<std::size_t>(8 * kMaxFrameParts, 64);

/// Collects bytes; numbers with the low byte first.
class ByteSink {
 public:
  template <typename Number>
  void put(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }

  void put(const CanFrame& frame) {
    std::copy_n(frame.data.begin(), frame.size, bytes_.begin() + size_);
    size_ += frame.size;
  }

  const std::uint8_t* data() const { return bytes_.data(); }
  std::size_t size() const { return size_; }

 private:
  std::array<std::uint8_t, sizeof(std::uint16_t) + kLongestMessage + sizeof(Freshness)> bytes_{};
  std::size_t size_ = 0;
};

/// The first bytes of a code as the number whose low byte is the first.
template <typename Number>
Number first_of(const Cmac::Code& code) {
  Number value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    value |= static_cast<Number>(Number{code[i]} << (8 * i));
  }
  return value;
}

// All authentication frames are laid out as that of the setpoint, classic or FD.

void pack(Freshness freshness, const Cmac::Code& code, std::uint32_t counter, CanFrame* frame) {
  if (frame->fd) {
    flexcomp_can_setpoint_fd_authentication_t raw{};
    raw.counter = static_cast<std::uint8_t>(counter);
    raw.freshness = static_cast<std::uint32_t>(freshness);
    raw.mac = first_of<std::uint64_t>(code);
    flexcomp_can_setpoint_fd_authentication_pack(frame->data.data(), &raw, frame->size);
  } else {
    flexcomp_can_setpoint_authentication_t raw{};
    raw.counter = static_cast<std::uint8_t>(counter);
    raw.freshness = static_cast<std::uint32_t>(freshness & ((1U << kFreshnessBits) - 1U));
    raw.mac = first_of<std::uint32_t>(code);
    flexcomp_can_setpoint_authentication_pack(frame->data.data(), &raw, frame->size);
  }
}

Freshness unpack_freshness(const CanFrame& frame, Freshness clock) {
  if (frame.fd) {
    flexcomp_can_setpoint_fd_authentication_t raw{};
    flexcomp_can_setpoint_fd_authentication_unpack(&raw, frame.data.data(), frame.size);
    return whole_freshness(raw.freshness, kFreshnessBitsFd, clock);
  }
  flexcomp_can_setpoint_authentication_t raw{};
  flexcomp_can_setpoint_authentication_unpack(&raw, frame.data.data(), frame.size);
  return whole_freshness(raw.freshness, kFreshnessBits, clock);
}

/// Takes as long wherever they differ, so that the time tells nothing of the code.
bool is_same(const CanFrame& a, const CanFrame& b) {
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size; ++i) {
    difference |= static_cast<unsigned>(a.data[i] ^ b.data[i]);
  }
  return difference == 0;
}

}  // namespace

MessageAuthentication::MessageAuthentication(const AuthenticationKey& key, FreshnessClock clock)
    : cmac_(key), clock_(clock) {
  gates_.fill(FreshnessGate(clock()));
  counters_.has_key = true;
}

const SealedFrames& MessageAuthentication::seal(const FrameList& message) {
  std::copy_n(message.frames.begin(), message.count, sealed_.frames.begin());
  sealed_.count = message.count;
  const FrameLayout* first = message.count > 0 ? find_layout(message.frames[0].id) : nullptr;
  const AuthenticationLayout* layout =
      first != nullptr ? find_authentication(first->group) : nullptr;
  if (layout == nullptr) {
    return sealed_;
  }
  const Freshness freshness = source_.next(clock_());
  // Our own message is not to be taken for another's when it is played to us.
  gates_[static_cast<std::size_t>(layout->group)].close_up_to(freshness);
  CanFrame* authentication = &sealed_.frames[sealed_.count];
  if (make_authentication(*layout, message.frames.data(), freshness, authentication)) {
    ++sealed_.count;
  }
  return sealed_;
}

const FrameList& MessageAuthentication::admit(const CanFrame& frame) {
  admitted_.count = 0;
  const FrameLayout* part = find_layout(frame.id);
  const AuthenticationLayout* layout =
      part != nullptr ? find_authentication(part->group) : find_authentication(frame.id);
  if (layout == nullptr) {
    admitted_.frames[admitted_.count++] = frame;
    return admitted_;
  }
  const std::uint8_t size = part != nullptr ? part->size : layout->size;
  if (frame.size != size || frame.fd != layout->fd || !is_intact(frame)) {
    if (part != nullptr) {
      admitted_.frames[admitted_.count++] = frame;  // the decoder refuses it, and counts damage
    }
    return admitted_;
  }
  Pending* pending = &pending_[static_cast<std::size_t>(layout->group)];
  if (part != nullptr) {
    collect(frame, part->part, pending);
  } else {
    conclude(*layout, frame, pending);
  }
  return admitted_;
}

void MessageAuthentication::collect(const CanFrame& frame, std::size_t part, Pending* pending) {
  if (part == 0) {  // a message that is given up is given up once
    counters_.unauthenticated += (pending->received & 1U) != 0 && !pending->is_counted ? 1U : 0U;
    pending->is_counted = false;
  }
  pending->received |= 1U << part;
  pending->parts[part] = frame;
}

void MessageAuthentication::conclude(const AuthenticationLayout& layout,
                                     const CanFrame& authentication, Pending* pending) {
  const std::uint32_t counter = counter_of(authentication);
  bool is_whole = pending->received == (1U << layout.parts) - 1U;
  for (std::size_t i = 0; is_whole && i < layout.parts; ++i) {
    is_whole = counter_of(pending->parts[i]) == counter;
  }
  if (!is_whole) {
    ++counters_.unauthenticated;
  } else if (is_authentic(layout, authentication, *pending)) {
    std::copy_n(pending->parts.begin(), layout.parts, admitted_.frames.begin());
    admitted_.count = layout.parts;
    pending->received = 0;
  }
  pending->is_counted = true;
}

bool MessageAuthentication::is_authentic(const AuthenticationLayout& layout,
                                         const CanFrame& authentication, const Pending& pending) {
  FreshnessGate& gate = gates_[static_cast<std::size_t>(layout.group)];
  const Freshness clock = clock_();
  const Freshness freshness = unpack_freshness(authentication, clock);
  if (!gate.is_fresh(freshness, clock)) {
    ++counters_.not_fresh;
    return false;
  }
  CanFrame expected;
  if (!make_authentication(layout, pending.parts.data(), freshness, &expected) ||
      !is_same(expected, authentication)) {
    ++counters_.forged;
    return false;
  }
  gate.close_up_to(freshness);
  return true;
}

/// `message`: the frames of the group, in order. False if there is no code.
bool MessageAuthentication::make_authentication(const AuthenticationLayout& layout,
                                                const CanFrame* message, Freshness freshness,
                                                CanFrame* frame) {
  ByteSink content;
  content.put(static_cast<std::uint16_t>(layout.id));
  for (std::size_t i = 0; i < layout.parts; ++i) {
    content.put(message[i]);
  }
  content.put(freshness);
  Cmac::Code code{};
  if (!cmac_.compute(content.data(), content.size(), &code)) {
    return false;
  }
  *frame = CanFrame();
  frame->id = layout.id;
  frame->size = layout.size;
  frame->fd = layout.fd;
  pack(freshness, code, counter_of(message[0]), frame);
  protect(frame);
  return true;
}

}  // namespace flexcomp
