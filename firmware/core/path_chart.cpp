#include "path_chart.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

template <typename Scalar, int Joints>
Scalar past_plane(const float* angles, const float* normal, const JointVector<Scalar, Joints>& q) {
  Scalar sum = 0;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    sum += (q[i] - static_cast<Scalar>(angles[i])) * static_cast<Scalar>(normal[i]);
  }
  return sum;
}

/// Largest distance of a joint from the chord; where huge numbers leave none, infinitely far.
template <typename Scalar, int Joints>
Scalar off_chord(const float* from, const float* to, Scalar t,
                 const JointVector<Scalar, Joints>& q) {
  Scalar largest = 0;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    const auto a = static_cast<Scalar>(from[i]);
    const auto b = static_cast<Scalar>(to[i]);
    const Scalar off = std::abs(q[i] - (a + t * (b - a)));
    largest = off > largest ? off : largest;
    largest = std::isnan(off) ? std::numeric_limits<Scalar>::infinity() : largest;
  }
  return largest;
}

/// Moves from `segment` to the one that `q` lies in, by at most two segments in one direction.
template <typename Scalar, int Joints>
std::uint32_t follow(const Table& table, const RecordLayout& layout,
                     const JointVector<Scalar, Joints>& q, std::uint32_t segment) {
  constexpr int kMaxMoves = 2;
  const std::uint32_t last = table.header().node_count - 2;
  const bool closed = table.header().closed != 0;
  const auto past_node = [&](std::uint32_t node) {
    const float* record = table.record(node);
    return past_plane<Scalar, Joints>(record + layout.angles, record + layout.switching, q);
  };
  segment = segment > last ? last : segment;
  int direction = 0;
  for (int move = 0; move < kMaxMoves; ++move) {
    if (direction >= 0 && (segment < last || closed) && past_node(segment + 1) > Scalar(0)) {
      segment = segment < last ? segment + 1 : 0;
      direction = 1;
    } else if (direction <= 0 && (segment > 0 || closed) && past_node(segment) < Scalar(0)) {
      segment = segment > 0 ? segment - 1 : last;
      direction = -1;
    } else {
      break;
    }
  }
  return segment;
}

/// What `q` finds on one segment, and how far it is off its chord.
template <typename Scalar>
struct Find {
  std::uint32_t segment;
  Scalar t;
  Scalar off;
};

template <typename Scalar, int Joints>
Find<Scalar> find_on(const Table& table, const RecordLayout& layout, std::uint32_t segment,
                     const JointVector<Scalar, Joints>& q) {
  const float* from = table.record(segment);
  const float* to = table.record(segment + 1);
  const Scalar t = place_on_segment<Scalar, Joints>(from, to, layout, q).blend();
  return {segment, t, off_chord<Scalar, Joints>(from + layout.angles, to + layout.angles, t, q)};
}

}  // namespace

template <typename Scalar, int Joints>
SegmentPlace<Scalar> place_on_segment(const float* from, const float* to,
                                      const RecordLayout& layout,
                                      const JointVector<Scalar, Joints>& q) {
  return {past_plane<Scalar, Joints>(from + layout.angles, from + layout.normal_out, q),
          -past_plane<Scalar, Joints>(to + layout.angles, to + layout.normal_in, q)};
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> blend_segment(const float* from, const float* to,
                                         const RecordLayout& layout, Scalar t,
                                         const JointVector<Scalar, Joints>& q) {
  std::array<Scalar, kMaxRecordSize> blend;
  for (std::uint32_t i = layout.blended; i < layout.size; ++i) {
    const auto a = static_cast<Scalar>(from[i]);
    blend[i] = a + t * (static_cast<Scalar>(to[i]) - a);
  }
  TableEntry<Scalar, Joints> entry = unpack<Scalar, Joints>(blend.data(), layout);
  entry.outside = off_chord<Scalar, Joints>(from + layout.angles, to + layout.angles, t, q);
  return entry;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_path(const Table& table, const JointVector<Scalar, Joints>& q,
                                        TableCursor* cursor) {
  constexpr std::uint32_t kSearchedACall = 4;
  const RecordLayout layout = record_layout(table);
  const std::uint32_t segments = table.header().node_count - 1;
  const auto width = [&](const Find<Scalar>& find) {
    return static_cast<Scalar>(table.record(find.segment)[layout.width]);
  };
  Find<Scalar> find = find_on<Scalar, Joints>(
      table, layout, follow<Scalar, Joints>(table, layout, q, cursor->segment), q);
  if (find.off > width(find)) {
    const std::uint32_t first = find.segment;
    for (std::uint32_t i = 0; i < kSearchedACall; ++i) {
      cursor->searched = cursor->searched % segments + 1;
      const std::uint32_t next =
          static_cast<std::uint32_t>((std::uint64_t{first} + cursor->searched) % segments);
      const Find<Scalar> other = find_on<Scalar, Joints>(table, layout, next, q);
      find = other.off < find.off ? other : find;
    }
  } else {
    cursor->searched = 0;
  }
  cursor->segment = find.segment;
  TableEntry<Scalar, Joints> entry = blend_segment<Scalar, Joints>(
      table.record(find.segment), table.record(find.segment + 1), layout, find.t, q);
  const Scalar outside = find.off - width(find);
  entry.outside = outside > Scalar(0) ? outside : Scalar(0);
  return entry;
}

template <typename Scalar, int Joints>
void locate(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  if (table.chart() != Chart::path) {
    return;
  }
  const RecordLayout layout = record_layout(table);
  Find<Scalar> nearest = find_on<Scalar, Joints>(table, layout, 0, q);
  for (std::uint32_t segment = 1; segment + 1 < table.header().node_count; ++segment) {
    const Find<Scalar> other = find_on<Scalar, Joints>(table, layout, segment, q);
    nearest = other.off < nearest.off ? other : nearest;
  }
  *cursor = TableCursor{nearest.segment, 0};
}

#define FLEXCOMP_PATH_CHART(Scalar, Joints)                                                       \
  template SegmentPlace<Scalar> place_on_segment(const float*, const float*, const RecordLayout&, \
                                                 const JointVector<Scalar, Joints>&);             \
  template TableEntry<Scalar, Joints> blend_segment(const float*, const float*,                   \
                                                    const RecordLayout&, Scalar,                  \
                                                    const JointVector<Scalar, Joints>&);          \
  template TableEntry<Scalar, Joints> look_up_path(                                               \
      const Table&, const JointVector<Scalar, Joints>&, TableCursor*);                            \
  template void locate(const Table&, const JointVector<Scalar, Joints>&, TableCursor*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_PATH_CHART)

}  // namespace flexcomp
