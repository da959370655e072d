#include "linux/lcm_link.hpp"

#include <random>
#include <stdexcept>
#include <utility>

#include "linux/clock.hpp"

namespace flexcomp {

namespace {

/// Far from where an honest count wraps, and so far from each other that two links never meet.
std::int64_t random_start() {
  std::random_device device;
  return static_cast<std::int64_t>(
      std::uniform_int_distribution<std::uint64_t>(0, std::uint64_t{1} << 62U)(device));
}

}  // namespace

LcmLink::LcmLink(const std::string& url, Handler handler)
    : lcm_(lcm_create(url.c_str())), handler_(std::move(handler)) {
  if (lcm_ == nullptr || lcm_get_fileno(lcm_.get()) < 0) {
    throw std::runtime_error("LCM cannot be joined at '" + url + "'");
  }
  for (Sequence& sequence : sequences_) {
    sequence.first = random_start();
    sequence.next = sequence.first;
  }
  lcm_subscribe(lcm_.get(), kLcmChannels, on_message, this);
}

bool LcmLink::handle() {
  const bool is_alive = lcm_handle(lcm_.get()) == 0;
  if (failure_) {
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  return is_alive;
}

bool LcmLink::is_echo(const LcmMessage& message) const {
  const Sequence& ours = sequences_[message.message.index()];
  return message.sequence >= ours.first && message.sequence < ours.next;
}

void LcmLink::take(const lcm_recv_buf_t& buffer, const char* channel) {
  const LcmMessage message = decode_lcm(channel, buffer.data, buffer.data_size);
  if (!is_echo(message)) {
    handler_(message);
  }
}

void LcmLink::on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
  auto* link = static_cast<LcmLink*>(self);
  try {
    link->take(*buffer, channel);
  } catch (...) {
    link->failure_ = std::current_exception();
  }
}

bool LcmLink::publish(const Message& message) {
  const LcmEvent event = encode_lcm(message, sequences_[message.index()].next++, monotonic_now());
  return lcm_publish(lcm_.get(), event.channel.c_str(), event.data.data(),
                     static_cast<unsigned>(event.data.size())) == 0;
}

}  // namespace flexcomp
