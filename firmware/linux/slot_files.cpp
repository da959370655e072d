#include "linux/slot_files.hpp"

#include <charconv>
#include <cstring>
#include <stdexcept>

#include "flexcomp/table.hpp"
#include "linux/complaint.hpp"
#include "linux/whole_file.hpp"
#include "messages/table_trailer.hpp"

namespace flexcomp {
namespace {

constexpr const char* kFiles[2] = {"table-a.fct", "table-b.fct"};
constexpr const char* kActive = "active";
constexpr const char* kCounter = "counter";
constexpr std::size_t kLongestName = 64;

/// Nothing, too, for what is not to be read: what was kept beside it must then do.
std::optional<std::vector<char>> read_if_possible(const std::string& path, std::size_t most) {
  try {
    return read_whole(path, most);
  } catch (const std::runtime_error& error) {
    complain(error.what());
    return std::nullopt;
  }
}

/// With a trailer or without.
bool is_table(const std::vector<char>& bytes) {
  std::vector<std::uint32_t> aligned(bytes.size() / sizeof(std::uint32_t) + 1);
  std::memcpy(aligned.data(), bytes.data(), bytes.size());
  Table table;
  return Table::open(aligned.data(), bytes_of_table(aligned.data(), bytes.size()), &table) ==
         Result::ok;
}

const char* other_than(const std::optional<std::string>& name) {
  return name.value_or(kFiles[0]) == kFiles[0] ? kFiles[1] : kFiles[0];
}

}  // namespace

std::optional<std::string> SlotFiles::active() const {
  const std::optional<std::vector<char>> name = read_if_possible(path(kActive), kLongestName);
  for (const char* file : kFiles) {
    if (name && std::string(name->begin(), name->end()) == file) {
      return file;
    }
  }
  return std::nullopt;
}

std::optional<std::vector<char>> SlotFiles::table(const std::string& name, std::size_t most) const {
  std::optional<std::vector<char>> bytes = read_if_possible(path(name.c_str()), most);
  return bytes && is_table(*bytes) ? std::move(bytes) : std::nullopt;
}

std::optional<std::vector<char>> SlotFiles::newest(std::size_t most) const {
  const std::string first = active().value_or(kFiles[0]);
  std::optional<std::vector<char>> bytes = table(first, most);
  return bytes ? std::move(bytes) : table(other_than(first), most);
}

std::optional<std::vector<char>> SlotFiles::confirmed(std::size_t most) const {
  const std::optional<std::string> name = active();
  return name ? table(*name, most) : std::nullopt;
}

void SlotFiles::keep(const void* data, std::size_t size) {
  stage(data, size);
  confirm();
}

void SlotFiles::stage(const void* data, std::size_t size) {
  staged_.clear();
  const char* const name = other_than(active());
  write_whole(path(name), data, size);
  staged_ = name;
}

bool SlotFiles::confirm() {
  if (staged_.empty()) {
    return false;
  }
  write_whole(path(kActive), staged_.data(), staged_.size());
  staged_.clear();
  return true;
}

std::uint32_t SlotFiles::counter() const {
  const std::optional<std::vector<char>> text = read_whole(path(kCounter), kLongestName);
  if (!text) {
    return 0;
  }
  const char* const end = text->data() + text->size();
  std::uint32_t counter = 0;
  const auto [rest, error] = std::from_chars(text->data(), end, counter);
  const bool is_number = error == std::errc() && rest + 1 == end && *rest == '\n';
  if (!is_number) {
    throw std::runtime_error(path(kCounter) + ": expected the counter of a table, a whole number");
  }
  return counter;
}

void SlotFiles::raise_counter(std::uint32_t counter) {
  if (counter > this->counter()) {
    const std::string text = std::to_string(counter) + "\n";
    write_whole(path(kCounter), text.data(), text.size());
  }
}

}  // namespace flexcomp
