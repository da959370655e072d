#include "linux/slot_files.hpp"

#include <cstring>
#include <stdexcept>

#include "flexcomp/table.hpp"
#include "linux/complaint.hpp"
#include "linux/whole_file.hpp"

namespace flexcomp {
namespace {

constexpr const char* kFiles[2] = {"table-a.fct", "table-b.fct"};
constexpr const char* kActive = "active";
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

bool is_table(const std::vector<char>& bytes) {
  std::vector<std::uint32_t> aligned(bytes.size() / sizeof(std::uint32_t) + 1);
  std::memcpy(aligned.data(), bytes.data(), bytes.size());
  Table table;
  return Table::open(aligned.data(), bytes.size(), &table) == Result::ok;
}

}  // namespace

std::string SlotFiles::active() const {
  const std::optional<std::vector<char>> name = read_if_possible(path(kActive), kLongestName);
  const std::string text = name ? std::string(name->begin(), name->end()) : "";
  return text == kFiles[1] ? kFiles[1] : kFiles[0];
}

std::optional<std::vector<char>> SlotFiles::newest(std::size_t most) const {
  const std::string first = active();
  const std::string second = first == kFiles[0] ? kFiles[1] : kFiles[0];
  for (const std::string& name : {first, second}) {
    std::optional<std::vector<char>> bytes = read_if_possible(path(name.c_str()), most);
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
