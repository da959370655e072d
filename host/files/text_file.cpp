#include "files/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "error.hpp"

namespace flexcomp::files {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

std::string last_error() { return std::strerror(errno); }

void write_directly(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  if (!stream) {
    fail(path, fmt::format("cannot be written: {}", last_error()));
  }
  write(stream);
  stream.flush();
  if (!stream) {
    fail(path, fmt::format("cannot be written: {}", last_error()));
  }
}

/// Removes a temporary file unless it has taken its place.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!kept_) {
      fs::remove(path_, ignored);
    }
  }

  const fs::path& path() const { return path_; }

  void replace(const fs::path& target) {
    std::error_code error;
    fs::rename(path_, target, error);
    if (error) {
      fail(target, fmt::format("cannot be written: {}", error.message()));
    }
    kept_ = true;
  }

 private:
  fs::path path_;
  bool kept_ = false;
};

}  // namespace

std::string read_file(const fs::path& path, std::size_t limit) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    fail(path, "no such file");
  }
  if (fs::is_directory(status)) {
    fail(path, "is a directory; expected a file");
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    fail(path, fmt::format("cannot be read: {}", last_error()));
  }
  std::string content;
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    content.append(block, static_cast<std::size_t>(stream.gcount()));
    if (content.size() > limit) {
      fail(path, fmt::format("larger than {} MiB", limit >> 20));
    }
  }
  if (stream.bad()) {
    fail(path, fmt::format("cannot be read: {}", last_error()));
  }
  if (content.empty()) {
    fail(path, "the file is empty");
  }
  return content;
}

std::string read_text(const fs::path& path) {
  std::string text = read_file(path, std::size_t{1} << 30);
  if (text.find('\0') != std::string::npos) {
    fail(path, "not a text file");
  }
  return text;
}

void write_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    fail(path, "is a directory; expected a file to write");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    write_directly(path, write);
    return;
  }
  // A link is written through: what it points to is replaced, not the link.
  const fs::path target = fs::is_symlink(fs::symlink_status(path, error)) ? fs::canonical(path) : path;
  TemporaryFile temporary(target.string() + fmt::format(".{}.part", ::getpid()));
  try {
    write_directly(temporary.path(), write);
  } catch (const InputError&) {
    fail(path, fmt::format("cannot be written: {}", last_error()));
  }
  temporary.replace(target);
}

}  // namespace flexcomp::files
