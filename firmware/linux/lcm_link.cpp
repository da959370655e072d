#include "linux/lcm_link.hpp"

#include <algorithm>
#include <stdexcept>

#include "linux/clock.hpp"

namespace flexcomp {

LcmLink::LcmLink(const std::string& url, Handler handler)
    : lcm_(lcm_create(url.c_str())), handler_(std::move(handler)) {
  if (lcm_ == nullptr || lcm_get_fileno(lcm_.get()) < 0) {
    throw std::runtime_error("LCM cannot be joined at '" + url + "'");
  }
  lcm_subscribe(lcm_.get(), kLcmChannels, on_message, this);
}

bool LcmLink::is_echo(const LcmMessage& message) const {
  return message.timestamp != 0 &&
         std::find(published_.begin(), published_.end(), message.timestamp) != published_.end();
}

void LcmLink::on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
  auto* link = static_cast<LcmLink*>(self);
  const LcmMessage message = decode_lcm(channel, buffer->data, buffer->data_size);
  if (!link->is_echo(message)) {
    link->handler_(message);
  }
}

bool LcmLink::publish(const Message& message) {
  const std::int64_t now = monotonic_now();
  published_[published_next_++ % published_.size()] = now;
  const LcmEvent event = encode_lcm(message, sequences_[message.index()]++, now);
  return lcm_publish(lcm_.get(), event.channel.c_str(), event.data.data(),
                     static_cast<unsigned>(event.data.size())) == 0;
}

}  // namespace flexcomp
