#include "path_chart.hpp"

#include <array>
#include <cmath>

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

template <typename Scalar, int Joints>
Scalar off_chord(const float* from, const float* to, Scalar t,
                 const JointVector<Scalar, Joints>& q) {
  Scalar largest = 0;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    const auto a = static_cast<Scalar>(from[i]);
    const auto b = static_cast<Scalar>(to[i]);
    const Scalar off = std::abs(q[i] - (a + t * (b - a)));
    largest = off > largest ? off : largest;
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
  segment = segment > last ? last : segment;
  int direction = 0;
  for (int move = 0; move < kMaxMoves; ++move) {
    const SegmentPlace<Scalar> place = place_on_segment<Scalar, Joints>(
        table.record(segment), table.record(segment + 1), layout, q);
    if (place.left < Scalar(0) && direction >= 0 && (segment < last || closed)) {
      segment = segment < last ? segment + 1 : 0;
      direction = 1;
    } else if (place.gone < Scalar(0) && direction <= 0 && (segment > 0 || closed)) {
      segment = segment > 0 ? segment - 1 : last;
      direction = -1;
    } else {
      break;
    }
  }
  return segment;
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
  const RecordLayout layout = record_layout(table);
  cursor->segment = follow<Scalar, Joints>(table, layout, q, cursor->segment);
  const float* from = table.record(cursor->segment);
  const float* to = table.record(cursor->segment + 1);
  const Scalar t = place_on_segment<Scalar, Joints>(from, to, layout, q).blend();
  TableEntry<Scalar, Joints> entry =
      blend_segment<Scalar, Joints>(from, to, layout, t, q);
  const Scalar off = entry.outside - static_cast<Scalar>(table.header().path_width);
  entry.outside = off > Scalar(0) ? off : Scalar(0);
  return entry;
}

template <typename Scalar, int Joints>
void locate(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  if (table.chart() != Chart::path) {
    return;
  }
  const RecordLayout layout = record_layout(table);
  Scalar nearest = 0;
  for (std::uint32_t segment = 0; segment + 1 < table.header().node_count; ++segment) {
    const float* from = table.record(segment);
    const float* to = table.record(segment + 1);
    const Scalar t = place_on_segment<Scalar, Joints>(from, to, layout, q).blend();
    const Scalar off = off_chord<Scalar, Joints>(from + layout.angles, to + layout.angles, t, q);
    if (segment == 0 || off < nearest) {
      nearest = off;
      cursor->segment = segment;
    }
  }
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
