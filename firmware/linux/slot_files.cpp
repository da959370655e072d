#include "linux/slot_files.hpp"

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

constexpr const char* kFiles[2] = {"table-a.fct", "table-b.fct"};
constexpr const char* kActive = "active";

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
  const std::string folder = path.substr(0, path.rfind('/'));
  const FileDescriptor directory(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  fsync(directory.number());
}

bool is_table(const std::vector<char>& bytes) {
  std::vector<std::uint32_t> aligned(bytes.size() / sizeof(std::uint32_t) + 1);
  std::memcpy(aligned.data(), bytes.data(), bytes.size());
  Table table;
  return Table::open(aligned.data(), bytes.size(), &table) == Result::ok;
}

}  // namespace

std::optional<std::vector<char>> read_bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.eof() && stream.fail()) {
    return std::nullopt;
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

std::string SlotFiles::active() const {
  const std::optional<std::vector<char>> name = read_bytes(path(kActive));
  const std::string text = name ? std::string(name->begin(), name->end()) : "";
  return text == kFiles[1] ? kFiles[1] : kFiles[0];
}

std::optional<std::vector<char>> SlotFiles::newest() const {
  const std::string first = active();
  const std::string second = first == kFiles[0] ? kFiles[1] : kFiles[0];
  for (const std::string& name : {first, second}) {
    std::optional<std::vector<char>> bytes = read_bytes(path(name.c_str()));
    if (bytes && is_table(*bytes)) {
      return bytes;
    }
  }
  return std::nullopt;
}

void SlotFiles::keep(const void* data, std::size_t size) {
  const std::string name = active() == kFiles[0] ? kFiles[1] : kFiles[0];
  write_whole(path(name.c_str()), data, size);
  write_whole(path(kActive), name.data(), name.size());
}

}  // namespace flexcomp
