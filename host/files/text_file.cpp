#include "files/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#include "error.hpp"

namespace flexcomp::files {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

std::string last_error() { return std::strerror(errno); }

/// Writes into `file`; messages speak of `asked`, the path that the caller knows.
void write_into(const fs::path& file, const fs::path& asked,
                const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  if (!stream) {
    fail(asked, fmt::format("cannot be written: {}", last_error()));
  }
  write(stream);
  stream.close();
  if (!stream) {
    fail(asked, fmt::format("cannot be written: {}", last_error()));
  }
}

/// A full disk or a power cut may otherwise leave an empty file under the new name.
void flush_to_disk(const fs::path& file, const fs::path& asked) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::string reason = last_error();
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (!flushed) {
    fail(asked, fmt::format("cannot be written: {}", reason));
  }
}

/// Follows links: a link is written through, so its target is replaced, not the link.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) {
    return path;
  }
  fs::path target = fs::canonical(path, error);
  if (error) {
    fail(path, fmt::format("cannot be written: {}", error.message()));
  }
  return target;
}

/// Names of the temporary files under way, for `remove_unfinished_file`; empty where there is none.
constexpr std::size_t kMostAtOnce = 8;
std::array<std::array<char, 4096>, kMostAtOnce> unfinished_files{};

/// A temporary file beside the one whose place it is to take; removed unless it has taken it.
class TemporaryFile {
 public:
  /// Messages speak of `asked`, the path that the caller knows; `target` is what it stands for.
  TemporaryFile(fs::path target, fs::path asked)
      : asked_(std::move(asked)),
        target_(std::move(target)),
        path_(target_.string() + fmt::format(".{}.part", ::getpid())) {
    auto* const free = std::find_if(unfinished_files.begin(), unfinished_files.end(),
                                    [](const auto& name) { return name[0] == '\0'; });
    const std::size_t length = path_.native().size();
    if (free != unfinished_files.end() && length < free->size()) {
      path_.native().copy(free->data(), length);
      (*free)[length] = '\0';
      name_ = free->data();
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!kept_) {
      fs::remove(path_, ignored);
    }
    if (name_ != nullptr) {
      name_[0] = '\0';
    }
  }

  const fs::path& path() const { return path_; }

  void take_its_place() {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) {
      fail(asked_, fmt::format("cannot be written: {}", error.message()));
    }
    kept_ = true;
  }

 private:
  fs::path asked_;
  fs::path target_;
  fs::path path_;
  char* name_ = nullptr;  ///< among the unfinished files
  bool kept_ = false;
};

/// A file that is complete and on the disk, but has not taken its place yet; none for a device or
/// pipe, which is written directly.
std::unique_ptr<TemporaryFile> completed(const fs::path& path,
                                         const std::function<void(std::ostream&)>& write) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    fail(path, "is a directory; expected a file to write");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    write_into(path, path, write);
    return nullptr;
  }
  auto temporary = std::make_unique<TemporaryFile>(resolved(path), path);
  write_into(temporary->path(), path, write);
  flush_to_disk(temporary->path(), path);
  if (fs::exists(status)) {
    fs::permissions(temporary->path(), status.permissions(), error);
  }
  return temporary;
}

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
  // A pipe is taken, because a shell may put one there; a device may have no end.
  if (fs::is_character_file(status) || fs::is_block_file(status) || fs::is_socket(status)) {
    fail(path, "is a device or socket; expected a file");
  }
  if (fs::is_regular_file(status) && fs::file_size(path, error) > limit && !error) {
    fail(path, fmt::format("larger than {} MiB", limit >> 20));
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

std::string read_text(const fs::path& path, std::size_t limit) {
  std::string text = read_file(path, limit);
  if (text.find('\0') != std::string::npos) {
    fail(path, "not a text file");
  }
  return text;
}

void write_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  const std::unique_ptr<TemporaryFile> file = completed(path, write);
  if (file) {
    file->take_its_place();
  }
}

void write_text(const fs::path& path, const std::string& text) {
  write_file(path, [&](std::ostream& out) { out << text; });
}

void write_texts(const std::vector<std::pair<fs::path, std::string>>& texts) {
  std::vector<std::unique_ptr<TemporaryFile>> files;
  files.reserve(texts.size());
  for (const auto& [path, text] : texts) {
    files.push_back(completed(path, [&text = text](std::ostream& out) { out << text; }));
  }
  for (const std::unique_ptr<TemporaryFile>& file : files) {
    if (file) {
      file->take_its_place();
    }
  }
}

void remove_unfinished_file() noexcept {
  for (const auto& name : unfinished_files) {
    if (name[0] != '\0') {
      ::unlink(name.data());
    }
  }
}

}  // namespace flexcomp::files
