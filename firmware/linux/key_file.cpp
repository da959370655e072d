#include "linux/key_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "linux/file_descriptor.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kDigits = 2 * std::tuple_size_v<AuthenticationKey>;

/// Looks at what it has opened, so that nobody can put another file there in between. Never waits,
/// whatever the path names.
std::string read_private(const std::string& path) {
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!file.is_open() || fstat(file.number(), &status) != 0) {
    throw std::runtime_error(path + ": " + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    throw std::runtime_error(path + ": a key is expected in an ordinary file");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw std::runtime_error(path + ": others than its owner have access to this key (chmod 600)");
  }
  std::string text(kDigits + 2, '\0');  // one more than is allowed
  const ssize_t count = read(file.number(), text.data(), text.size());
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

}  // namespace

AuthenticationKey read_key(const std::string& path) {
  std::string text = read_private(path);
  if (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  AuthenticationKey key{};
  bool is_key = text.size() == kDigits;
  for (std::size_t i = 0; is_key && i < key.size(); ++i) {
    const char* const pair = text.data() + 2 * i;
    is_key = std::from_chars(pair, pair + 2, key[i], 16).ptr == pair + 2;
  }
  if (!is_key) {
    throw std::runtime_error(path + ": expected a key of 32 hexadecimal digits");
  }
  return key;
}

}  // namespace flexcomp
