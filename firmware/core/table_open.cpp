#include <algorithm>
#include <cmath>
#include <cstddef>

#include "crc32.hpp"
#include "flexcomp/table.hpp"
#include "table_record.hpp"

namespace flexcomp {
namespace {

static_assert(sizeof(TableHeader) == 268, "the header is written to files: no padding");

std::uint32_t table_crc(const void* data, std::size_t size) {
  constexpr std::size_t kBefore = offsetof(TableHeader, crc);
  constexpr std::size_t kAfter = kBefore + sizeof(std::uint32_t);
  const auto* bytes = static_cast<const unsigned char*>(data);
  const std::uint32_t zero = 0;
  std::uint32_t crc = crc32(bytes, kBefore);
  crc = crc32(&zero, sizeof zero, crc);
  return crc32(bytes + kAfter, size - kAfter, crc);
}

bool fields_are_consistent(const TableHeader& header) {
  const bool known_chart = header.chart == static_cast<std::uint32_t>(Chart::path) ||
                           header.chart == static_cast<std::uint32_t>(Chart::joint_grid);
  if (!known_chart || header.joints != kTableJoints || header.contents > 3U) {
    return false;
  }
  const RecordLayout layout =
      record_layout(static_cast<Chart>(header.chart), (header.contents & Table::kWeight) != 0,
                    (header.contents & Table::kStructure) != 0);
  const std::uint64_t bytes =
      sizeof(TableHeader) + std::uint64_t{4} * header.record_size * header.node_count;
  if (header.record_size != layout.size || bytes != header.size) {
    return false;
  }
  if (header.chart == static_cast<std::uint32_t>(Chart::path)) {
    return header.node_count >= 2;
  }
  if (header.grid_axes < 1 || header.grid_axes > kMaxGridAxes) {
    return false;
  }
  std::uint64_t nodes = 1;
  for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
    const bool good = header.grid_nodes[axis] >= 2 && header.grid_nodes[axis] < 65536 &&
                      header.grid_joint[axis] < kTableJoints && header.grid_step[axis] > 0.0F;
    if (!good) {
      return false;
    }
    nodes *= header.grid_nodes[axis];
  }
  return nodes == header.node_count;
}

/// The fields are consistent.
TableShape shape_of(const TableHeader& header) {
  TableShape shape;
  shape.chart = static_cast<std::uint8_t>(header.chart);
  shape.contents = static_cast<std::uint8_t>(header.contents);
  shape.record_size = static_cast<std::uint16_t>(header.record_size);
  shape.node_count = header.node_count;
  shape.closed = header.closed != 0;
  if (header.chart == static_cast<std::uint32_t>(Chart::joint_grid)) {
    shape.grid_axes = static_cast<std::uint8_t>(header.grid_axes);
    for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
      shape.grid_joint[axis] = static_cast<std::uint8_t>(header.grid_joint[axis]);
      shape.grid_nodes[axis] = static_cast<std::uint16_t>(header.grid_nodes[axis]);
    }
  }
  return shape;
}

/// Is every number behind the header's integers finite?
bool numbers_are_finite(const void* data, std::size_t size) {
  constexpr std::size_t kIntegers = offsetof(TableHeader, grid_lower);
  const auto* numbers =
      reinterpret_cast<const float*>(static_cast<const unsigned char*>(data) + kIntegers);
  const std::size_t count = (size - kIntegers) / sizeof(float);
  return std::all_of(numbers, numbers + count, [](float number) { return std::isfinite(number); });
}

}  // namespace

Result Table::find_size(const void* data, std::size_t available, std::size_t* size) {
  if (data == nullptr || size == nullptr) {
    return Result::bad_argument;
  }
  if (reinterpret_cast<std::uintptr_t>(data) % alignof(TableHeader) != 0) {
    return Result::table_misaligned;
  }
  const auto* header = static_cast<const TableHeader*>(data);
  if (available >= sizeof header->magic && header->magic != kMagic) {
    return Result::table_not_a_table;
  }
  if (available < sizeof(TableHeader)) {
    return Result::table_truncated;
  }
  if (header->version != kTableVersion) {
    return Result::table_version;
  }
  if (header->size > available) {
    return Result::table_truncated;
  }
  if (!fields_are_consistent(*header)) {
    return Result::table_corrupt;
  }
  *size = header->size;
  return Result::ok;
}

Result Table::open(const void* data, std::size_t size, Table* table) {
  std::size_t own = 0;
  const Result result = table == nullptr ? Result::bad_argument : find_size(data, size, &own);
  if (result != Result::ok) {
    return result;
  }
  if (own != size || table_crc(data, size) != static_cast<const TableHeader*>(data)->crc ||
      !numbers_are_finite(data, size)) {
    return Result::table_corrupt;
  }
  return reopen(data, size, table);
}

Result Table::reopen(const void* data, std::size_t size, Table* table) {
  if (data == nullptr || table == nullptr || size < sizeof(TableHeader)) {
    return Result::bad_argument;
  }
  const auto* memory = static_cast<const TableHeader*>(data);
  const TableHeader header = *memory;  // what is checked is what is kept
  if (header.size != size || !fields_are_consistent(header)) {
    return Result::table_corrupt;
  }
  table->header_ = memory;
  table->records_ = reinterpret_cast<const float*>(memory + 1);
  table->index_ = nullptr;
  table->shape_ = shape_of(header);
  return Result::ok;
}

}  // namespace flexcomp
