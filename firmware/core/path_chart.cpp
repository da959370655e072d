#include "path_chart.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// The part of a record that all path tables have in common: up to the torques of the weights.
constexpr RecordLayout kPath = record_layout(Chart::path, true, false);

/// `Size` floats of a record in the caller's precision.
template <typename Scalar, int Size>
[[gnu::always_inline]] inline Eigen::Matrix<Scalar, Size, 1> read(const float* floats) {
  return Eigen::Map<const Eigen::Matrix<float, Size, 1>>(floats).template cast<Scalar>();
}

template <typename Scalar, int Size>
[[gnu::always_inline]] inline Eigen::Matrix<Scalar, Size, 1> blend(const float* from,
                                                                   const float* to, Scalar t) {
  const Eigen::Matrix<Scalar, Size, 1> a = read<Scalar, Size>(from);
  return a + t * (read<Scalar, Size>(to) - a);
}

/// What `q` finds on a segment: how far on, and how far (rad) off its chord.
template <typename Scalar>
struct SegmentFind {
  std::uint32_t segment;
  Scalar t;
  Scalar off;
};

/// A segment and where joint angles lie from its two nodes (rad).
template <typename Scalar, int Joints>
class Segment {
  using Angles = JointVector<Scalar, Joints>;

 public:
  Segment(const float* from, const float* to, const Angles& q)
      : from_(from),
        to_(to),
        past_from_(q - read<Scalar, Joints>(from + kPath.angles)),
        past_to_(q - read<Scalar, Joints>(to + kPath.angles)) {}

  bool is_before() const { return along(past_from_, from_ + kPath.switching) < Scalar(0); }
  bool is_behind() const { return along(past_to_, to_ + kPath.switching) > Scalar(0); }

  SegmentPlace<Scalar> place() const {
    return {along(past_from_, from_ + kPath.normal_out), -along(past_to_, to_ + kPath.normal_in)};
  }

  /// Largest distance of a joint from the chord; where huge numbers leave none, infinitely far.
  Scalar off_chord(Scalar t) const {
    Scalar largest = 0;
    Scalar sum = 0;  // not a number if one of them is not
    for (Eigen::Index i = 0; i < Joints; ++i) {
      const Scalar off = std::abs(past_from_[i] - t * (past_from_[i] - past_to_[i]));
      largest = off > largest ? off : largest;
      sum += off;
    }
    return std::isnan(sum) ? std::numeric_limits<Scalar>::infinity() : largest;
  }

 private:
  static Scalar along(const Angles& past, const float* normal) {
    return past.dot(read<Scalar, Joints>(normal));
  }

  const float* from_;
  const float* to_;
  Angles past_from_;
  Angles past_to_;
};

template <typename Scalar, int Joints>
Segment<Scalar, Joints> segment_of(const Table& table, std::uint32_t segment,
                                   const JointVector<Scalar, Joints>& q) {
  return {table.record(segment), table.record(segment + 1), q};
}

template <typename Scalar, int Joints>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_on(const Segment<Scalar, Joints>& segment,
                                                          std::uint32_t number) {
  const Scalar t = segment.place().blend();
  return {number, t, segment.off_chord(t)};
}

/// Moves from the cursor's segment to the one that `q` lies in, by at most two segments in one
/// direction.
template <typename Scalar, int Joints>
[[gnu::always_inline]] inline SegmentFind<Scalar> follow(const Table& table,
                                                         const JointVector<Scalar, Joints>& q,
                                                         std::uint32_t number) {
  constexpr int kMaxMoves = 2;
  const std::uint32_t last = table.header().node_count - 2;
  const bool closed = table.header().closed != 0;
  number = number > last ? last : number;
  Segment<Scalar, Joints> segment = segment_of<Scalar, Joints>(table, number, q);
  int direction = 0;
  for (int move = 0; move < kMaxMoves; ++move) {
    if (direction >= 0 && (number < last || closed) && segment.is_behind()) {
      number = number < last ? number + 1 : 0;
      direction = 1;
    } else if (direction <= 0 && (number > 0 || closed) && segment.is_before()) {
      number = number > 0 ? number - 1 : last;
      direction = -1;
    } else {
      break;
    }
    segment = segment_of<Scalar, Joints>(table, number, q);
  }
  return find_on(segment, number);
}

template <typename Scalar>
Scalar width_of(const Table& table, const SegmentFind<Scalar>& find) {
  return static_cast<Scalar>(table.record(find.segment)[kPath.width]);
}

/// Four segments further on than the last call's, for one that `q` lies nearer to.
template <typename Scalar, int Joints>
[[gnu::noinline]] SegmentFind<Scalar> search(const Table& table,
                                             const JointVector<Scalar, Joints>& q,
                                             SegmentFind<Scalar> find, TableCursor* cursor) {
  constexpr std::uint32_t kSearchedACall = 4;
  const std::uint32_t segments = table.header().node_count - 1;
  const std::uint32_t first = find.segment;
  for (std::uint32_t i = 0; i < kSearchedACall; ++i) {
    cursor->searched = cursor->searched < segments ? cursor->searched + 1 : 1;
    const std::uint32_t ahead = cursor->searched;
    const std::uint32_t next = ahead < segments - first ? first + ahead : first + ahead - segments;
    const SegmentFind<Scalar> other = find_on(segment_of<Scalar, Joints>(table, next, q), next);
    find = other.off < find.off ? other : find;
  }
  return find;
}

/// Moves the cursor. `outside` is as in TableEntry.
template <typename Scalar, int Joints>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_segment(const Table& table,
                                                               const JointVector<Scalar, Joints>& q,
                                                               TableCursor* cursor,
                                                               Scalar* outside) {
  SegmentFind<Scalar> find = follow<Scalar, Joints>(table, q, cursor->segment);
  if (find.off > width_of(table, find)) {
    find = search<Scalar, Joints>(table, q, find, cursor);
  } else {
    cursor->searched = 0;
  }
  cursor->segment = find.segment;
  const Scalar beyond = find.off - width_of(table, find);
  *outside = beyond > Scalar(0) ? beyond : Scalar(0);
  return find;
}

/// Adds what the springs of base, links and tool do.
template <typename Scalar, int Joints>
[[gnu::noinline]] void add_structure(const float* from, const float* to, const RecordLayout& layout,
                                     Scalar t, const Wrench<Scalar>& wrench,
                                     TableResponse<Scalar, Joints>* response) {
  const auto at = [&](std::uint32_t place) {
    const auto a = static_cast<Scalar>(from[place]);
    return a + t * (static_cast<Scalar>(to[place]) - a);
  };
  std::uint32_t place = layout.structure;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column <= row; ++column) {
      const Scalar compliance = at(place++);
      response->deflection[row] += compliance * wrench[column];
      if (column != row) {
        response->deflection[column] += compliance * wrench[row];
      }
    }
  }
  for (int column = 0; column < 6; ++column) {
    const std::uint32_t begin =
        layout.structure_motion + static_cast<std::uint32_t>(Joints * column);
    response->correction -= wrench[column] * blend<Scalar, Joints>(from + begin, to + begin, t);
  }
  if (layout.has_weight) {
    const std::uint32_t sag = layout.structure_weight;
    const std::uint32_t motion = layout.structure_weight_motion;
    response->deflection += blend<Scalar, 6>(from + sag, to + sag, t);
    response->correction -= blend<Scalar, Joints>(from + motion, to + motion, t);
  }
}

}  // namespace

template <typename Scalar, int Joints>
SegmentPlace<Scalar> place_on_segment(const float* from, const float* to,
                                      const JointVector<Scalar, Joints>& q) {
  return Segment<Scalar, Joints>(from, to, q).place();
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> blend_segment(const float* from, const float* to,
                                         const RecordLayout& layout, Scalar t,
                                         const JointVector<Scalar, Joints>& q) {
  std::array<Scalar, kMaxRecordSize> record;
  for (std::uint32_t i = layout.blended; i < layout.size; ++i) {
    const auto a = static_cast<Scalar>(from[i]);
    record[i] = a + t * (static_cast<Scalar>(to[i]) - a);
  }
  TableEntry<Scalar, Joints> entry = unpack<Scalar, Joints>(record.data(), layout);
  entry.outside = Segment<Scalar, Joints>(from, to, q).off_chord(t);
  return entry;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_path(const Table& table, const JointVector<Scalar, Joints>& q,
                                        TableCursor* cursor) {
  Scalar outside = 0;
  const SegmentFind<Scalar> find = find_segment<Scalar, Joints>(table, q, cursor, &outside);
  TableEntry<Scalar, Joints> entry = blend_segment<Scalar, Joints>(
      table.record(find.segment), table.record(find.segment + 1), record_layout(table), find.t, q);
  entry.outside = outside;
  return entry;
}

template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> respond_on_path(const Table& table,
                                              const JointVector<Scalar, Joints>& q,
                                              const Wrench<Scalar>& wrench, TableCursor* cursor,
                                              Scalar* outside) {
  const SegmentFind<Scalar> find = find_segment<Scalar, Joints>(table, q, cursor, outside);
  const float* from = table.record(find.segment);
  const float* to = from + table.header().record_size;
  const float* spring = table.header().compliance;
  const float* cubic = table.header().cubic_compliance;
  const bool has_weight = table.has_weight();
  // Here and below: locals stay in registers.
  // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const Wrench<Scalar> load = wrench;
  Twist<Scalar> deflection = Twist<Scalar>::Zero();
  TableResponse<Scalar, Joints> response;
#pragma GCC unroll 6
  for (std::uint32_t joint = 0; joint < Joints; ++joint) {
    const std::uint32_t place = kPath.jacobian + 6 * joint;
    const Twist<Scalar> column = blend<Scalar, 6>(from + place, to + place, find.t);
    Scalar torque = column.dot(load);
    if (has_weight) {
      const auto a = static_cast<Scalar>(from[kPath.weight_torque + joint]);
      torque += a + find.t * (static_cast<Scalar>(to[kPath.weight_torque + joint]) - a);
    }
    const Scalar windup =
        (static_cast<Scalar>(spring[joint]) + static_cast<Scalar>(cubic[joint]) * torque * torque) *
        torque;
    deflection += windup * column;
    response.correction[static_cast<Eigen::Index>(joint)] = -windup;
  }
  response.deflection = deflection;
  if (table.has_structure()) {
    add_structure<Scalar, Joints>(from, to, record_layout(table), find.t, wrench, &response);
  }
  return response;
}

template <typename Scalar, int Joints>
void locate(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  if (table.chart() != Chart::path) {
    return;
  }
  SegmentFind<Scalar> nearest = find_on(segment_of<Scalar, Joints>(table, 0, q), 0);
  for (std::uint32_t segment = 1; segment + 1 < table.header().node_count; ++segment) {
    const SegmentFind<Scalar> other =
        find_on(segment_of<Scalar, Joints>(table, segment, q), segment);
    nearest = other.off < nearest.off ? other : nearest;
  }
  *cursor = TableCursor{nearest.segment, 0};
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot stand in them
#define FLEXCOMP_PATH_CHART(Scalar, Joints)                                                  \
  template SegmentPlace<Scalar> place_on_segment(const float*, const float*,                 \
                                                 const JointVector<Scalar, Joints>&);        \
  template TableEntry<Scalar, Joints> blend_segment(const float*, const float*,              \
                                                    const RecordLayout&, Scalar,             \
                                                    const JointVector<Scalar, Joints>&);     \
  template TableEntry<Scalar, Joints> look_up_path(                                          \
      const Table&, const JointVector<Scalar, Joints>&, TableCursor*);                       \
  template TableResponse<Scalar, Joints> respond_on_path(                                    \
      const Table&, const JointVector<Scalar, Joints>&, const Wrench<Scalar>&, TableCursor*, \
      Scalar*);                                                                              \
  template void locate(const Table&, const JointVector<Scalar, Joints>&, TableCursor*);
// NOLINTEND(bugprone-macro-parentheses)
FLEXCOMP_INSTANTIATE(FLEXCOMP_PATH_CHART)

}  // namespace flexcomp
