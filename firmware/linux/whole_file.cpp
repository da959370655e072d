#include "linux/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "linux/file_descriptor.hpp"

namespace flexcomp {
namespace {

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error(path + ": " + std::strerror(errno));
}

[[noreturn]] void refuse_larger_than(const std::string& path, std::size_t most) {
  throw std::runtime_error(path + ": larger than " + std::to_string(most) + " bytes");
}

/// Status of the open `file`, not of `path`: nobody can put another file there in between.
struct stat ordinary(const FileDescriptor& file, const std::string& path) {
  struct stat status {};
  if (fstat(file.number(), &status) != 0) {
    fail(path);
  }
  if (!S_ISREG(status.st_mode)) {
    throw std::runtime_error(path + ": not an ordinary file");
  }
  return status;
}

/// Reads until the end, or until `bytes` is full.
std::size_t read_into(std::vector<char>* bytes, const FileDescriptor& file,
                      const std::string& path) {
  std::size_t count = 0;
  while (count < bytes->size()) {
    const ssize_t got = read(file.number(), bytes->data() + count, bytes->size() - count);
    if (got < 0 && errno != EINTR) {
      fail(path);
    }
    if (got == 0) {
      break;
    }
    count += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  return count;
}

void write_all(const FileDescriptor& file, const std::string& path, const char* data,
               std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(file.number(), data, size);
    if (written < 0 && errno != EINTR) {
      fail(path);
    }
    const std::size_t done = written > 0 ? static_cast<std::size_t>(written) : 0;
    data += done;
    size -= done;
  }
}

}  // namespace

std::optional<std::vector<char>> read_whole(const std::string& path, std::size_t most) {
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!file.is_open()) {
    if (errno == ENOENT) {
      return std::nullopt;
    }
    fail(path);
  }
  const auto announced = static_cast<std::size_t>(ordinary(file, path).st_size);
  if (announced > most) {
    refuse_larger_than(path, most);
  }
  // One byte more tells whether it has grown. Files of the kernel say that they are empty.
  std::vector<char> bytes(announced > 0 ? announced + 1 : most + 1);
  const std::size_t count = read_into(&bytes, file, path);
  if (count > most) {
    refuse_larger_than(path, most);
  }
  if (count == bytes.size()) {
    throw std::runtime_error(path + ": grew while it was read");
  }
  bytes.resize(count);
  return bytes;
}

void write_whole(const std::string& path, const void* data, std::size_t size, Readers readers) {
  const mode_t mode = readers == Readers::owner ? 0600 : 0644;
  const std::string aside = path + ".new";
  {
    // A FIFO or a device must not keep us waiting, and a link not lead elsewhere.
    const FileDescriptor file(open(
        aside.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW | O_NOCTTY, mode));
    if (!file.is_open() && (errno == ENXIO || errno == ELOOP)) {
      throw std::runtime_error(aside + ": not an ordinary file");
    }
    if (!file.is_open()) {
      fail(aside);
    }
    ordinary(file, aside);
    if (readers == Readers::owner && fchmod(file.number(), mode) != 0) {
      fail(aside);
    }
    if (ftruncate(file.number(), 0) != 0) {
      fail(aside);
    }
    write_all(file, aside, static_cast<const char*>(data), size);
    if (fsync(file.number()) != 0) {
      fail(aside);
    }
  }
  if (std::rename(aside.c_str(), path.c_str()) != 0) {
    fail(path);
  }
  const std::string folder =
      path.find('/') == std::string::npos ? "." : path.substr(0, path.rfind('/') + 1);
  const FileDescriptor directory(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  fsync(directory.number());
}

}  // namespace flexcomp
