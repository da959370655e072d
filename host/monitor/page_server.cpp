#include "monitor/page_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "error.hpp"
#include "page.hpp"

namespace flexcomp::monitor {
namespace {

constexpr std::size_t kMostBrowsers = 16;
constexpr std::size_t kLongestRequest = 8192;
constexpr int kPatience = 100;  // calls, for a request

constexpr std::string_view kEndOfHead = "\r\n\r\n";

/// All of it at once, or false: a socket's buffer holds a page and many events.
bool send_all(const FileDescriptor& socket, const std::string& text) {
  const ssize_t sent = send(socket.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(text.size());
}

std::string head(const char* status, const char* type) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}; charset=utf-8\r\nCache-Control: no-store\r\n"
      "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; connect-src 'self'\r\nConnection: close\r\n\r\n",
      status, type);
}

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The value of the header Host, whose name may be written in any case; empty if there is none.
std::string host_of(std::string request) {
  constexpr std::string_view kName = "\r\nhost:";
  std::transform(request.begin(), request.end(), request.begin(), to_lower);
  const std::size_t found = request.find(kName);
  if (found == std::string::npos) {
    return "";
  }
  const std::size_t begin = request.find_first_not_of(" \t", found + kName.size());
  return request.substr(begin, request.find("\r\n", begin) - begin);
}

bool asks_for(const std::string& request, std::string_view target) {
  return request.rfind(fmt::format("GET {} HTTP/1.", target), 0) == 0;
}

}  // namespace

PageServer::PageServer(std::uint16_t port)
    : listener_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const int yes = 1;
  setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_.number(), any, size) != 0 ||
      listen(listener_.number(), static_cast<int>(kMostBrowsers)) != 0 ||
      getsockname(listener_.number(), any, &size) != 0) {
    throw InputError(fmt::format("port {} of 127.0.0.1: {}", port, std::strerror(errno)));
  }
  port_ = ntohs(address.sin_port);
}

std::string PageServer::address() const { return fmt::format("http://127.0.0.1:{}/", port_); }

void PageServer::serve(const std::string& event) {
  accept_all();
  for (Browser& browser : browsers_) {
    if (browser.follows) {
      browser.is_done = !send_all(browser.socket, fmt::format("data: {}\n\n", event));
    } else {
      read(&browser);
    }
  }
  browsers_.erase(std::remove_if(browsers_.begin(), browsers_.end(),
                                 [](const Browser& browser) { return browser.is_done; }),
                  browsers_.end());
}

void PageServer::accept_all() {
  while (true) {
    FileDescriptor socket(
        accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.is_open()) {
      return;
    }
    if (browsers_.size() < kMostBrowsers) {
      browsers_.push_back({std::move(socket), "", 0, false, false});
    }
  }
}

void PageServer::read(Browser* browser) const {
  std::array<char, 2048> part{};
  ssize_t count = recv(browser->socket.number(), part.data(), part.size(), 0);
  while (count > 0 && browser->request.size() <= kLongestRequest) {
    browser->request.append(part.data(), static_cast<std::size_t>(count));
    count = recv(browser->socket.number(), part.data(), part.size(), 0);
  }
  const bool has_ended = count == 0 || (count < 0 && errno != EAGAIN);
  if (browser->request.find(kEndOfHead) != std::string::npos) {
    answer(browser);
  } else {
    browser->is_done =
        has_ended || browser->request.size() > kLongestRequest || ++browser->calls > kPatience;
  }
}

void PageServer::answer(Browser* browser) const {
  const std::string& request = browser->request;
  const std::string host = host_of(request);
  browser->is_done = true;
  if (host != fmt::format("127.0.0.1:{}", port_) && host != fmt::format("localhost:{}", port_)) {
    send_all(browser->socket, head("403 Forbidden", "text/plain") + "not for this host\n");
  } else if (asks_for(request, "/")) {
    send_all(browser->socket, head("200 OK", "text/html") + kPage);
  } else if (asks_for(request, "/events")) {
    browser->follows = send_all(browser->socket, head("200 OK", "text/event-stream"));
    browser->is_done = !browser->follows;
  } else {
    send_all(browser->socket, head("404 Not Found", "text/plain") + "there is / and /events\n");
  }
}

}  // namespace flexcomp::monitor
