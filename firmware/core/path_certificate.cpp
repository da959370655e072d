#include "path_certificate.hpp"

#include <algorithm>
#include <cmath>

#include "instantiate.hpp"
#include "path_chart.hpp"

namespace flexcomp {
namespace {

/// Most points looked at on one move; past it a table is none that a builder would make.
constexpr double kMostSteps = 1e6;

/// Least distance between the planes of a segment, in parts of its chord.
constexpr double kLeastSpan = 0.7;

/// How far (rad) beyond a plane between segments the program may lie: nodes are rounded to float.
constexpr double kPlaneSlack = 1e-6;

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> read(const float* numbers) {
  return Eigen::Map<const JointVector<float, Joints>>(numbers).template cast<Scalar>();
}

}  // namespace

bool is_plausible_width(const float* from, const float* to, const RecordLayout& layout) {
  const float width = from[layout.width];
  if (to == nullptr) {
    return width == 0.0F;
  }
  const double chord =
      (read<double, 6>(to + layout.angles) - read<double, 6>(from + layout.angles)).norm();
  return width > 0.99e-6F && static_cast<double>(width) <= 0.5 * chord + 1e-5;
}

template <typename Scalar, int Joints>
void PathCertificate<Scalar, Joints>::check_move(const float* from, const float* to,
                                                 const Angles& start, const Angles& motion,
                                                 SegmentCheck<Scalar>* check) const {
  const Scalar span = smallest_span(from, to, start, start + motion);
  if (!(span > Scalar(0))) {
    check->holds = false;
    return;
  }
  const TableError<Scalar> curvature = curvature_of(from, to, motion, span);
  const Scalar wanted = std::ceil(Scalar(1) / std::min(longest_part(curvature), Scalar(1)));
  if (!(wanted <= Scalar(kMostSteps))) {
    check->holds = false;
    return;
  }
  const auto steps = static_cast<std::uint32_t>(wanted);
  const Scalar step = Scalar(1) / static_cast<Scalar>(steps);
  const Scalar between = step * step / Scalar(8);
  for (std::uint32_t i = 0; i <= steps && check->holds; ++i) {
    const Angles q = start + (static_cast<Scalar>(i) * step) * motion;
    Scalar outside = 0;
    TableError<Scalar> error = error_at(from, to, q, &outside);
    error.position += between * curvature.position + bounds_.rounding.position;
    error.orientation += between * curvature.orientation + bounds_.rounding.orientation;
    check->error = larger(check->error, error);
    check->width = std::max(check->width, outside);
    check->holds =
        error.position <= tolerance_.position && error.orientation <= tolerance_.orientation;
  }
}

template <typename Scalar, int Joints>
TableError<Scalar> PathCertificate<Scalar, Joints>::error_at(const float* from, const float* to,
                                                             const Angles& q,
                                                             Scalar* outside) const {
  const Scalar t = place_on_segment<Scalar, Joints>(from, to, q).blend();
  const TableEntry<Scalar, Joints> entry = blend_segment<Scalar, Joints>(from, to, layout_, t, q);
  *outside = entry.outside;
  return entry_error(model_, exact_entry(model_, q), entry, bound_);
}

template <typename Scalar, int Joints>
auto PathCertificate<Scalar, Joints>::beyond_planes(const float* from, const float* to,
                                                    const Angles& q) const -> Beyond {
  const Angles opens = read<Scalar, Joints>(from + layout_.switching);
  const Angles closes = read<Scalar, Joints>(to + layout_.switching);
  return {-opens.dot(q - read<Scalar, Joints>(from + layout_.angles)),
          closes.dot(q - read<Scalar, Joints>(to + layout_.angles))};
}

template <typename Scalar, int Joints>
bool PathCertificate<Scalar, Joints>::is_between_neighbours(const float* from, const float* to,
                                                            const Angles& start,
                                                            const Angles& motion) const {
  const Beyond first = beyond_planes(from, to, start);
  const Beyond last = beyond_planes(from, to, Angles(start + motion));
  return std::max(std::max(first.before, last.before), std::max(first.behind, last.behind)) <=
         Scalar(kPlaneSlack);
}

template <typename Scalar, int Joints>
auto PathCertificate<Scalar, Joints>::side(const float* from, const float* to,
                                           const Angles& q) const -> Side {
  const Beyond beyond = beyond_planes(from, to, q);
  if (beyond.before > Scalar(0)) {
    return Side::before;
  }
  if (beyond.behind > Scalar(0)) {
    return Side::behind;
  }
  const Scalar t = place_on_segment<Scalar, Joints>(from, to, q).blend();
  const Scalar off_chord = blend_segment<Scalar, Joints>(from, to, layout_, t, q).outside;
  return off_chord <= static_cast<Scalar>(from[layout_.width]) ? Side::on : Side::off;
}

template <typename Scalar, int Joints>
TableError<Scalar> PathCertificate<Scalar, Joints>::curvature_beside(const float* from,
                                                                     const float* to,
                                                                     const Angles& motion) const {
  return curvature_of(from, to, motion, Scalar(kLeastSpan) * chord_length(from, to));
}

template <typename Scalar, int Joints>
Scalar PathCertificate<Scalar, Joints>::part_beside(const float* from, const float* to,
                                                    const Angles& motion) const {
  const Scalar quarter = chord_length(from, to) / (Scalar(4) * motion.norm());
  return std::min(std::min(Scalar(1), quarter), longest_part(curvature_beside(from, to, motion)));
}

template <typename Scalar, int Joints>
TableError<Scalar> PathCertificate<Scalar, Joints>::error_beside(const float* from, const float* to,
                                                                 const Angles& start,
                                                                 const Angles& motion) const {
  Scalar outside = 0;
  TableError<Scalar> error = larger(error_at(from, to, start, &outside),
                                    error_at(from, to, Angles(start + motion), &outside));
  const TableError<Scalar> curvature = curvature_beside(from, to, motion);
  error.position += curvature.position / Scalar(8) + bounds_.rounding.position;
  error.orientation += curvature.orientation / Scalar(8) + bounds_.rounding.orientation;
  return error;
}

template <typename Scalar, int Joints>
Scalar PathCertificate<Scalar, Joints>::longest_part(const TableError<Scalar>& curvature) const {
  const Scalar most = std::min(tolerance_.position / curvature.position,
                               tolerance_.orientation / curvature.orientation);
  return std::sqrt(Scalar(8) * share_ * most);
}

template <typename Scalar, int Joints>
void PathCertificate<Scalar, Joints>::check_chord(const float* from, const float* to,
                                                  SegmentCheck<Scalar>* check) const {
  const Angles start = read<Scalar, Joints>(from + layout_.angles);
  check_move(from, to, start, read<Scalar, Joints>(to + layout_.angles) - start, check);
}

template <typename Scalar, int Joints>
TableError<Scalar> PathCertificate<Scalar, Joints>::inside_error(const float* from,
                                                                 const float* to) const {
  constexpr std::uint32_t kSteps = 4;
  constexpr std::uint32_t kCorners = 1U << static_cast<unsigned>(Joints);
  constexpr Scalar kRounding = Scalar(1e-6);  // rad, of the lookup's own distance
  const Angles zero = Angles::Zero();
  const Angles start = read<Scalar, Joints>(from + layout_.angles);
  const Angles motion = read<Scalar, Joints>(to + layout_.angles) - start;
  const Scalar width = static_cast<Scalar>(from[layout_.width]) + kRounding;
  TableError<Scalar> worst;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    const Scalar t = static_cast<Scalar>(i) / Scalar(kSteps);
    const TableEntry<Scalar, Joints> entry =
        blend_segment<Scalar, Joints>(from, to, layout_, t, zero);
    for (std::uint32_t corner = 0; corner < kCorners; ++corner) {
      Angles q = start + t * motion;
      for (Eigen::Index joint = 0; joint < Joints; ++joint) {
        q[joint] += (corner >> static_cast<unsigned>(joint) & 1U) != 0 ? width : -width;
      }
      worst = larger(worst, entry_error(model_, exact_entry(model_, q), entry, bound_));
    }
  }
  // Between the corners the errors of the corners can be blended; what bends away from that is at
  // most half of width² times the second derivative, for each joint. Along the chord likewise.
  const TableEntry<Scalar, Joints> first =
      blend_segment<Scalar, Joints>(from, to, layout_, Scalar(0), zero);
  const TableEntry<Scalar, Joints> last =
      blend_segment<Scalar, Joints>(from, to, layout_, Scalar(1), zero);
  const TableError<Scalar> across =
      segment_curvature(bounds_, first, last, bound_, SegmentMotion<Scalar>{1, 0, 0});
  const TableError<Scalar> along = segment_curvature(
      bounds_, first, last, bound_, SegmentMotion<Scalar>{motion.cwiseAbs().sum(), 1, 0});
  const Scalar of_across = Scalar(Joints) * width * width / Scalar(2);
  const Scalar of_along = Scalar(1) / Scalar(8 * kSteps * kSteps);
  return {worst.position + of_across * across.position + of_along * along.position +
              bounds_.rounding.position,
          worst.orientation + of_across * across.orientation + of_along * along.orientation +
              bounds_.rounding.orientation};
}

template <typename Scalar, int Joints>
Scalar PathCertificate<Scalar, Joints>::chord_length(const float* from, const float* to) const {
  return (read<Scalar, Joints>(to + layout_.angles) - read<Scalar, Joints>(from + layout_.angles))
      .norm();
}

/// Smallest distance between the segment's two planes along a move; zero if the move leaves the
/// room between them or the planes lean too far towards each other for the blend to be smooth.
template <typename Scalar, int Joints>
Scalar PathCertificate<Scalar, Joints>::smallest_span(const float* from, const float* to,
                                                      const Angles& start,
                                                      const Angles& end) const {
  const auto first = place_on_segment<Scalar, Joints>(from, to, start);
  const auto second = place_on_segment<Scalar, Joints>(from, to, end);
  const Scalar span = std::min(first.gone + first.left, second.gone + second.left);
  const Scalar chord = chord_length(from, to);
  // Nodes are rounded to float, so the ends of a program piece may lie outside by that much.
  const Scalar slack = Scalar(1e-6) + Scalar(1e-3) * chord;
  const Scalar lowest =
      std::min(std::min(first.gone, first.left), std::min(second.gone, second.left));
  return lowest >= -slack && span >= Scalar(kLeastSpan) * chord ? span : Scalar(0);
}

template <typename Scalar, int Joints>
TableError<Scalar> PathCertificate<Scalar, Joints>::curvature_of(const float* from, const float* to,
                                                                 const Angles& motion,
                                                                 Scalar span) const {
  const Angles zero = Angles::Zero();
  const Scalar speed = motion.norm();
  const Scalar lean = (read<Scalar, Joints>(to + layout_.normal_in) -
                       read<Scalar, Joints>(from + layout_.normal_out))
                          .norm();
  const SegmentMotion<Scalar> segment{motion.cwiseAbs().sum(), speed / span,
                                      Scalar(2) * speed * speed * lean / (span * span)};
  return segment_curvature(
      bounds_, blend_segment<Scalar, Joints>(from, to, layout_, Scalar(0), zero),
      blend_segment<Scalar, Joints>(from, to, layout_, Scalar(1), zero), bound_, segment);
}

#define FLEXCOMP_PATH_CERTIFICATE(Scalar, Joints) template class PathCertificate<Scalar, Joints>;
FLEXCOMP_INSTANTIATE(FLEXCOMP_PATH_CERTIFICATE)

}  // namespace flexcomp
