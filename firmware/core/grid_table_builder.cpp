#include <algorithm>
#include <array>
#include <cmath>

#include "grid_certificate.hpp"
#include "instantiate.hpp"
#include "table_writer.hpp"

namespace flexcomp {
namespace {

/// Share of the tolerance that may go to what happens between the checked points.
constexpr double kCurvatureShare = 0.2;

/// Most nodes along an axis; past it the tolerance is out of reach of a grid.
constexpr std::uint32_t kMostNodes = 4096;

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
      if (check(&error)) {
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

  void fill() const {
    LatticeCounter counter(nodes_, axes_);
    std::uint32_t node = 0;
    do {
      std::array<Scalar, kMaxGridAxes> place{};
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        place[axis] = static_cast<Scalar>(counter[axis]);
      }
      pack(exact_entry(model_, grid_angles<Scalar, Joints>(writer_.header(), place)),
           writer_.layout(), writer_.record(node++));
    } while (counter.advance());
  }

  bool check(TableError<Scalar>* worst) const {
    Table table;
    return Table::open(&writer_.header(), writer_.header().size, &table) == Result::ok &&
           check_grid(model_, table, tolerance_, Scalar(kCurvatureShare), worst);
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
