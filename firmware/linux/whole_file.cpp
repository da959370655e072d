#include "linux/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "linux/file_descriptor.hpp"

namespace flexcomp {
namespace {

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error(path + ": " + std::strerror(errno));
}

void write_all(const FileDescriptor& file, const std::string& path, const char* data,
               std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(file.number(), data, size);
    if (written < 0) {
      fail(path);
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

}  // namespace

std::optional<std::vector<char>> read_whole(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.eof() && stream.fail()) {
    return std::nullopt;
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

void write_whole(const std::string& path, const void* data, std::size_t size) {
  const std::string aside = path + ".new";
  {
    const FileDescriptor file(open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (!file.is_open()) {
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
