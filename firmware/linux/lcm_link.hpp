#pragma once

#include <lcm/lcm.h>

#include <array>
#include <exception>
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
  /// there on our channels to `handler`, but not what this link publishes. Throws
  /// std::runtime_error if it cannot.
  LcmLink(const std::string& url, Handler handler);

  /// Ready to be read from when something has arrived.
  int number() const { return lcm_get_fileno(lcm_.get()); }

  /// Hands over what has arrived; waits for something if nothing has. False if nothing will come
  /// any more, as at the end of a log that is played. Throws what the handler does.
  bool handle();

  /// False if it could not be sent.
  bool publish(const Message& message);

 private:
  struct Sequence {
    std::int64_t first;
    std::int64_t next;
  };

  bool is_echo(const LcmMessage& message) const;
  void take(const lcm_recv_buf_t& buffer, const char* channel);
  static void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self);

  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  std::unique_ptr<lcm_t, Destroy> lcm_;
  Handler handler_;
  /// One a type, each from a random number on: by that we know our own messages, which multicast
  /// brings back to us, however late it does.
  std::array<Sequence, std::variant_size_v<Message>> sequences_;
  std::exception_ptr failure_;  ///< in the handler, which LCM's own code must not see
};

}  // namespace flexcomp
