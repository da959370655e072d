#include "program_path.hpp"

#include <algorithm>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// Cosine of the bend beyond which a corner gets a node of its own (30°).
constexpr double kSharpCosine = 0.866;

/// Sum of the unit directions before and after a corner below which it is a turn by 180°.
constexpr double kTurnedBack = 1e-3;

/// Programs whose ends lie this close (rad) are closed: below the resolution of `float` angles.
constexpr double kClosedGap = 1e-6;

/// A piece retraces another where their ends lie this close (rad), each beside the other.
constexpr double kSameWay = 1e-7;

}  // namespace

template <typename Scalar, int Joints>
bool ProgramPath<Scalar, Joints>::is_valid() const {
  if (points_ == nullptr || count_ < 2) {
    return false;
  }
  bool moves = false;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!points_[i].allFinite()) {
      return false;
    }
    moves = moves || is_piece(i);
  }
  return moves;
}

template <typename Scalar, int Joints>
bool ProgramPath<Scalar, Joints>::is_closed() const {
  return (points_[count_ - 1] - points_[0]).cwiseAbs().maxCoeff() <= Scalar(kClosedGap);
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::angles(const Place& place) const -> Angles {
  return points_[place.piece] + place.fraction * piece_motion(place.piece);
}

template <typename Scalar, int Joints>
std::size_t ProgramPath<Scalar, Joints>::next_piece(std::size_t piece) const {
  for (std::size_t next = piece + 1; next + 1 < count_; ++next) {
    if (is_piece(next)) {
      return next;
    }
  }
  return count_;
}

template <typename Scalar, int Joints>
std::size_t ProgramPath<Scalar, Joints>::previous_piece(std::size_t piece) const {
  for (std::size_t previous = piece; previous-- > 0;) {
    if (is_piece(previous)) {
      return previous;
    }
  }
  return count_;
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::directions(const Place& place) const -> Directions {
  std::size_t in = place.piece;
  std::size_t out = place.piece;
  if (place.fraction <= Scalar(0)) {
    in = previous_piece(place.piece);
  } else if (place.fraction >= Scalar(1)) {
    out = next_piece(place.piece);
  }
  if (in == count_) {
    in = is_closed() ? previous_piece(count_ - 1) : out;
  }
  if (out == count_) {
    out = is_closed() ? (is_piece(0) ? 0 : next_piece(0)) : in;
  }
  Directions at;
  at.before = piece_motion(in).normalized();
  at.after = piece_motion(out).normalized();
  const Angles sum = at.before + at.after;
  const Scalar length = sum.norm();
  at.mean = length > Scalar(kTurnedBack) ? Angles(sum / length) : Angles(Angles::Zero());
  if (at.before.dot(at.after) >= Scalar(kSharpCosine)) {
    at.before = at.mean;
    at.after = at.mean;
  }
  return at;
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::begin() const -> Place {
  return {is_piece(0) ? 0 : next_piece(0), Scalar(0)};
}

template <typename Scalar, int Joints>
bool ProgramPath<Scalar, Joints>::is_end(const Place& place) const {
  return place.fraction >= Scalar(1) && next_piece(place.piece) == count_;
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::advanced(Place from, Scalar length) const -> Place {
  Place place = from;
  for (;;) {
    if (place.fraction >= Scalar(1)) {
      const std::size_t next = next_piece(place.piece);
      if (next == count_) {
        return place;
      }
      const bool sharp =
          piece_motion(place.piece).normalized().dot(piece_motion(next).normalized()) <
          Scalar(kSharpCosine);
      const bool moved = place.piece != from.piece || place.fraction != from.fraction;
      if (sharp && moved) {
        return place;
      }
      place = {next, Scalar(0)};
    }
    const Scalar whole = piece_motion(place.piece).cwiseAbs().sum();
    const Scalar rest = whole * (Scalar(1) - place.fraction);
    if (length < rest) {
      place.fraction += length / whole;
      return place;
    }
    length -= rest;
    place.fraction = Scalar(1);
  }
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::retraced(const Place& corner) const -> Place {
  Place there = corner;   // on the way on
  Place mirror = corner;  // on the way back
  for (;;) {
    if (there.fraction >= Scalar(1)) {
      there = {next_piece(there.piece), Scalar(0)};
    }
    if (mirror.fraction <= Scalar(0)) {
      mirror = {previous_piece(mirror.piece), Scalar(1)};
    }
    if (there.piece >= count_ || mirror.piece >= count_) {
      return there.piece >= count_ ? Place{count_ - 2, Scalar(1)} : there;
    }
    const Scalar whole_on = piece_motion(there.piece).norm();
    const Scalar whole_back = piece_motion(mirror.piece).norm();
    const Scalar on = (Scalar(1) - there.fraction) * whole_on;
    const Scalar back = mirror.fraction * whole_back;
    const Scalar both = std::min(on, back);
    const Angles apart =
        piece_motion(there.piece) / whole_on + piece_motion(mirror.piece) / whole_back;
    if (!(apart.norm() * both <= Scalar(kSameWay))) {
      return there;
    }
    there.fraction = both < on ? there.fraction + both / whole_on : Scalar(1);
    mirror.fraction = both < back ? mirror.fraction - both / whole_back : Scalar(0);
  }
}

template <typename Scalar, int Joints>
auto ProgramPath<Scalar, Joints>::straight_move(const Place& from, const Place& to,
                                                Place* reached) const -> Angles {
  Place start = from;
  if (start.fraction >= Scalar(1) && start.piece != to.piece) {
    start = {next_piece(start.piece), Scalar(0)};
  }
  *reached = start.piece == to.piece ? to : Place{start.piece, Scalar(1)};
  return (reached->fraction - start.fraction) * piece_motion(start.piece);
}

#define FLEXCOMP_PROGRAM_PATH(Scalar, Joints) template class ProgramPath<Scalar, Joints>;
FLEXCOMP_INSTANTIATE(FLEXCOMP_PROGRAM_PATH)

}  // namespace flexcomp
