#pragma once

#include "flexcomp/path_index.hpp"

namespace flexcomp {

/// Shape of an index, which follows from the number of segments: a full binary tree of splits,
/// whose leaves hold up to five segments each. Behind the splits stand the segments' numbers, in
/// the order of the leaves.
class PathIndexTree {
 public:
  explicit PathIndexTree(std::uint32_t segments) : segments_(segments) {
    constexpr std::uint32_t kLeaf = 4;
    const std::uint32_t level = level_of(segments);
    depth_ = level > 2 ? level - 2 : 0;
    depth_ += (segments >> depth_) > kLeaf ? 1 : 0;
  }

  std::uint32_t segments() const { return segments_; }
  /// Splits, the unused node 0 included; leaves have this number and those behind it.
  std::uint32_t nodes() const { return 1U << depth_; }
  bool is_node(std::uint32_t node) const { return node > 0 && (node >> depth_) < 2; }
  bool is_leaf(std::uint32_t node) const { return (node >> depth_) != 0; }

  /// The segments of all leaves below a node, or of a leaf, as places in their order.
  std::uint32_t begin(std::uint32_t node) const { return border(node, 0); }
  std::uint32_t end(std::uint32_t node) const { return border(node, 1); }

 private:
  /// Level of a node, or of the highest bit of a number that is not zero.
  static std::uint32_t level_of(std::uint32_t node) {
    return 31U - static_cast<std::uint32_t>(__builtin_clz(node));
  }
  std::uint32_t border(std::uint32_t node, std::uint32_t after) const {
    const std::uint32_t level = level_of(node);
    const std::uint64_t place = node - (1U << level) + after;
    return static_cast<std::uint32_t>((place * segments_) >> level);
  }

  std::uint32_t segments_;
  std::uint32_t depth_;
};

}  // namespace flexcomp
