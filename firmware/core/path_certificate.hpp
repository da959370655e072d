#pragma once

#include "table_certificate.hpp"

namespace flexcomp {

/// Result of the check of a path segment.
template <typename Scalar>
struct SegmentCheck {
  bool holds = true;
  TableError<Scalar> error;
  Scalar width = 0;  ///< rad, how far what was checked strays from the chord
};

/// May a builder have written the width in a record? A program strays from the chord to the next
/// node (none behind the last) by half of the chord at most; the builder sets nodes accordingly,
/// and allows for 1 µrad of rounding.
bool is_plausible_width(const float* from, const float* to, const RecordLayout& layout);

/// Bounds a path table's error on moves between two of its nodes, from their records and the model
/// alone: the builder's certificate, and what anyone can derive again from a table.
template <typename Scalar, int Joints>
class PathCertificate {
 public:
  using Angles = JointVector<Scalar, Joints>;

  /// `share`: of the tolerance that may go to what happens between the points looked at.
  PathCertificate(const RobotModel<Scalar, Joints>& model, const WrenchBound<Scalar>& bound,
                  const TableError<Scalar>& tolerance, const RecordLayout& layout, Scalar share)
      : model_(model),
        bound_(bound),
        tolerance_(tolerance),
        bounds_(model_bounds(model, bound)),
        layout_(layout),
        share_(share) {}

  /// The error that float arithmetic in a lookup can add; no certificate can be below it.
  const TableError<Scalar>& rounding() const { return bounds_.rounding; }

  /// Checks a straight move in joint space that lies between the planes of the two nodes.
  void check_move(const float* from, const float* to, const Angles& start, const Angles& motion,
                  SegmentCheck<Scalar>* check) const;

  /// Does a straight move in joint space lie on the segment's side of the planes that tell it from
  /// its neighbours?
  bool is_between_neighbours(const float* from, const float* to, const Angles& start,
                             const Angles& motion) const;

  /// Where joint angles lie, as a lookup sees them whose cursor is on the segment: it goes to the
  /// segment before or behind, or stays, or looks elsewhere.
  enum class Side { before, on, behind, off };
  Side side(const float* from, const float* to, const Angles& q) const;

  /// Part of a straight move beside the segment, 1 at most, over which `error_beside` is worth
  /// asking for: a quarter of the chord, or less where curvature would take more than its share.
  Scalar part_beside(const float* from, const float* to, const Angles& motion) const;

  /// Bound on the error of a lookup that stays on the segment during a short straight move beside
  /// it.
  TableError<Scalar> error_beside(const float* from, const float* to, const Angles& start,
                                  const Angles& motion) const;

  /// Checks the chord between two nodes: what can be looked at without the program.
  void check_chord(const float* from, const float* to, SegmentCheck<Scalar>* check) const;

  /// Bound on the error at all joint angles that a lookup on this segment takes for inside: those
  /// that in no joint are off a place of the chord by more than the record's width, read with the
  /// blend of that place. Which place it is the planes decide, and the bound is for all of them.
  TableError<Scalar> inside_error(const float* from, const float* to) const;

 private:
  /// Distances (rad) before the first and behind the second of the planes between segments.
  struct Beyond {
    Scalar before;
    Scalar behind;
  };
  Beyond beyond_planes(const float* from, const float* to, const Angles& q) const;
  TableError<Scalar> error_at(const float* from, const float* to, const Angles& q,
                              Scalar* outside) const;
  /// Longest part of a move between points looked at, for curvature's share of the tolerance.
  Scalar longest_part(const TableError<Scalar>& curvature) const;
  Scalar chord_length(const float* from, const float* to) const;
  Scalar smallest_span(const float* from, const float* to, const Angles& start,
                       const Angles& end) const;
  TableError<Scalar> curvature_beside(const float* from, const float* to,
                                      const Angles& motion) const;
  TableError<Scalar> curvature_of(const float* from, const float* to, const Angles& motion,
                                  Scalar span) const;

  const RobotModel<Scalar, Joints>& model_;
  WrenchBound<Scalar> bound_;
  TableError<Scalar> tolerance_;
  ModelBounds<Scalar, Joints> bounds_;
  RecordLayout layout_;
  Scalar share_;
};

}  // namespace flexcomp
