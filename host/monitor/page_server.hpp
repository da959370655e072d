#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "linux/file_descriptor.hpp"

namespace flexcomp::monitor {

/// Serves the monitor's page to browsers on this machine, over HTTP/1.1 (RFC 9112) on 127.0.0.1,
/// and events to those who follow it (HTML, server-sent events). Only GET of "/" and "/events"; a
/// request that names another host, as a foreign page may make a browser send, is refused.
class PageServer {
 public:
  /// `port`: 0 for one that is free. Throws InputError, naming it, if it cannot be had.
  explicit PageServer(std::uint16_t port);

  /// Such as "http://127.0.0.1:8080/".
  std::string address() const;

  /// Answers who has asked since the last call, and sends `event`, one line, to all who follow.
  /// Never waits: whoever does not read in time is left.
  void serve(const std::string& event);

 private:
  /// A connection, and what it has said so far.
  struct Browser {
    FileDescriptor socket;
    std::string request;
    int calls = 0;  ///< of `serve` since it came
    bool follows = false;
    bool is_done = false;
  };

  void accept_all();
  void read(Browser* browser) const;
  void answer(Browser* browser) const;

  FileDescriptor listener_;
  std::uint16_t port_ = 0;
  std::vector<Browser> browsers_;
};

}  // namespace flexcomp::monitor
