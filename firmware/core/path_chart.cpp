#include "path_chart.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "instantiate.hpp"
#include "packed_columns.hpp"
#include "path_index_tree.hpp"

namespace flexcomp {
namespace {

/// The part of a record that all path tables have in common: up to the torques of the weights.
constexpr RecordLayout kPath = record_layout(Chart::path, true, false);

/// Place of `q` on a segment: how far on, and how far (rad) outside its width.
template <typename Scalar>
struct SegmentFind {
  std::uint32_t segment;
  Scalar t;
  Scalar outside;  ///< zero or below: it is inside
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
  bool is_behind() const { return past_second() > Scalar(0); }
  /// Distances (rad) before the first and past the second of the planes between segments.
  Scalar before_first() const { return -along(past_from_, from_ + kPath.switching); }
  Scalar past_second() const { return along(past_to_, to_ + kPath.switching); }

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
  float before_first() const { return -along_[0]; }
  float past_second() const { return along_[2]; }

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
Scalar width_of(const Table& table, std::uint32_t segment) {
  return static_cast<Scalar>(table.record(segment)[kPath.width]);
}

/// `q` is outside a segment, too, where it is past a plane beyond which another segment begins: a
/// look-up leaves the segment there.
template <typename Scalar>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_on(const Table& table, std::uint32_t segment,
                                                          const PackedSix<Scalar>& q) {
  Segment<Scalar> there = segment_of(table, segment, q);
  const Scalar t = there.blend();
  Scalar outside = there.off_chord(t) - width_of<Scalar>(table, segment);
  if (outside <= Scalar(0)) {
    const bool closed = table.shape().closed;
    if (segment > 0 || closed) {
      outside = std::max(outside, there.before_first());
    }
    if (segment < table.shape().node_count - 2 || closed) {
      outside = std::max(outside, there.past_second());
    }
  }
  return {segment, t, outside};
}

/// Has a node no plane between the segments that meet there? The program turns back on itself.
inline bool turns_back(const float* record) {
  return std::all_of(record + kPath.switching, record + kPath.switching + 6,
                     [](float number) { return number == 0.0F; });
}

/// The other segment at a node where the program turns back, if `q` is less outside it: no plane
/// leads there.
template <typename Scalar>
[[gnu::noinline]] SegmentFind<Scalar> look_round_the_corner(const Table& table,
                                                            const PackedSix<Scalar>& q,
                                                            SegmentFind<Scalar> find) {
  const std::uint32_t here = find.segment;
  const std::uint32_t last = table.shape().node_count - 2;
  const bool closed = table.shape().closed;
  for (std::uint32_t end = 0; end < 2; ++end) {
    const std::uint32_t at_last = end == 0 ? 0 : last;
    if ((here != at_last || closed) && turns_back(table.record(here + end))) {
      const std::uint32_t wrapped = end == 0 ? last : 0;
      const SegmentFind<Scalar> other =
          find_on(table, here == at_last ? wrapped : here + 2 * end - 1, q);
      find = other.outside < find.outside ? other : find;
    }
  }
  return find;
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

/// Four segments further on than the last call's, for one that `q` is less outside.
template <typename Scalar>
SegmentFind<Scalar> search_in_turn(const Table& table, const PackedSix<Scalar>& q,
                                   SegmentFind<Scalar> find, TableCursor* cursor) {
  constexpr std::uint32_t kSearchedACall = 4;
  const std::uint32_t segments = table.shape().node_count - 1;
  const std::uint32_t first = find.segment;
  for (std::uint32_t i = 0; i < kSearchedACall; ++i) {
    cursor->searched = cursor->searched < segments ? cursor->searched + 1 : 1;
    const std::uint32_t ahead = cursor->searched;
    const std::uint32_t next = ahead < segments - first ? first + ahead : first + ahead - segments;
    const SegmentFind<Scalar> other = find_on(table, next, q);
    find = other.outside < find.outside ? other : find;
  }
  return find;
}

/// The way through a table's index: first through the halves that may hold a segment that `q` is
/// on, nearer ones first; where there is none, through those that may hold one much nearer. It can
/// be left and gone on with at any node, without a stack: as in Áfra and Szirmay-Kalos, Stackless
/// multi-BVH traversal for CPU, MIC and GPU ray tracing, Computer Graphics Forum 33, 2014.
template <typename Scalar>
class IndexSearch {
 public:
  IndexSearch(const Table& table, const PackedSix<Scalar>& q, const TableCursor& cursor)
      : table_(table),
        q_(q),
        tree_(table.shape().node_count - 1),
        splits_(table.index()),
        order_(reinterpret_cast<const std::uint32_t*>(table.index() + tree_.nodes())) {
    if (tree_.is_node(cursor.searched)) {
      node_ = cursor.searched;
      pending_ = cursor.pending;
      off_program_ = cursor.off_program;
    }
  }

  /// Something that `q` is less outside than `find`, or on. `work` is what it may cost, about, in
  /// splits; a segment costs three.
  [[gnu::noinline]] SegmentFind<Scalar> improve(SegmentFind<Scalar> find, std::uint32_t work,
                                                TableCursor* cursor) {
    done_ = 0;
    while (done_ < work && node_ > 0 && find.outside > Scalar(0)) {
      if (tree_.is_leaf(node_)) {
        find = look_at_leaf(find);
        climb();
      } else {
        descend(off_program_ ? find.outside / Scalar(2) : Scalar(0));
      }
      if (node_ == 0 && !off_program_) {
        node_ = 1;
        off_program_ = true;
      }
    }
    const bool goes_on = find.outside > Scalar(0);
    cursor->searched = goes_on ? node_ : 0;
    cursor->pending = pending_;
    cursor->off_program = off_program_;
    return find;
  }

 private:
  /// To the nearer half, if it begins within `limit`; the other is remembered, if it does too.
  void descend(Scalar limit) {
    const IndexNode& split = splits_[node_];
    const Scalar place = q_.dot(PackedSix<Scalar>::read(split.direction));
    const Scalar off_first = place - static_cast<Scalar>(split.reach);
    const Scalar off_second = static_cast<Scalar>(split.begin) - place;
    const bool second = off_second < off_first;
    ++done_;
    if ((second ? off_second : off_first) <= limit) {
      node_ = 2 * node_ + (second ? 1 : 0);
      pending_ = 2 * pending_ + ((second ? off_first : off_second) <= limit ? 1 : 0);
    } else {
      climb();
    }
  }

  /// To the other half of the last split where it was remembered; to 0 where there is none.
  void climb() {
    if (pending_ == 0) {
      node_ = 0;
      return;
    }
    const int up = __builtin_ctz(pending_);
    node_ = (node_ >> up) ^ 1U;
    pending_ = (pending_ >> up) - 1;
  }

  SegmentFind<Scalar> look_at_leaf(SegmentFind<Scalar> find) {
    constexpr std::uint32_t kOfASegment = 3;
    const std::uint32_t end = tree_.end(node_);
    for (std::uint32_t at = tree_.begin(node_); at < end; ++at) {
      // Not from where there is no segment, whatever has become of the index's memory.
      const std::uint32_t segment = order_[at] < tree_.segments() ? order_[at] : 0;
      const SegmentFind<Scalar> other = find_on(table_, segment, q_);
      find = other.outside < find.outside ? other : find;
      done_ += kOfASegment;
    }
    return find;
  }

  const Table& table_;
  PackedSix<Scalar> q_;
  PathIndexTree tree_;
  const IndexNode* splits_;
  const std::uint32_t* order_;
  std::uint32_t node_ = 1;
  std::uint32_t pending_ = 0;
  bool off_program_ = false;
  std::uint32_t done_ = 0;
};

/// A bounded look for a segment that `q` is less outside.
template <typename Scalar>
[[gnu::noinline]] SegmentFind<Scalar> search(const Table& table, const PackedSix<Scalar>& q,
                                             SegmentFind<Scalar> find, TableCursor* cursor) {
  // A raster of a million points is found again in five calls.
  constexpr std::uint32_t kWorkACall = 30;
  // A first look at one number of the planes: few nodes have none.
  const auto may_turn_back = [&table](std::uint32_t node) {
    return table.record(node)[kPath.switching] == 0.0F;
  };
  if (may_turn_back(find.segment) || may_turn_back(find.segment + 1)) {
    find = look_round_the_corner(table, q, find);
    if (find.outside <= Scalar(0)) {
      cursor->searched = 0;
      return find;
    }
  }
  return table.index() == nullptr
             ? search_in_turn(table, q, find, cursor)
             : IndexSearch<Scalar>(table, q, *cursor).improve(find, kWorkACall, cursor);
}

/// Moves the cursor. `outside` is as in TableEntry.
template <typename Scalar>
[[gnu::always_inline]] inline SegmentFind<Scalar> find_segment(const Table& table,
                                                               const PackedSix<Scalar>& q,
                                                               TableCursor* cursor,
                                                               Scalar* outside) {
  Segment<Scalar> segment = follow(table, q, &cursor->segment);
  const Scalar t = segment.blend();
  const Scalar width = width_of<Scalar>(table, cursor->segment);
  if (segment.is_within(width, t)) {
    cursor->searched = 0;
    *outside = 0;
    return {cursor->segment, t, Scalar(0)};
  }
  const SegmentFind<Scalar> find = search(
      table, q, SegmentFind<Scalar>{cursor->segment, t, segment.off_chord(t) - width}, cursor);
  cursor->segment = find.segment;
  *outside = find.outside > Scalar(0) ? find.outside : Scalar(0);
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
  using Six = PackedSix<Scalar>;
  Six correction(response->correction);
  for (Eigen::Index column = 0; column < 6; ++column) {
    const std::uint32_t begin = layout.structure_motion + 6 * static_cast<std::uint32_t>(column);
    correction = correction - wrench[column] * Six::blend(from + begin, to + begin, t);
  }
  if (layout.has_weight) {
    const std::uint32_t sag = layout.structure_weight;
    const std::uint32_t motion = layout.structure_weight_motion;
    response->deflection += Six::blend(from + sag, to + sag, t).numbers();
    correction = correction - Six::blend(from + motion, to + motion, t);
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
  SegmentFind<Scalar> find = find_segment(table, PackedSix<Scalar>(q), cursor, outside);
  const float* from = table.record(find.segment);
  const float* to = from + table.shape().record_size;
  using Six = PackedSix<Scalar>;
  using L = Lanes<Scalar>;
  const float* spring = table.header().compliance;
  const float* cubic = table.header().cubic_compliance;
  const bool has_weight = table.has_weight();
  const auto windup_of = [&](std::size_t lane, typename L::Lane torque) {
    if (has_weight) {
      const auto weight = L::load(from + kPath.weight_torque, lane);
      torque = torque + (weight + find.t * (L::load(to + kPath.weight_torque, lane) - weight));
    }
    return L::load(spring, lane) * torque + L::load(cubic, lane) * torque * (torque * torque);
  };
  Six windup;
  Six deflection = PackedColumns<Scalar>::blend(from + kPath.jacobian, to + kPath.jacobian, find.t)
                       .product_of(Six(wrench), windup_of, &windup);
  TableResponse<Scalar, Joints> response;
  deflection.store(&response.deflection);
  (-windup).store(&response.correction);
  if (table.has_structure()) {
    add_structure<Scalar, Joints>(from, to, record_layout(table), find.t, wrench, &response);
  }
  return response;
}

template <typename Scalar, int Joints>
Scalar track(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  Scalar outside = 0;
  if (table.chart() == Chart::path) {
    find_segment(table, PackedSix<Scalar>(q), cursor, &outside);
  }
  return outside;
}

template <typename Scalar, int Joints>
void locate(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  if (table.chart() != Chart::path) {
    return;
  }
  constexpr std::uint32_t kWork = 360;  // of 48 instructions each on the Cortex-M7
  const PackedSix<Scalar> place(q);
  SegmentFind<Scalar> nearest = {0, 0, std::numeric_limits<Scalar>::infinity()};
  TableCursor found;
  if (table.index() != nullptr) {
    nearest = IndexSearch<Scalar>(table, place, found).improve(nearest, kWork, &found);
  } else {
    for (std::uint32_t segment = 0; segment + 1 < table.shape().node_count; ++segment) {
      const SegmentFind<Scalar> other = find_on(table, segment, place);
      nearest = other.outside < nearest.outside ? other : nearest;
    }
  }
  found.segment = nearest.segment;
  *cursor = found;
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
  template Scalar track(const Table&, const JointVector<Scalar, Joints>&, TableCursor*);     \
  template void locate(const Table&, const JointVector<Scalar, Joints>&, TableCursor*);
// NOLINTEND(bugprone-macro-parentheses)
FLEXCOMP_INSTANTIATE(FLEXCOMP_PATH_CHART)

}  // namespace flexcomp
