#pragma once

/// @file
/// An index over a program's segments: where on a long one joint angles lie, in a few steps.

#include "flexcomp/table.hpp"

namespace flexcomp {

/// A split of a path table's segments into two halves, in memory of the caller.
///
/// The nodes are a binary tree: those below node k are 2 k and 2 k + 1, and the root is node 1.
/// Each splits at the median along a direction in joint space, across its segments or along them:
/// so it is that neighbouring lines of a raster, much longer than they are apart, come to lie in
/// different halves (a k-d tree with oblique planes; Sproull, Refinements to nearest-neighbor
/// searching in k-dimensional trees, Algorithmica 6, 1991). `reach` and `begin` hold the segments'
/// widths and what rounding may do, so that no segment that joint angles lie on is passed over.
struct IndexNode {
  float direction[kTableJoints];  ///< magnitudes of its numbers add up to one
  float reach;                    ///< rad, along the direction: the largest of the first half
  float begin;                    ///< rad: the smallest of the second half
};

/// Bytes that the index of a table takes, about 12 a segment; 0 for a grid, which needs none.
std::size_t path_index_size(const Table& table);

/// Makes the index of an open path table in 4-byte aligned memory, which must outlive the table's
/// use, and lets `table` and copies of it use it: `locate` then takes a bounded number of steps,
/// and so does a look-up that has lost the program. A table does without an index, more slowly.
///
/// Memory that changes while it is in use makes a program be found late or not at all, but no read
/// beyond the table. Cost: on a Cortex-M7 about 1,000 instructions a segment and doubling of their
/// number (12,000 a segment for 2,000 of them), so not for the control tick.
///
/// Returns ok (at once for a grid), bad_argument, buffer_too_small, or table_corrupt where angles
/// are beyond 10⁴ rad.
Result index_path(void* memory, std::size_t capacity, Table* table);

}  // namespace flexcomp
