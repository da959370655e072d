#include "path_chart.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "instantiate.hpp"
#include "packed_columns.hpp"

namespace flexcomp {
namespace {

/// The part of a record that all path tables have in common: up to the torques of the weights.
constexpr RecordLayout kPath = record_layout(Chart::path, true, false);

template <typename Scalar>
[[gnu::always_inline]] inline PackedSix<Scalar> blend(const float* from, const float* to,
                                                      Scalar t) {
  const PackedSix<Scalar> a = PackedSix<Scalar>::read(from);
  return a + t * (PackedSix<Scalar>::read(to) - a);
}

/// Place of `q` on a segment: how far on, and how far (rad) off its chord.
template <typename Scalar>
struct SegmentFind {
  std::uint32_t segment;
  Scalar t;
  Scalar off;  ///< zero where the look-up knows that it is within the segment's width
};

/// A segment and where joint angles lie from its two nodes (rad).
template <typename Scalar>
class Segment {
 public:
  Segment(const float* from, const float* to, const PackedSix<Scalar>& q)
      : from_(from),
        to_(to),
        past_from_(q - PackedSix<Scalar>::read(from + kPath.angles)),
        past_to_(q - PackedSix<Scalar>::read(to + kPath.angles)) {}

  bool is_before() const { return along(past_from_, from_ + kPath.switching) < Scalar(0); }
  bool is_behind() const { return along(past_to_, to_ + kPath.switching) > Scalar(0); }

  SegmentPlace<Scalar> place() const {
    return {along(past_from_, from_ + kPath.normal_out), -along(past_to_, to_ + kPath.normal_in)};
  }

  Scalar blend() const { return place().blend(); }

  bool is_within(Scalar width, Scalar t) const { return off_chord(t) <= width; }
  /// Largest distance of a joint from the chord; where huge numbers leave none, infinitely far.
  Scalar off_chord(Scalar t) const {
    return (past_from_ - t * (past_from_ - past_to_)).largest_magnitude();
  }

 private:
  static Scalar along(const PackedSix<Scalar>& past, const float* normal) {
    return past.dot(PackedSix<Scalar>::read(normal));
  }

  const float* from_;
  const float* to_;
  PackedSix<Scalar> past_from_;
  PackedSix<Scalar> past_to_;
};

#ifdef FLEXCOMP_VECTOR_REGISTERS

/// The same, with all its planes at once and without a branch.
template <>
class Segment<float> {
  using Six = PackedSix<float>;

 public:
  Segment(const float* from, const float* to, const Six& q)
      : past_from_(q - Six::read(from + kPath.angles)),
        past_to_(q - Six::read(to + kPath.angles)),
        along_(Six::dots(
            past_from_, {Six::read(from + kPath.switching), Six::read(from + kPath.normal_out)},
            past_to_, {Six::read(to + kPath.switching), Six::read(to + kPath.normal_in)})) {}

  bool is_before() const { return along_[0] < 0.0F; }
  bool is_behind() const { return along_[2] > 0.0F; }

  SegmentPlace<float> place() const { return {along_[1], -along_[3]}; }

  float blend() const {
    // As SegmentPlace::blend, also where huge numbers leave no finite distance: 0 where nothing is
    // gone, so that what divides must not be zero; what is not a number stays so.
    constexpr float kMost = std::numeric_limits<float>::max();
    constexpr float kLeast = std::numeric_limits<float>::min();
    const float gone = std::clamp(along_[1], 0.0F, kMost);
    const float left = std::clamp(-along_[3], 0.0F, kMost);
    return gone / std::max(gone + left, kLeast);
  }

  bool is_within(float width, float t) const { return off(t).is_within(width); }
  float off_chord(float t) const { return off(t).largest_magnitude(); }

 private:
  Six off(float t) const { return past_from_ - t * (past_from_ - past_to_); }

  Six past_from_;
  Six past_to_;
  std::array<float, 4> along_;  ///< their distances past the planes
};

#endif

template <typename Scalar>
Segment<Scalar> segment_of(const Table& table, std::uint32_t segment, const PackedSix<Scalar>& q) {
  return {table.record(segment), table.record(segment + 1), q};
}

template <typename Scalar>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_on(const Segment<Scalar>& segment,
                                                          std::uint32_t number) {
  const Scalar t = segment.blend();
  return {number, t, segment.off_chord(t)};
}

/// Moves from the cursor's segment to the one that `q` lies in, by at most two segments in one
/// direction.
template <typename Scalar>
[[gnu::always_inline]] inline Segment<Scalar> follow(const Table& table, const PackedSix<Scalar>& q,
                                                     std::uint32_t* at) {
  constexpr int kMaxMoves = 2;
  const std::uint32_t last = table.shape().node_count - 2;
  const bool closed = table.shape().closed;
  std::uint32_t number = *at > last ? last : *at;
  Segment<Scalar> segment = segment_of(table, number, q);
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
    segment = segment_of(table, number, q);
  }
  *at = number;
  return segment;
}

template <typename Scalar>
Scalar width_of(const Table& table, std::uint32_t segment) {
  return static_cast<Scalar>(table.record(segment)[kPath.width]);
}

/// Four segments further on than the last call's, for one that `q` lies nearer to.
template <typename Scalar>
[[gnu::noinline]] SegmentFind<Scalar> search(const Table& table, const PackedSix<Scalar>& q,
                                             SegmentFind<Scalar> find, TableCursor* cursor) {
  constexpr std::uint32_t kSearchedACall = 4;
  const std::uint32_t segments = table.shape().node_count - 1;
  const std::uint32_t first = find.segment;
  for (std::uint32_t i = 0; i < kSearchedACall; ++i) {
    cursor->searched = cursor->searched < segments ? cursor->searched + 1 : 1;
    const std::uint32_t ahead = cursor->searched;
    const std::uint32_t next = ahead < segments - first ? first + ahead : first + ahead - segments;
    const SegmentFind<Scalar> other = find_on(segment_of(table, next, q), next);
    find = other.off < find.off ? other : find;
  }
  return find;
}

/// Moves the cursor. `outside` is as in TableEntry.
template <typename Scalar>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_segment(const Table& table,
                                                               const PackedSix<Scalar>& q,
                                                               TableCursor* cursor,
                                                               Scalar* outside) {
  const Segment<Scalar> segment = follow(table, q, &cursor->segment);
  const Scalar t = segment.blend();
  if (segment.is_within(width_of<Scalar>(table, cursor->segment), t)) {
    cursor->searched = 0;
    *outside = 0;
    return {cursor->segment, t, Scalar(0)};
  }
  const SegmentFind<Scalar> find =
      search(table, q, SegmentFind<Scalar>{cursor->segment, t, segment.off_chord(t)}, cursor);
  cursor->segment = find.segment;
  const Scalar beyond = find.off - width_of<Scalar>(table, find.segment);
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
  PackedSix<Scalar> correction(response->correction);
  for (Eigen::Index column = 0; column < 6; ++column) {
    const std::uint32_t begin = layout.structure_motion + 6 * static_cast<std::uint32_t>(column);
    correction = correction - wrench[column] * blend(from + begin, to + begin, t);
  }
  if (layout.has_weight) {
    const std::uint32_t sag = layout.structure_weight;
    const std::uint32_t motion = layout.structure_weight_motion;
    response->deflection += blend(from + sag, to + sag, t).numbers();
    correction = correction - blend(from + motion, to + motion, t);
  }
  response->correction = correction.numbers();
}

}  // namespace

template <typename Scalar, int Joints>
SegmentPlace<Scalar> place_on_segment(const float* from, const float* to,
                                      const JointVector<Scalar, Joints>& q) {
  return Segment<Scalar>(from, to, PackedSix<Scalar>(q)).place();
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
  entry.outside = Segment<Scalar>(from, to, PackedSix<Scalar>(q)).off_chord(t);
  return entry;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_path(const Table& table, const JointVector<Scalar, Joints>& q,
                                        TableCursor* cursor) {
  Scalar outside = 0;
  const SegmentFind<Scalar> find = find_segment(table, PackedSix<Scalar>(q), cursor, &outside);
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
  const SegmentFind<Scalar> find = find_segment(table, PackedSix<Scalar>(q), cursor, outside);
  const float* from = table.record(find.segment);
  const float* to = from + table.shape().record_size;
  using Six = PackedSix<Scalar>;
  const auto jacobian =
      PackedColumns<Scalar>::blend(from + kPath.jacobian, to + kPath.jacobian, find.t);
  Six torque = jacobian.transposed_times(Six(wrench));
  if (table.has_weight()) {
    torque = torque + blend(from + kPath.weight_torque, to + kPath.weight_torque, find.t);
  }
  const Six spring = Six::read(table.header().compliance);
  const Six cubic = Six::read(table.header().cubic_compliance);
  const Six windup = spring * torque + cubic * torque * (torque * torque);
  TableResponse<Scalar, Joints> response;
  response.deflection = jacobian.times(windup).numbers();
  response.correction = (-windup).numbers();
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
  const PackedSix<Scalar> place(q);
  SegmentFind<Scalar> nearest = {0, 0, std::numeric_limits<Scalar>::infinity()};
  for (std::uint32_t segment = 0; segment + 1 < table.shape().node_count; ++segment) {
    const SegmentFind<Scalar> other = find_on(segment_of(table, segment, place), segment);
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
