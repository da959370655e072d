// Any bytes as a table: opened, and if that works looked up at any joint angles, with any wrench.
//
// Input: flags (1 byte: 1 the size is set to fit, 2 the CRC too, 4 the table lies at an odd
// address, 8 it gets an index, 16 that is damaged), then the table; its last 28 bytes serve as
// joint angles and force too.
#include <algorithm>
#include <cmath>
#include <vector>

#include "byte_source.hpp"
#include "core/crc32.hpp"
#include "flexcomp/path_index.hpp"

using namespace flexcomp;
using flexcomp::fuzz::ByteSource;
using flexcomp::fuzz::expect;

namespace {

constexpr std::size_t kMost = 1 << 16;

template <typename Scalar>
void look_around(const Table& table, ByteSource bytes) {
  TableCursor cursor;
  for (int i = 0; i < 8; ++i) {
    JointVector<Scalar, 6> q;
    Wrench<Scalar> wrench;
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const auto angle = static_cast<Scalar>(bytes.take<float>());
      q[joint] = std::isfinite(angle) ? angle : Scalar(0);
      wrench[joint] = Scalar(100) * q[joint];
    }
    if (i % 4 == 0) {
      locate<Scalar, 6>(table, q, &cursor);
    }
    const TableEntry<Scalar, 6> entry = look_up<Scalar, 6>(table, q, &cursor);
    expect(!(entry.outside < Scalar(0)), "nothing is outside by less than nothing");
    expect(table.chart() != Chart::path || cursor.segment + 1 < table.header().node_count,
           "the cursor stays in the table");
    respond<Scalar, 6>(table, entry, wrench);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  const auto flags = bytes.take<std::uint8_t>();
  if (size <= sizeof(TableHeader) + 1 || size > kMost) {
    return 0;
  }
  const std::size_t table_size = size - 1;
  // Exactly as large as the table, so that the sanitizer sees every byte read beyond it.
  std::vector<unsigned char> memory(table_size + 4);
  unsigned char* place = memory.data() + ((flags & 4U) != 0 ? 1 : 4);
  bytes.take_into(place, table_size);
  if ((flags & 1U) != 0) {
    const auto stated = static_cast<std::uint32_t>(table_size);
    std::memcpy(place + offsetof(TableHeader, size), &stated, sizeof stated);
  }
  if ((flags & 2U) != 0) {
    std::uint32_t crc = 0;
    std::memcpy(place + offsetof(TableHeader, crc), &crc, sizeof crc);
    crc = crc32(place, table_size);
    std::memcpy(place + offsetof(TableHeader, crc), &crc, sizeof crc);
  }
  Table table;
  if (Table::open(place, table_size, &table) == Result::ok) {
    std::vector<std::uint32_t> index((flags & 8U) != 0 ? path_index_size(table) / 4 : 0);
    if (index_path(index.data(), 4 * index.size(), &table) == Result::ok && (flags & 16U) != 0) {
      std::rotate(index.begin(), index.begin() + static_cast<std::ptrdiff_t>(index.size() / 3),
                  index.end());
    }
    const std::size_t seen = std::min<std::size_t>(table_size, 196);
    look_around<float>(table, ByteSource(place + table_size - seen, seen));
    look_around<double>(table, ByteSource(place + table_size - seen, seen));
  }
  return 0;
}
