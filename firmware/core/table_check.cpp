#include <algorithm>
#include <cmath>

#include "flexcomp/loop_gain.hpp"
#include "flexcomp/table_builder.hpp"
#include "grid_certificate.hpp"
#include "instantiate.hpp"
#include "path_certificate.hpp"
#include "table_writer.hpp"

namespace flexcomp {
namespace {

/// Share of the stated error that may go to what happens between the points looked at, and the same
/// for a second and closer look at what seems to be above it.
constexpr double kShare = 0.05;
constexpr double kCloserShare = 0.0005;

/// A certificate is at most this many times what is found again without the program.
constexpr double kMostAbove = 100;

/// The certificate for all angles inside needs no program, and is found again to a hundredth.
constexpr double kMostInside = 2;

bool are_zero(const float* numbers, std::size_t count) {
  return std::all_of(numbers, numbers + count, [](float number) { return number == 0.0F; });
}

bool are_zero(const std::uint32_t* numbers, std::size_t count) {
  return std::all_of(numbers, numbers + count, [](std::uint32_t number) { return number == 0; });
}

bool is_nearly(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

/// Fields that the springs and limits come from, as a builder writes them.
template <typename Scalar, int Joints>
bool says_the_same(const TableHeader& header, const RobotModel<Scalar, Joints>& model) {
  bool same = true;
  for (std::size_t i = 0; i < Joints; ++i) {
    const Joint<Scalar>& joint = model.joints[i];
    same = same && header.compliance[i] == static_cast<float>(joint.compliance) &&
           header.cubic_compliance[i] == static_cast<float>(joint.cubic_compliance) &&
           header.joint_lower[i] == nearest_finite(joint.lower) &&
           header.joint_upper[i] == nearest_finite(joint.upper);
  }
  const std::uint32_t contents = (has_weight(model) ? Table::kWeight : 0U) |
                                 (has_structure_springs(model) ? Table::kStructure : 0U);
  return same && header.contents == contents;
}

/// The table of a robot that gives nowhere is exact.
bool is_rigid(const TableHeader& header) {
  return are_zero(header.compliance, kTableJoints) &&
         are_zero(header.cubic_compliance, kTableJoints) &&
         (header.contents & Table::kStructure) == 0;
}

bool bounds_are_in_order(const TableHeader& header) {
  const bool are_errors = header.position_error > 0 && header.orientation_error > 0;
  const bool are_none =
      header.position_error == 0 && header.orientation_error == 0 && is_rigid(header);
  return header.force_bound >= 0 && header.moment_bound >= 0 &&
         header.force_bound + header.moment_bound > 0 && (are_errors || are_none) &&
         header.largest_gain >= 0 &&
         follows_from(static_cast<double>(header.largest_gain), gain_basis(header));
}

/// The ends of the program, which are both nodes, meet if and only if the header says so.
bool is_closed_as_stated(const Table& table) {
  constexpr double kGap = 1e-6;  // of the program, as its builder has it
  const TableHeader& header = table.header();
  const RecordLayout layout = record_layout(table);
  const float* const first = table.record(0) + layout.angles;
  const float* const last = table.record(header.node_count - 1) + layout.angles;
  double gap = 0;
  double rounding = 0;
  for (std::size_t i = 0; i < kTableJoints; ++i) {
    gap = std::max(gap, std::abs(static_cast<double>(last[i]) - static_cast<double>(first[i])));
    rounding = std::max(rounding, 1.2e-7 * std::abs(static_cast<double>(first[i])));
  }
  return header.closed == 1 ? gap <= kGap + rounding
                            : header.closed == 0 && gap > kGap - std::min(rounding, 0.5 * kGap);
}

/// Both errors or none: an older table does not state them.
bool is_in_order(const InsideError& error) {
  return (error.position > 0.0F && error.orientation > 0.0F) ||
         (error.position == 0.0F && error.orientation == 0.0F);
}

bool is_path_header(const Table& table) {
  constexpr std::size_t kStated = 2;  // `inside_error`
  const TableHeader& header = table.header();
  return header.grid_axes == 0 && are_zero(header.grid_joint, kMaxGridAxes) &&
         are_zero(header.grid_nodes, kMaxGridAxes) &&
         are_zero(header.grid_lower + kStated, kMaxGridAxes - kStated) &&
         are_zero(header.grid_step, kMaxGridAxes) && are_zero(header.first_axis, 3) &&
         is_in_order(inside_error(header)) && is_closed_as_stated(table);
}

/// Axes in the order of the joints, steps that angles in `float` can resolve, and nothing behind
/// the last.
bool is_grid_header(const TableHeader& header) {
  constexpr float kSmallestStep = 1e-6F;
  const std::size_t axes = header.grid_axes;
  bool good = header.closed == 0 && header.fixed_angle[0] == 0.0F &&
              header.fixed_angle[kTableJoints - 1] == 0.0F;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const std::uint32_t joint = header.grid_joint[axis];
    good = good && joint >= (axis == 0 ? 1 : header.grid_joint[axis - 1] + 1) &&
           joint + 1 < kTableJoints && header.fixed_angle[joint] == header.grid_lower[axis] &&
           header.grid_step[axis] >= kSmallestStep;
  }
  const std::size_t rest = kMaxGridAxes - axes;
  return good && are_zero(header.grid_joint + axes, rest) &&
         are_zero(header.grid_nodes + axes, rest) && are_zero(header.grid_lower + axes, rest) &&
         are_zero(header.grid_step + axes, rest);
}

/// Built in `float` or `double`, the axis differs in the last places.
template <typename Scalar, int Joints>
bool has_first_axis(const TableHeader& header, const RobotModel<Scalar, Joints>& model) {
  const Vector3<Scalar> axis = model.joints[0].origin.rotation * model.joints[0].axis;
  bool same = true;
  for (Eigen::Index i = 0; i < 3; ++i) {
    same = same &&
           is_nearly(static_cast<double>(header.first_axis[i]), static_cast<double>(axis[i]), 5e-7);
  }
  return same;
}

Eigen::Matrix<double, 6, 1> vector(const float* numbers) {
  return Eigen::Map<const Eigen::Matrix<float, 6, 1>>(numbers).cast<double>();
}

/// A node's planes are one plane, or at a sharp corner two and the one between them; a program that
/// turns back on itself has none between.
bool has_planes_of_a_builder(const float* record, const RecordLayout& layout) {
  constexpr double kRounding = 1e-6;
  constexpr double kSharp = 0.867;
  const auto in = vector(record + layout.normal_in);
  const auto out = vector(record + layout.normal_out);
  const auto switching = vector(record + layout.switching);
  const double length = (in + out).norm();
  const bool is_one = (in - out).norm() <= kRounding;
  const bool turns_back = length < 2e-3 && switching.norm() == 0;
  const bool is_between =
      length > 5e-4 && (switching - (in + out) / length).norm() <= kRounding + kRounding / length;
  return is_nearly(in.norm(), 1, kRounding) && is_nearly(out.norm(), 1, kRounding) &&
         (is_one || in.dot(out) < kSharp) && (turns_back || is_between);
}

template <typename Scalar>
WrenchBound<Scalar> wrench_bound(const TableHeader& header) {
  return {static_cast<Scalar>(header.force_bound), static_cast<Scalar>(header.moment_bound)};
}

template <typename Scalar>
TableError<Scalar> stated_error(const TableHeader& header) {
  return {static_cast<Scalar>(header.position_error),
          static_cast<Scalar>(header.orientation_error)};
}

template <typename Scalar>
bool is_above(const TableError<Scalar>& error, const TableError<Scalar>& stated) {
  return !(error.position <= stated.position && error.orientation <= stated.orientation);
}

template <typename Scalar, int Joints>
Result derive_path_certificate(const RobotModel<Scalar, Joints>& model, const Table& table,
                               const WrenchBound<Scalar>& bound, const TableError<Scalar>& stated,
                               TableError<Scalar>* error) {
  const RecordLayout layout = record_layout(table);
  const PathCertificate<Scalar, Joints> certificate(model, bound, stated, layout, Scalar(kShare));
  const PathCertificate<Scalar, Joints> closer(model, bound, stated, layout, Scalar(kCloserShare));
  const std::uint32_t last = table.header().node_count - 1;
  *error = certificate.rounding();
  if (is_above(*error, stated)) {
    return Result::ok;
  }
  for (std::uint32_t node = 0; node <= last; ++node) {
    const float* const from = table.record(node);
    if (!has_planes_of_a_builder(from, layout) ||
        !is_plausible_width(from, node < last ? from + layout.size : nullptr, layout)) {
      return Result::table_corrupt;
    }
    if (node == last) {
      break;
    }
    SegmentCheck<Scalar> check;
    certificate.check_chord(from, from + layout.size, &check);
    if (!check.holds && is_above(check.error, stated)) {
      check = SegmentCheck<Scalar>{};
      closer.check_chord(from, from + layout.size, &check);
    }
    *error = larger(*error, check.error);
    if (is_above(check.error, stated)) {
      return Result::ok;
    }
    if (!check.holds) {
      return Result::table_corrupt;
    }
  }
  return Result::ok;
}

template <typename Scalar, int Joints>
Result derive_grid_certificate(const RobotModel<Scalar, Joints>& model, const Table& table,
                               const WrenchBound<Scalar>& bound, const TableError<Scalar>& stated,
                               TableError<Scalar>* error) {
  if (!is_invariant(model)) {
    return Result::chart_not_invariant;
  }
  *error = model_bounds(model, bound).rounding;
  if (is_above(*error, stated)) {
    return Result::ok;
  }
  bool holds = check_grid(model, table, stated, Scalar(kShare), error);
  if (!holds && is_above(*error, stated)) {
    *error = TableError<Scalar>{};
    holds = check_grid(model, table, stated, Scalar(kCloserShare), error);
  }
  return holds || is_above(*error, stated) ? Result::ok : Result::table_corrupt;
}

}  // namespace

template <typename Scalar, int Joints>
Result check_against_model(const RobotModel<Scalar, Joints>& model, const Table& table) {
  if (!table.is_open()) {
    return Result::bad_argument;
  }
  const Result valid = validate(model);
  if (valid != Result::ok) {
    return valid;
  }
  const TableHeader& header = table.header();
  const bool is_grid = table.chart() == Chart::joint_grid;
  if (table.model_hash() != model_hash(model) || !says_the_same(header, model) ||
      (is_grid && !has_first_axis(header, model))) {
    return Result::table_other_model;
  }
  const bool is_in_order =
      bounds_are_in_order(header) && (is_grid ? is_grid_header(header) : is_path_header(table));
  return is_in_order ? Result::ok : Result::table_corrupt;
}

template <typename Scalar, int Joints>
Result derive_certificate(const RobotModel<Scalar, Joints>& model, const Table& table,
                          TableError<Scalar>* error) {
  *error = TableError<Scalar>{};
  const Result checked = check_against_model(model, table);
  if (checked != Result::ok) {
    return checked;
  }
  const TableHeader& header = table.header();
  if (is_rigid(header)) {
    return Result::ok;  // a tick multiplies all that is in the records by springs of zero
  }
  const WrenchBound<Scalar> bound = wrench_bound<Scalar>(header);
  const TableError<Scalar> stated = stated_error<Scalar>(header);
  const Result derived = table.chart() == Chart::path
                             ? derive_path_certificate(model, table, bound, stated, error)
                             : derive_grid_certificate(model, table, bound, stated, error);
  const bool is_absurd = stated.position > Scalar(kMostAbove) * error->position ||
                         stated.orientation > Scalar(kMostAbove) * error->orientation;
  return derived == Result::ok && is_absurd ? Result::table_corrupt : derived;
}

template <typename Scalar, int Joints>
Result derive_inside_error(const RobotModel<Scalar, Joints>& model, const Table& table,
                           TableError<Scalar>* error) {
  *error = TableError<Scalar>{};
  if (table.is_open() && table.chart() == Chart::joint_grid) {
    return derive_certificate(model, table, error);
  }
  const Result checked = check_against_model(model, table);
  if (checked != Result::ok || is_rigid(table.header())) {
    return checked;
  }
  const PathCertificate<Scalar, Joints> certificate(model, wrench_bound<Scalar>(table.header()),
                                                    stated_error<Scalar>(table.header()),
                                                    record_layout(table), Scalar(kShare));
  const InsideError inside = inside_error(table.header());
  const TableError<Scalar> stated{static_cast<Scalar>(inside.position),
                                  static_cast<Scalar>(inside.orientation)};
  const bool is_stated = stated.position > Scalar(0);
  for (std::uint32_t node = 0; node + 1 < table.shape().node_count; ++node) {
    const auto found = certificate.inside_error(table.record(node), table.record(node + 1));
    *error = larger(*error, found);
    if (is_stated && is_above(found, stated)) {
      *error = found;
      return Result::ok;
    }
  }
  const bool is_absurd = stated.position > Scalar(kMostInside) * error->position ||
                         stated.orientation > Scalar(kMostInside) * error->orientation;
  return is_absurd ? Result::table_corrupt : Result::ok;
}

#define FLEXCOMP_TABLE_CHECK(Scalar, Joints)                                            \
  template Result check_against_model(const RobotModel<Scalar, Joints>&, const Table&); \
  template Result derive_certificate(const RobotModel<Scalar, Joints>&, const Table&,   \
                                     TableError<Scalar>*);                              \
  template Result derive_inside_error(const RobotModel<Scalar, Joints>&, const Table&,  \
                                      TableError<Scalar>*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE_CHECK)

}  // namespace flexcomp
