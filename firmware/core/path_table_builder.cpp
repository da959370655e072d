#include <algorithm>
#include <cmath>

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
        error_ = larger(error_, check.error);
        inside_ = larger(inside_, certificate_.inside_error(record, writer_.record(node + 1)));
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
    writer_.state_inside_error(TableError<Scalar>{Scalar(kInsideMargin) * inside_.position,
                                                  Scalar(kInsideMargin) * inside_.orientation});
    writer_.finish(node + 1, error_);
    return Result::ok;
  }

 private:
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
      certificate_.check_move(first, second, path_.angles(place) - motion, motion, &check);
    }
    return check;
  }

  const RobotModel<Scalar, Joints>& model_;
  const ProgramPath<Scalar, Joints>& path_;
  TableError<Scalar> tolerance_;
  PathCertificate<Scalar, Joints> certificate_;
  TableWriter& writer_;
  TableError<Scalar> error_;
  TableError<Scalar> inside_;  ///< at all angles that a lookup takes for inside
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
