#pragma once

#include "flexcomp/types.hpp"

namespace flexcomp {

/// A program as the polyline through its points in joint space, without repeated points. A place on
/// it is a piece and the fraction of that piece.
template <typename Scalar, int Joints>
class ProgramPath {
 public:
  using Angles = JointVector<Scalar, Joints>;

  struct Place {
    std::size_t piece = 0;  ///< index of the point the piece begins with
    Scalar fraction = 0;    ///< 0 to 1
  };

  ProgramPath(const Angles* points, std::size_t count) : points_(points), count_(count) {}

  /// Are there two distinct points, and are all finite?
  bool is_valid() const;

  /// Does it end where it began?
  bool is_closed() const;

  Angles angles(const Place& place) const;

  /// Unit directions of the program at a place.
  struct Directions {
    Angles before;  ///< just before it; at a mild bend the mean
    Angles after;   ///< just after it; at a mild bend the mean
    Angles mean;    ///< zero where the program turns back on itself
  };
  Directions directions(const Place& place) const;

  Place begin() const;
  bool is_end(const Place& place) const;

  /// Moves on by `length` (1-norm, rad), but not past a sharp corner or the end.
  Place advanced(Place from, Scalar length) const;

  /// End of the piece that lies behind a place.
  Place end_of_piece(const Place& place) const {
    return {place.fraction < Scalar(1) ? place.piece : next_piece(place.piece), Scalar(1)};
  }

  /// How far the program behind a corner runs back along the way that it came.
  Place retraced(const Place& corner) const;

  /// Motion from `from` to `to` within the same piece, or to the end of it if `to` is further on;
  /// `reached` is where it ends.
  Angles straight_move(const Place& from, const Place& to, Place* reached) const;

 private:
  Angles piece_motion(std::size_t piece) const { return points_[piece + 1] - points_[piece]; }
  bool is_piece(std::size_t piece) const {
    return piece + 1 < count_ && points_[piece + 1] != points_[piece];
  }
  std::size_t next_piece(std::size_t piece) const;
  std::size_t previous_piece(std::size_t piece) const;

  const Angles* points_;
  std::size_t count_;
};

}  // namespace flexcomp
