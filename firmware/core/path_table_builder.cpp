#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "instantiate.hpp"
#include "path_certificate.hpp"
#include "program_path.hpp"
#include "table_writer.hpp"

namespace flexcomp {
namespace {

/// Share of the tolerance that may go to what happens between the checked points.
constexpr double kCurvatureShare = 0.1;

/// The bound stated for all angles inside is above the one found by this factor, so that it also
/// holds where it is derived again with another precision.
constexpr double kInsideMargin = 1.01;

/// Shortest segment (1-norm, rad) that is tried before the tolerance is given up.
constexpr double kShortestSegment = 1e-6;

/// Segments before a corner that can be made anew with shorter ones.
constexpr std::uint32_t kRemembered = 32;

/// Moves (rad) that a lookup does not tell from none.
constexpr double kResolution = 1e-6;

/// Sets nodes along one program as far apart as the tolerance allows.
template <typename Scalar, int Joints>
class PathTableBuilder {
 public:
  using Angles = JointVector<Scalar, Joints>;
  using Place = typename ProgramPath<Scalar, Joints>::Place;

  PathTableBuilder(const RobotModel<Scalar, Joints>& model, const ProgramPath<Scalar, Joints>& path,
                   const TableRequirements<Scalar>& requirements, TableWriter* writer)
      : model_(model),
        path_(path),
        tolerance_{requirements.position_tolerance, requirements.orientation_tolerance},
        certificate_(model, {requirements.force_bound, requirements.moment_bound}, tolerance_,
                     writer->layout(), Scalar(kCurvatureShare)),
        writer_(*writer) {}

  Result build() {
    if (certificate_.rounding().position >= tolerance_.position ||
        certificate_.rounding().orientation >= tolerance_.orientation) {
      return Result::tolerance_not_met;
    }
    if (!writer_.fits(2)) {
      return Result::buffer_too_small;
    }
    Place place = path_.begin();
    std::uint32_t node = 0;
    write_node(node, place);
    Scalar length = Scalar(0.1);
    Scalar longest = std::numeric_limits<Scalar>::infinity();
    while (!path_.is_end(place)) {
      if (!writer_.fits(std::uint64_t{node} + 2)) {
        return Result::buffer_too_small;
      }
      const Place next = path_.advanced(place, length);
      write_node(node + 1, next);
      const SegmentCheck<Scalar> check = check_segment(node, place, next);
      float* const record = writer_.record(node);
      // Between checked points the program strays a little more than at them, and rounding adds.
      record[writer_.layout().width] =
          static_cast<float>(Scalar(1.01) * check.width + Scalar(1e-6));
      if (check.holds && is_plausible_width(record, writer_.record(node + 1), writer_.layout())) {
        const Angles chord = path_.angles(next) - path_.angles(place);
        remember(node, {place, std::min(length, chord.cwiseAbs().sum())});
        const bool corner = turns_back(node + 1);
        const std::uint32_t wide = corner ? too_wide_for_what_follows(node, next) : kNone;
        if (wide == kNone) {
          error_ = larger(error_, check.error);
          inside_ = larger(inside_, certificate_.inside_error(record, writer_.record(node + 1)));
          place = next;
          ++node;
          length = std::min(length * Scalar(1.5), longest);
          if (corner) {
            longest = std::numeric_limits<Scalar>::infinity();
          }
          continue;
        }
        if (node - wide >= kRemembered) {
          return Result::tolerance_not_met;
        }
        node = wide;
        place = remembered(wide).begin;
        write_node(node, place);
        length = remembered(wide).length;
        longest = Scalar(0.7) * length;
      }
      length *= Scalar(0.7);
      if (length < Scalar(kShortestSegment)) {
        return Result::tolerance_not_met;
      }
    }
    writer_.header().closed = path_.is_closed() ? 1 : 0;
    writer_.state_inside_error(TableError<Scalar>{Scalar(kInsideMargin) * inside_.position,
                                                  Scalar(kInsideMargin) * inside_.orientation});
    writer_.finish(node + 1, error_);
    return Result::ok;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kGoesOn = kNone - 1;

  void write_node(std::uint32_t node, const Place& place) {
    const RecordLayout& layout = writer_.layout();
    const auto directions = path_.directions(place);
    const Angles q = path_.angles(place);
    float* record = writer_.record(node);
    for (Eigen::Index i = 0; i < Joints; ++i) {
      record[layout.angles + i] = static_cast<float>(q[i]);
      record[layout.switching + i] = static_cast<float>(directions.mean[i]);
      record[layout.normal_in + i] = static_cast<float>(directions.before[i]);
      record[layout.normal_out + i] = static_cast<float>(directions.after[i]);
    }
    record[layout.width] = 0;
    pack(exact_entry(model_, q), layout, record);
  }

  /// Checks the program between two nodes, and the chord between them: the first is what the robot
  /// does, the second what can be checked later from the table alone.
  SegmentCheck<Scalar> check_segment(std::uint32_t node, const Place& from, const Place& to) const {
    const float* const first = writer_.record(node);
    const float* const second = writer_.record(node + 1);
    SegmentCheck<Scalar> check;
    certificate_.check_chord(first, second, &check);
    Place place = from;
    while (check.holds && (place.piece != to.piece || place.fraction != to.fraction)) {
      const Place begin = place;
      const Angles motion = path_.straight_move(begin, to, &place);
      const Angles start = path_.angles(place) - motion;
      certificate_.check_move(first, second, start, motion, &check);
      check.holds = check.holds && certificate_.is_between_neighbours(first, second, start, motion);
    }
    return check;
  }

  /// Where one segment begins, and how long it was to be.
  struct Begin {
    Place begin;
    Scalar length = 0;
  };
  void remember(std::uint32_t node, const Begin& begin) { begins_[node % kRemembered] = begin; }
  const Begin& remembered(std::uint32_t node) const { return begins_[node % kRemembered]; }

  bool turns_back(std::uint32_t node) {
    const float* const plane = writer_.record(node) + writer_.layout().switching;
    return std::all_of(plane, plane + Joints, [](float number) { return number == 0.0F; });
  }

  /// Where the program turns back no plane tells the segments apart: a lookup stays on those before
  /// the corner while their widths hold the program behind it. Where that retraces its own way,
  /// this does no harm. Returns the number of a segment that is too wide, so that what is read
  /// there is off by more than the tolerance, or kNone.
  std::uint32_t too_wide_for_what_follows(std::uint32_t node, const Place& corner) {
    std::uint32_t segment = node;
    for (Place place = path_.retraced(corner); !path_.is_end(place);) {
      Place reached;
      const Angles motion = path_.straight_move(place, path_.end_of_piece(place), &reached);
      const std::uint32_t wide =
          too_wide_for(path_.angles(reached) - motion, motion, node, &segment);
      if (wide != kGoesOn) {
        return wide;
      }
      place = reached;
    }
    return kNone;
  }

  /// The same for one straight move, on which the lookup begins with `segment`; kGoesOn where it is
  /// on one of the segments at the end of the move too.
  std::uint32_t too_wide_for(Angles q, Angles motion, std::uint32_t last, std::uint32_t* segment) {
    using Side = typename PathCertificate<Scalar, Joints>::Side;
    for (Scalar part = 0; part < Scalar(1);) {
      if (!follow(q, last, segment)) {
        return kNone;
      }
      const float* const first = writer_.record(*segment);
      const float* const second = writer_.record(*segment + 1);
      const Scalar least = Scalar(kResolution) / motion.norm();
      part = certificate_.part_beside(first, second, motion);
      while (part > least && certificate_.side(first, second, q + part * motion) != Side::on) {
        part /= Scalar(2);
      }
      if (part > least) {
        const TableError<Scalar> error = certificate_.error_beside(first, second, q, part * motion);
        if (!(error.position <= tolerance_.position &&
              error.orientation <= tolerance_.orientation)) {
          return *segment;
        }
        error_ = larger(error_, error);
      }
      part = std::min(std::max(part, least), Scalar(1));
      q += part * motion;
      motion *= Scalar(1) - part;
    }
    return kGoesOn;
  }

  /// Moves to the segment that a lookup goes to, up to `last`; false where it leaves them.
  bool follow(const Angles& q, std::uint32_t last, std::uint32_t* segment) {
    using Side = typename PathCertificate<Scalar, Joints>::Side;
    Side came_from = Side::on;
    for (;;) {
      const Side side =
          certificate_.side(writer_.record(*segment), writer_.record(*segment + 1), q);
      const bool at_end = side == Side::before ? *segment == 0 : *segment == last;
      if (side == Side::off || side == Side::on || at_end ||
          (came_from != Side::on && side != came_from)) {
        return side == Side::on;
      }
      *segment += side == Side::before ? -1U : 1U;
      came_from = side;
    }
  }

  const RobotModel<Scalar, Joints>& model_;
  const ProgramPath<Scalar, Joints>& path_;
  TableError<Scalar> tolerance_;
  PathCertificate<Scalar, Joints> certificate_;
  TableWriter& writer_;
  TableError<Scalar> error_;
  std::array<Begin, kRemembered> begins_{};  ///< of the last segments
  TableError<Scalar> inside_;                ///< at all angles that a lookup takes for inside
};

}  // namespace

template <typename Scalar, int Joints>
Result build_path_table(const RobotModel<Scalar, Joints>& model,
                        const JointVector<Scalar, Joints>* points, std::size_t count,
                        const TableRequirements<Scalar>& requirements, void* buffer,
                        std::size_t capacity, std::size_t* size) {
  const Result checked = check_build_arguments(model, requirements, buffer, capacity, size);
  if (checked != Result::ok) {
    return checked;
  }
  const ProgramPath<Scalar, Joints> path(points, count);
  if (!path.is_valid()) {
    return Result::bad_path;
  }
  TableWriter writer(model, requirements, Chart::path, buffer, capacity);
  const Result built = PathTableBuilder<Scalar, Joints>(model, path, requirements, &writer).build();
  if (built == Result::ok) {
    *size = writer.header().size;
  }
  return built;
}

#define FLEXCOMP_PATH_TABLE(Scalar, Joints)                                               \
  template Result build_path_table(                                                       \
      const RobotModel<Scalar, Joints>&, const JointVector<Scalar, Joints>*, std::size_t, \
      const TableRequirements<Scalar>&, void*, std::size_t, std::size_t*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_PATH_TABLE)

}  // namespace flexcomp
