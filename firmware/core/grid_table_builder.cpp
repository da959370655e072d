#include <algorithm>
#include <array>
#include <cmath>

#include "grid_chart.hpp"
#include "instantiate.hpp"
#include "table_writer.hpp"

namespace flexcomp {
namespace {

/// Share of the tolerance that may go to what happens between the checked points.
constexpr double kCurvatureShare = 0.2;

/// Most nodes along an axis; past it the tolerance is out of reach of a grid.
constexpr std::uint32_t kMostNodes = 4096;

/// Visits the points of a box-shaped lattice, the last axis fastest.
class LatticeCounter {
 public:
  LatticeCounter(const std::array<std::uint32_t, kMaxGridAxes>& points, std::size_t axes)
      : points_(points), axes_(axes) {}

  std::uint32_t operator[](std::size_t axis) const { return index_[axis]; }

  bool advance() {
    for (std::size_t axis = axes_; axis-- > 0;) {
      if (++index_[axis] < points_[axis]) {
        return true;
      }
      index_[axis] = 0;
    }
    return false;
  }

 private:
  std::array<std::uint32_t, kMaxGridAxes> points_;
  std::array<std::uint32_t, kMaxGridAxes> index_{};
  std::size_t axes_;
};

/// Does turning joints 1 and 6 leave the compliance as it is, but for the rotation about axis 1?
///
/// Tried at postures that have nothing in common; what varies with the angle would show at these.
template <typename Scalar, int Joints>
bool is_invariant(const RobotModel<Scalar, Joints>& model) {
  if (has_structure_springs(model)) {
    return false;
  }
  JointVector<Scalar, Joints> q;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    q[i] = Scalar(0.3) + Scalar(0.4) * static_cast<Scalar>(i);
  }
  q[0] = 0;
  q[Joints - 1] = 0;
  const TableEntry<Scalar, Joints> still = exact_entry(model, q);
  const Vector3<Scalar> axis = model.joints[0].origin.rotation * model.joints[0].axis;
  const Scalar torque_scale = Scalar(1) + still.weight_torque.cwiseAbs().maxCoeff();
  for (const Scalar angle : {Scalar(0.9), Scalar(-2.1)}) {
    q[0] = angle;
    q[Joints - 1] = Scalar(1.3) * angle;
    const TableEntry<Scalar, Joints> turned = exact_entry(model, q);
    const Matrix3<Scalar> rotation = axis_rotation<Scalar>(axis, angle);
    Scalar error = 0;
    for (Eigen::Index i = 0; i < Joints; ++i) {
      const Vector3<Scalar> linear = turned.jacobian.col(i).template head<3>() -
                                     rotation * still.jacobian.col(i).template head<3>();
      const Vector3<Scalar> angular = turned.jacobian.col(i).template tail<3>() -
                                      rotation * still.jacobian.col(i).template tail<3>();
      error = std::max({error, linear.cwiseAbs().maxCoeff(), angular.cwiseAbs().maxCoeff(),
                        std::abs(turned.weight_torque[i] - still.weight_torque[i]) / torque_scale});
    }
    if (error > Scalar(1e-5)) {
      return false;
    }
  }
  return true;
}

/// Fills a grid of equal steps and checks it, finer until the tolerance is met.
template <typename Scalar, int Joints>
class GridTableBuilder {
 public:
  GridTableBuilder(const RobotModel<Scalar, Joints>& model, const GridRange<Scalar> (&ranges)[4],
                   const TableRequirements<Scalar>& requirements, TableWriter* writer)
      : model_(model),
        bound_{requirements.force_bound, requirements.moment_bound},
        tolerance_{requirements.position_tolerance, requirements.orientation_tolerance},
        bounds_(model_bounds(model, bound_)),
        writer_(*writer) {
    const Vector3<Scalar> axis = model.joints[0].origin.rotation * model.joints[0].axis;
    for (Eigen::Index i = 0; i < 3; ++i) {
      writer_.header().first_axis[i] = static_cast<float>(axis[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      writer_.header().fixed_angle[i + 1] = static_cast<float>(ranges[i].lower);
      if (ranges[i].upper > ranges[i].lower) {
        writer_.header().grid_joint[axes_] = static_cast<std::uint32_t>(i + 1);
        writer_.header().grid_lower[axes_] = static_cast<float>(ranges[i].lower);
        range_[axes_++] = ranges[i].upper - ranges[i].lower;
      }
    }
    writer_.header().grid_axes = static_cast<std::uint32_t>(axes_);
  }

  Result build() {
    const TableError<Scalar> curvature = box_curvature(bounds_);
    const TableError<Scalar>& rounding = bounds_.rounding;
    if (rounding.position >= tolerance_.position ||
        rounding.orientation >= tolerance_.orientation) {
      return Result::tolerance_not_met;
    }
    // First guess: the step at which the bound itself, a few times too cautious, meets a tolerance
    // eight times the one asked for.
    const Scalar most = std::min(tolerance_.position / curvature.position,
                                 tolerance_.orientation / curvature.orientation);
    Scalar step = Scalar(8) * std::sqrt(most / static_cast<Scalar>(axes_));
    for (;;) {
      if (!set_steps(step)) {
        return Result::tolerance_not_met;
      }
      std::uint64_t nodes = 1;
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        nodes *= nodes_[axis];
      }
      if (!writer_.fits(nodes)) {
        return Result::buffer_too_small;
      }
      fill();
      writer_.finish(static_cast<std::uint32_t>(nodes), TableError<Scalar>{});
      TableError<Scalar> error;
      if (check(curvature, &error)) {
        writer_.finish(static_cast<std::uint32_t>(nodes), error);
        return Result::ok;
      }
      step *= Scalar(0.8);
    }
  }

 private:
  bool set_steps(Scalar step) {
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const Scalar cells = std::ceil(range_[axis] / step);
      if (!(cells < Scalar(kMostNodes))) {
        return false;
      }
      nodes_[axis] = static_cast<std::uint32_t>(std::max(cells, Scalar(1))) + 1;
      writer_.header().grid_nodes[axis] = nodes_[axis];
      writer_.header().grid_step[axis] =
          static_cast<float>(range_[axis] / static_cast<Scalar>(nodes_[axis] - 1));
    }
    return true;
  }

  JointVector<Scalar, Joints> angles(const std::array<Scalar, kMaxGridAxes>& place) const {
    JointVector<Scalar, Joints> q = JointVector<Scalar, Joints>::Zero();
    for (std::size_t joint = 1; joint + 1 < Joints; ++joint) {
      q[static_cast<Eigen::Index>(joint)] =
          static_cast<Scalar>(writer_.header().fixed_angle[joint]);
    }
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      q[static_cast<Eigen::Index>(writer_.header().grid_joint[axis])] =
          static_cast<Scalar>(writer_.header().grid_lower[axis]) +
          place[axis] * static_cast<Scalar>(writer_.header().grid_step[axis]);
    }
    return q;
  }

  void fill() const {
    LatticeCounter counter(nodes_, axes_);
    std::uint32_t node = 0;
    do {
      std::array<Scalar, kMaxGridAxes> place{};
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        place[axis] = static_cast<Scalar>(counter[axis]);
      }
      pack(exact_entry(model_, angles(place)), writer_.layout(), writer_.record(node++));
    } while (counter.advance());
  }

  /// Checks a lattice finer than the grid, so fine that the curvature between its points matters
  /// little.
  bool check(const TableError<Scalar>& curvature, TableError<Scalar>* worst) const {
    Table table;
    if (Table::open(&writer_.header(), writer_.header().size, &table) != Result::ok) {
      return false;
    }
    Scalar squares = 0;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const auto step = static_cast<Scalar>(writer_.header().grid_step[axis]);
      squares += step * step / Scalar(8);
    }
    const Scalar excess = std::max(squares * curvature.position / tolerance_.position,
                                   squares * curvature.orientation / tolerance_.orientation);
    const auto divisions = static_cast<std::uint32_t>(
        std::max(Scalar(2), std::ceil(std::sqrt(excess / Scalar(kCurvatureShare)))));
    const Scalar between = squares / static_cast<Scalar>(divisions * divisions);

    std::array<std::uint32_t, kMaxGridAxes> points{};
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      points[axis] = (nodes_[axis] - 1) * divisions + 1;
    }
    LatticeCounter counter(points, axes_);
    do {
      std::array<Scalar, kMaxGridAxes> place{};
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        place[axis] = static_cast<Scalar>(counter[axis]) / static_cast<Scalar>(divisions);
      }
      const JointVector<Scalar, Joints> q = angles(place);
      TableError<Scalar> error = entry_error(model_, exact_entry(model_, q),
                                             look_up_grid<Scalar, Joints>(table, q), bound_);
      error.position += between * curvature.position + bounds_.rounding.position;
      error.orientation += between * curvature.orientation + bounds_.rounding.orientation;
      if (!(error.position <= tolerance_.position && error.orientation <= tolerance_.orientation)) {
        return false;
      }
      *worst = larger(*worst, error);
    } while (counter.advance());
    return true;
  }

  const RobotModel<Scalar, Joints>& model_;
  WrenchBound<Scalar> bound_;
  TableError<Scalar> tolerance_;
  ModelBounds<Scalar, Joints> bounds_;
  TableWriter& writer_;
  std::size_t axes_ = 0;
  std::array<Scalar, kMaxGridAxes> range_{};
  std::array<std::uint32_t, kMaxGridAxes> nodes_{};
};

template <typename Scalar>
bool are_valid(const GridRange<Scalar> (&ranges)[4]) {
  bool any = false;
  for (const GridRange<Scalar>& range : ranges) {
    if (!std::isfinite(range.lower) || !std::isfinite(range.upper) || range.upper < range.lower) {
      return false;
    }
    any = any || range.upper > range.lower;
  }
  return any;
}

}  // namespace

template <typename Scalar, int Joints>
Result build_grid_table(const RobotModel<Scalar, Joints>& model,
                        const GridRange<Scalar> (&ranges)[4],
                        const TableRequirements<Scalar>& requirements, void* buffer,
                        std::size_t capacity, std::size_t* size) {
  const Result checked = check_build_arguments(model, requirements, buffer, capacity, size);
  if (checked != Result::ok) {
    return checked;
  }
  if (!are_valid(ranges)) {
    return Result::bad_argument;
  }
  if (!is_invariant(model)) {
    return Result::chart_not_invariant;
  }
  TableWriter writer(model, requirements, Chart::joint_grid, buffer, capacity);
  const Result built =
      GridTableBuilder<Scalar, Joints>(model, ranges, requirements, &writer).build();
  if (built == Result::ok) {
    *size = writer.header().size;
  }
  return built;
}

#define FLEXCOMP_GRID_TABLE(Scalar, Joints)                             \
  template Result build_grid_table(                                     \
      const RobotModel<Scalar, Joints>&, const GridRange<Scalar>(&)[4], \
      const TableRequirements<Scalar>&, void*, std::size_t, std::size_t*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_GRID_TABLE)

}  // namespace flexcomp
