#include "flexcomp/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "crc32.hpp"
#include "grid_chart.hpp"
#include "instantiate.hpp"
#include "path_chart.hpp"
#include "table_record.hpp"

namespace flexcomp {
namespace {

static_assert(sizeof(TableHeader) == 268, "the header is written to files: no padding");

std::uint32_t table_crc(const void* data, std::uint32_t size) {
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

/// Is every number behind the header's integers finite?
bool numbers_are_finite(const TableHeader& header) {
  constexpr std::size_t kIntegers = offsetof(TableHeader, grid_lower);
  const auto* numbers =
      reinterpret_cast<const float*>(reinterpret_cast<const unsigned char*>(&header) + kIntegers);
  const std::size_t count = (header.size - kIntegers) / sizeof(float);
  return std::all_of(numbers, numbers + count, [](float number) { return std::isfinite(number); });
}

}  // namespace

Result Table::open(const void* data, std::size_t size, Table* table) {
  if (data == nullptr || table == nullptr) {
    return Result::bad_argument;
  }
  if (reinterpret_cast<std::uintptr_t>(data) % alignof(TableHeader) != 0) {
    return Result::table_misaligned;
  }
  if (size < sizeof(TableHeader)) {
    return Result::table_truncated;
  }
  const auto* header = static_cast<const TableHeader*>(data);
  if (header->magic != kMagic) {
    return Result::table_not_a_table;
  }
  if (header->version != kTableVersion) {
    return Result::table_version;
  }
  if (header->size > size) {
    return Result::table_truncated;
  }
  if (header->size < size || header->size % 4 != 0 ||
      table_crc(data, header->size) != header->crc || !fields_are_consistent(*header) ||
      !numbers_are_finite(*header)) {
    return Result::table_corrupt;
  }
  table->header_ = header;
  table->records_ = reinterpret_cast<const float*>(header + 1);
  return Result::ok;
}

std::uint64_t Table::model_hash() const {
  return (std::uint64_t{header_->model_hash_high} << 32) | header_->model_hash_low;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up(const Table& table, const JointVector<Scalar, Joints>& q,
                                   TableCursor* cursor) {
  return table.chart() == Chart::path ? look_up_path<Scalar, Joints>(table, q, cursor)
                                      : look_up_grid<Scalar, Joints>(table, q);
}

template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> respond(const Table& table, const TableEntry<Scalar, Joints>& entry,
                                      const Wrench<Scalar>& wrench) {
  const JointVector<Scalar, Joints> torque =
      wrench_torque<Scalar, Joints>(entry.jacobian, wrench) + entry.weight_torque;
  JointVector<Scalar, Joints> windup;
  for (std::size_t i = 0; i < Joints; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const Scalar t = torque[joint];
    windup[joint] = (static_cast<Scalar>(table.header().compliance[i]) +
                     static_cast<Scalar>(table.header().cubic_compliance[i]) * t * t) *
                    t;
  }
  TableResponse<Scalar, Joints> response;
  response.deflection = entry.jacobian.lazyProduct(windup);
  response.correction = -windup;
  if (table.has_structure()) {
    response.deflection += entry.structure.lazyProduct(wrench) + entry.structure_weight;
    response.correction -=
        entry.structure_motion.lazyProduct(wrench) + entry.structure_weight_motion;
  }
  return response;
}

/// A function of its own, so that path tables need not make room for an entry.
template <typename Scalar, int Joints>
[[gnu::noinline]] static TableResponse<Scalar, Joints> respond_on_grid(
    const Table& table, const JointVector<Scalar, Joints>& q, const Wrench<Scalar>& wrench,
    Scalar* outside) {
  const TableEntry<Scalar, Joints> entry = look_up_grid<Scalar, Joints>(table, q);
  *outside = entry.outside;
  return respond<Scalar, Joints>(table, entry, wrench);
}

template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> look_up_response(const Table& table,
                                               const JointVector<Scalar, Joints>& q,
                                               const Wrench<Scalar>& wrench, TableCursor* cursor,
                                               Scalar* outside) {
  if (table.chart() == Chart::path) {
    return respond_on_path<Scalar, Joints>(table, q, wrench, cursor, outside);
  }
  return respond_on_grid<Scalar, Joints>(table, q, wrench, outside);
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot stand in them
#define FLEXCOMP_TABLE(Scalar, Joints)                                                            \
  template TableEntry<Scalar, Joints> look_up(const Table&, const JointVector<Scalar, Joints>&,   \
                                              TableCursor*);                                      \
  template TableResponse<Scalar, Joints> respond(const Table&, const TableEntry<Scalar, Joints>&, \
                                                 const Wrench<Scalar>&);                          \
  template TableResponse<Scalar, Joints> look_up_response(                                        \
      const Table&, const JointVector<Scalar, Joints>&, const Wrench<Scalar>&, TableCursor*,      \
      Scalar*);
// NOLINTEND(bugprone-macro-parentheses)
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE)

}  // namespace flexcomp
