#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

namespace flexcomp::test {

/// A raster of lines 0.3 rad long, there and back, as its nodes: bent in joint space, and a
/// thousandth of their length apart, as those of a straight cut are.
struct Raster {
  int lines;
  int nodes_a_line;

  int nodes() const { return lines * nodes_a_line; }

  JointVector<float, 6> angles(int node) const {
    const int line = node / nodes_a_line;
    const double there = static_cast<double>(node % nodes_a_line) / (nodes_a_line - 1) - 0.5;
    const double x = 0.3 * (line % 2 == 0 ? there : -there);
    const double y = 0.3 * line / 1000;
    JointVector<double, 6> q;
    q << x + 0.1 * x * y, -1.2 + 0.6 * y + 0.3 * x * x, 1.4 - 0.8 * y - 0.5 * x * x,
        0.3 + 0.4 * x - 0.2 * x * y, 0.7 + 0.3 * y + 0.2 * x * x, -0.5 - 0.7 * x + 0.1 * y * y;
    return q.cast<float>();
  }

  /// On the chord that follows a node.
  JointVector<float, 6> between(int node, float share) const {
    return angles(node) + share * (angles(node + 1) - angles(node));
  }
};

/// A path table with these nodes, as words. It is put together from the planes and angles that a
/// builder writes, and one node's numbers for all others, because a builder takes minutes for so
/// many. To be opened with `Table::reopen`.
inline std::vector<std::uint32_t> raster_table(const Raster& raster) {
  constexpr std::size_t kHeader = sizeof(TableHeader) / 4;
  constexpr float kWidth = 4e-5F;
  const JointVector<float, 6> ends[2] = {raster.angles(0), raster.angles(1)};
  std::vector<std::uint32_t> words(1 << 12);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(
      Result::ok, (build_path_table<float, 6>(kr270<float>(), ends, 2, {1000, 10, 1e-4F, 1e-4F, 0},
                                              words.data(), 4 * words.size(), &size)));
  TableHeader header;
  std::memcpy(&header, words.data(), sizeof header);
  const std::vector<std::uint32_t> record(words.begin() + kHeader,
                                          words.begin() + kHeader + header.record_size);
  header.node_count = static_cast<std::uint32_t>(raster.nodes());
  header.size =
      static_cast<std::uint32_t>(sizeof header) + 4 * header.record_size * header.node_count;
  words.assign(header.size / 4, 0);
  std::memcpy(words.data(), &header, sizeof header);
  for (int node = 0; node < raster.nodes(); ++node) {
    const auto direction = [&](int from) {
      const int first = std::clamp(from, 0, raster.nodes() - 2);
      return JointVector<float, 6>((raster.angles(first + 1) - raster.angles(first)).normalized());
    };
    const JointVector<float, 6> in = direction(node - 1), out = direction(node);
    const JointVector<float, 6> mean = (in + out).normalized();
    const bool sharp = in.dot(out) < 0.867F;
    Eigen::Matrix<float, 25, 1> front;
    front << raster.angles(node), mean, sharp ? in : mean, sharp ? out : mean, kWidth;
    auto* const at = words.data() + kHeader + static_cast<std::size_t>(node) * header.record_size;
    std::copy(record.begin(), record.end(), at);
    std::memcpy(at, front.data(), sizeof front);
  }
  return words;
}

}  // namespace flexcomp::test
