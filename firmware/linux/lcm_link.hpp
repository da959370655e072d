#pragma once

#include <lcm/lcm.h>

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "messages/lcm_codec.hpp"

namespace flexcomp {

/// Messages over LCM. Allocates and may block: not for the real-time thread.
class LcmLink {
 public:
  using Handler = std::function<void(const LcmMessage&)>;

  /// Joins at an address such as "udpm://239.255.76.67:7667?ttl=0" and hands what others publish
  /// there on our channels to `handler`. Throws std::runtime_error if it cannot.
  LcmLink(const std::string& url, Handler handler);

  /// Ready to be read from when something has arrived.
  int number() const { return lcm_get_fileno(lcm_.get()); }

  /// Hands over what has arrived; waits for something if nothing has.
  void handle() { lcm_handle(lcm_.get()); }

  /// False if it could not be sent.
  bool publish(const Message& message);

 private:
  bool is_echo(const LcmMessage& message) const;
  static void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self);

  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  std::unique_ptr<lcm_t, Destroy> lcm_;
  Handler handler_;
  std::array<std::int64_t, std::variant_size_v<Message>> sequences_{};  ///< one a type
  /// When our own last messages were published, by which their echoes are known.
  std::array<std::int64_t, 64> published_{};
  std::size_t published_next_ = 0;
};

}  // namespace flexcomp
