#pragma once

#include "table_record.hpp"

namespace flexcomp {

/// Where joint angles fall between the two nodes of a path segment.
///
/// Each node carries a plane in joint space, square to the program there. `gone` and `left` are the
/// distances (rad) past the plane of the first and before that of the second node; the blend is
/// gone / (gone + left), which runs through the nodes without a step.
template <typename Scalar>
struct SegmentPlace {
  Scalar gone;
  Scalar left;

  Scalar blend() const {
    if (gone <= Scalar(0)) {
      return Scalar(0);
    }
    return left <= Scalar(0) ? Scalar(1) : gone / (gone + left);
  }
};

template <typename Scalar, int Joints>
SegmentPlace<Scalar> place_on_segment(const float* from, const float* to,
                                      const JointVector<Scalar, Joints>& q);

/// Blend of the two records that bound a segment. `outside` is the largest difference (rad) of a
/// joint from the chord.
template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> blend_segment(const float* from, const float* to,
                                         const RecordLayout& layout, Scalar t,
                                         const JointVector<Scalar, Joints>& q);

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_path(const Table& table, const JointVector<Scalar, Joints>& q,
                                        TableCursor* cursor);

/// `respond` of `look_up_path`, without the entry between them.
template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> respond_on_path(const Table& table,
                                              const JointVector<Scalar, Joints>& q,
                                              const Wrench<Scalar>& wrench, TableCursor* cursor,
                                              Scalar* outside);

}  // namespace flexcomp
