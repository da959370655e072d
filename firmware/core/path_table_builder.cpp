#include <algorithm>
#include <cmath>

#include "instantiate.hpp"
#include "path_chart.hpp"
#include "program_path.hpp"
#include "table_writer.hpp"

namespace flexcomp {
namespace {

/// Share of the tolerance that may go to what happens between the checked points.
constexpr double kCurvatureShare = 0.1;

/// Shortest segment (1-norm, rad) that is tried before the tolerance is given up.
constexpr double kShortestSegment = 1e-6;

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
        bound_{requirements.force_bound, requirements.moment_bound},
        tolerance_{requirements.position_tolerance, requirements.orientation_tolerance},
        bounds_(model_bounds(model, bound_)),
        writer_(*writer) {}

  Result build() {
    if (bounds_.rounding.position >= tolerance_.position ||
        bounds_.rounding.orientation >= tolerance_.orientation) {
      return Result::tolerance_not_met;
    }
    if (!writer_.fits(2)) {
      return Result::buffer_too_small;
    }
    Place place = path_.begin();
    std::uint32_t node = 0;
    write_node(node, place);
    Scalar length = Scalar(0.1);
    while (!path_.is_end(place)) {
      if (!writer_.fits(std::uint64_t{node} + 2)) {
        return Result::buffer_too_small;
      }
      const Place next = path_.advanced(place, length);
      write_node(node + 1, next);
      const SegmentCheck check = check_segment(node, place, next);
      if (check.holds) {
        error_ = larger(error_, check.error);
        // Between checked points the program strays a little more than at them, and rounding adds.
        writer_.record(node)[writer_.layout().width] =
            static_cast<float>(Scalar(1.01) * check.width + Scalar(1e-6));
        place = next;
        ++node;
        length *= Scalar(1.5);
      } else {
        length *= Scalar(0.7);
        if (length < Scalar(kShortestSegment)) {
          return Result::tolerance_not_met;
        }
      }
    }
    writer_.header().closed = path_.is_closed() ? 1 : 0;
    writer_.finish(node + 1, error_);
    return Result::ok;
  }

 private:
  struct SegmentCheck {
    bool holds = false;
    TableError<Scalar> error;
    Scalar width = 0;
  };

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

  Angles node_angles(std::uint32_t node) const {
    return Eigen::Map<const JointVector<float, Joints>>(writer_.record(node) +
                                                        writer_.layout().angles)
        .template cast<Scalar>();
  }

  /// Checks the program between two nodes, and the chord between them: the first is what the robot
  /// does, the second what can be checked later from the table alone.
  SegmentCheck check_segment(std::uint32_t node, const Place& from, const Place& to) const {
    SegmentCheck check;
    check.holds = true;
    const Angles start = node_angles(node);
    check_move(node, start, node_angles(node + 1) - start, &check);
    Place place = from;
    while (check.holds && (place.piece != to.piece || place.fraction != to.fraction)) {
      const Place begin = place;
      const Angles motion = path_.straight_move(begin, to, &place);
      check_move(node, path_.angles(place) - motion, motion, &check);
    }
    return check;
  }

  /// Checks a straight move in joint space that lies between the planes of the segment's nodes.
  void check_move(std::uint32_t node, const Angles& start, const Angles& motion,
                  SegmentCheck* check) const {
    const RecordLayout& layout = writer_.layout();
    const float* from = writer_.record(node);
    const float* to = writer_.record(node + 1);
    const Angles end = start + motion;
    const Scalar span = smallest_span(from, to, start, end);
    if (!(span > Scalar(0))) {
      check->holds = false;
      return;
    }
    const TableError<Scalar> curvature = curvature_of(from, to, motion, span);
    const Scalar most = std::min(tolerance_.position / curvature.position,
                                 tolerance_.orientation / curvature.orientation);
    const Scalar longest = std::sqrt(Scalar(8 * kCurvatureShare) * most);
    const auto steps =
        static_cast<std::uint32_t>(std::ceil(Scalar(1) / std::min(longest, Scalar(1))));
    const Scalar step = Scalar(1) / static_cast<Scalar>(steps);
    const Scalar between = step * step / Scalar(8);
    for (std::uint32_t i = 0; i <= steps && check->holds; ++i) {
      const Angles q = start + (static_cast<Scalar>(i) * step) * motion;
      const Scalar t = place_on_segment<Scalar, Joints>(from, to, q).blend();
      const TableEntry<Scalar, Joints> entry =
          blend_segment<Scalar, Joints>(from, to, layout, t, q);
      TableError<Scalar> error = entry_error(model_, exact_entry(model_, q), entry, bound_);
      error.position += between * curvature.position + bounds_.rounding.position;
      error.orientation += between * curvature.orientation + bounds_.rounding.orientation;
      check->error = larger(check->error, error);
      check->width = std::max(check->width, entry.outside);
      check->holds =
          error.position <= tolerance_.position && error.orientation <= tolerance_.orientation;
    }
  }

  /// Smallest distance between the segment's two planes along a move; zero if the move leaves the
  /// room between them or the planes lean too far towards each other for the blend to be smooth.
  Scalar smallest_span(const float* from, const float* to, const Angles& start,
                       const Angles& end) const {
    const RecordLayout& layout = writer_.layout();
    const auto first = place_on_segment<Scalar, Joints>(from, to, start);
    const auto second = place_on_segment<Scalar, Joints>(from, to, end);
    const Scalar span = std::min(first.gone + first.left, second.gone + second.left);
    const Scalar chord = (Eigen::Map<const JointVector<float, Joints>>(to + layout.angles) -
                          Eigen::Map<const JointVector<float, Joints>>(from + layout.angles))
                             .template cast<Scalar>()
                             .norm();
    // Nodes are rounded to float, so the ends of a program piece may lie outside by that much.
    const Scalar slack = Scalar(1e-6) + Scalar(1e-3) * chord;
    const Scalar lowest =
        std::min(std::min(first.gone, first.left), std::min(second.gone, second.left));
    return lowest >= -slack && span >= Scalar(0.7) * chord ? span : Scalar(0);
  }

  TableError<Scalar> curvature_of(const float* from, const float* to, const Angles& motion,
                                  Scalar span) const {
    const RecordLayout& layout = writer_.layout();
    const Angles zero = Angles::Zero();
    const Scalar speed = motion.norm();
    const Scalar lean = (Eigen::Map<const JointVector<float, Joints>>(to + layout.normal_in) -
                         Eigen::Map<const JointVector<float, Joints>>(from + layout.normal_out))
                            .template cast<Scalar>()
                            .norm();
    const SegmentMotion<Scalar> segment{motion.cwiseAbs().sum(), speed / span,
                                        Scalar(2) * speed * speed * lean / (span * span)};
    return segment_curvature(
        bounds_, blend_segment<Scalar, Joints>(from, to, layout, Scalar(0), zero),
        blend_segment<Scalar, Joints>(from, to, layout, Scalar(1), zero), bound_, segment);
  }

  const RobotModel<Scalar, Joints>& model_;
  const ProgramPath<Scalar, Joints>& path_;
  WrenchBound<Scalar> bound_;
  TableError<Scalar> tolerance_;
  ModelBounds<Scalar, Joints> bounds_;
  TableWriter& writer_;
  TableError<Scalar> error_;
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
