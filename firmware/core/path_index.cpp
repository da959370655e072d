#include "flexcomp/path_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "path_index_tree.hpp"
#include "table_record.hpp"

namespace flexcomp {
namespace {

constexpr RecordLayout kPath = record_layout(Chart::path, false, false);
constexpr float kLargestAngle = 1e4F;
/// Rounding error of a scalar product over the largest angle, at both ends, with reserve.
constexpr float kRounding = 2e-6F;

using Direction = Eigen::Matrix<float, kTableJoints, 1>;
using Square = Eigen::Matrix<float, kTableJoints, kTableJoints>;

/// The direction in which a sum of squares is largest, by power iteration: near enough, as any
/// direction serves.
Direction principal_direction(const Square& squares) {
  constexpr int kIterations = 8;
  Eigen::Index largest = 0;
  squares.diagonal().maxCoeff(&largest);
  Direction direction = squares.col(largest);
  for (int i = 0; i < kIterations && direction.cwiseAbs().maxCoeff() > 0; ++i) {
    direction /= direction.cwiseAbs().maxCoeff();
    direction = squares.lazyProduct(direction).eval();
  }
  return direction.cwiseAbs().maxCoeff() > 0 ? direction : Direction(Direction::Unit(0));
}

/// Part of the sequence of segments, to be split in two halves.
struct Range {
  std::uint32_t* begin;
  std::uint32_t* middle;
  std::uint32_t* end;
};

class PathIndexBuilder {
 public:
  PathIndexBuilder(const Table& table, IndexNode* nodes)
      : table_(table),
        tree_(table.shape().node_count - 1),
        nodes_(nodes),
        order_(reinterpret_cast<std::uint32_t*>(nodes + tree_.nodes())) {}

  void build() {
    std::iota(order_, order_ + tree_.segments(), 0U);
    nodes_[0] = IndexNode{};
    for (std::uint32_t node = 1; node < tree_.nodes(); ++node) {
      nodes_[node] = split({order_ + tree_.begin(node), order_ + tree_.begin(2 * node + 1),
                            order_ + tree_.end(node)});
    }
  }

 private:
  Eigen::Map<const Direction> angles(std::uint32_t node) const {
    return Eigen::Map<const Direction>(table_.record(node) + kPath.angles);
  }
  Direction middle(std::uint32_t segment) const {
    return 0.5F * (angles(segment) + angles(segment + 1));
  }

  /// How far a segment reaches along a direction, its width and rounding included.
  struct Interval {
    float low;
    float high;
  };
  Interval interval(std::uint32_t segment, const Direction& direction) const {
    const float from = direction.dot(angles(segment));
    const float to = direction.dot(angles(segment + 1));
    const float width = std::abs(table_.record(segment)[kPath.width]);
    const float largest =
        std::max(angles(segment).cwiseAbs().maxCoeff(), angles(segment + 1).cwiseAbs().maxCoeff());
    const float aside = width + kRounding * (largest + width);
    return {std::min(from, to) - aside, std::max(from, to) + aside};
  }

  /// Shape of a range's segments: sums over all of them.
  struct Sums {
    Square places = Square::Zero();  ///< squares of where they lie about their mean
    Square chords = Square::Zero();  ///< of how they run from node to node
    float widths = 0;                ///< of how wide they are
  };
  Sums sums(const Range& range) const {
    Sums sums;
    const Direction origin = middle(*range.begin);
    Direction places = Direction::Zero();
    for (const std::uint32_t* at = range.begin; at != range.end; ++at) {
      const Direction place = middle(*at) - origin;
      const Direction chord = angles(*at + 1) - angles(*at);
      const float width = table_.record(*at)[kPath.width];
      places += place;
      sums.places += place.lazyProduct(place.transpose());
      sums.chords += chord.lazyProduct(chord.transpose());
      sums.widths += width * width;
    }
    sums.places -=
        places.lazyProduct(places.transpose()) / static_cast<float>(range.end - range.begin);
    return sums;
  }

  /// Across the segments or along them: where they lie further apart, beside what each reaches.
  IndexNode split(const Range& range) {
    const Sums found = sums(range);
    const Direction along = principal_direction(found.chords).normalized();
    const Square aside = Square::Identity() - along.lazyProduct(along.transpose());
    const Square places_aside = aside.lazyProduct(found.places).eval().lazyProduct(aside);
    const Direction across = principal_direction(places_aside).normalized();
    const auto apart = [&](const Direction& axis) {
      return axis.dot(found.places.lazyProduct(axis));
    };
    const auto reach = [&](const Direction& axis) {
      return axis.dot(found.chords.lazyProduct(axis)) + found.widths;
    };
    const bool is_across = apart(across) * reach(along) > apart(along) * reach(across);
    const Direction axis = is_across ? across : along;
    return split_along(axis / axis.cwiseAbs().sum(), range);
  }

  /// Puts the segments in two halves along a direction.
  IndexNode split_along(const Direction& direction, const Range& range) {
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return direction.dot(middle(a)) < direction.dot(middle(b));
    };
    std::nth_element(range.begin, range.middle, range.end, before);
    IndexNode node;
    Eigen::Map<Direction>(node.direction) = direction;
    node.reach = interval(*range.begin, direction).high;
    node.begin = interval(*range.middle, direction).low;
    for (const std::uint32_t* at = range.begin; at != range.middle; ++at) {
      node.reach = std::max(node.reach, interval(*at, direction).high);
    }
    for (const std::uint32_t* at = range.middle; at != range.end; ++at) {
      node.begin = std::min(node.begin, interval(*at, direction).low);
    }
    return node;
  }

  const Table& table_;
  PathIndexTree tree_;
  IndexNode* nodes_;
  std::uint32_t* order_;
};

bool angles_are_moderate(const Table& table) {
  for (std::uint32_t node = 0; node < table.shape().node_count; ++node) {
    const float* const record = table.record(node);
    const auto is_moderate = [](float number) { return std::abs(number) <= kLargestAngle; };
    if (!std::all_of(record + kPath.angles, record + kPath.angles + kTableJoints, is_moderate) ||
        !is_moderate(record[kPath.width])) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::size_t path_index_size(const Table& table) {
  if (!table.is_open() || table.chart() != Chart::path) {
    return 0;
  }
  const PathIndexTree tree(table.shape().node_count - 1);
  return sizeof(IndexNode) * tree.nodes() +
         sizeof(std::uint32_t) * static_cast<std::size_t>(tree.segments());
}

Result index_path(void* memory, std::size_t capacity, Table* table) {
  if (table == nullptr || !table->is_open()) {
    return Result::bad_argument;
  }
  if (table->chart() != Chart::path) {
    return Result::ok;
  }
  if (memory == nullptr || reinterpret_cast<std::uintptr_t>(memory) % alignof(IndexNode) != 0) {
    return Result::bad_argument;
  }
  if (capacity < path_index_size(*table)) {
    return Result::buffer_too_small;
  }
  if (!angles_are_moderate(*table)) {
    return Result::table_corrupt;
  }
  auto* const nodes = static_cast<IndexNode*>(memory);
  PathIndexBuilder(*table, nodes).build();
  table->use_index(nodes);
  return Result::ok;
}

}  // namespace flexcomp
