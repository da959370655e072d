#include "grid_certificate.hpp"

#include <algorithm>
#include <cmath>

#include "grid_chart.hpp"
#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// Most points of the lattice along a step of the grid: more is no grid that a builder would make.
constexpr double kMostDivisions = 256;

}  // namespace

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

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> grid_angles(const TableHeader& header,
                                        const std::array<Scalar, kMaxGridAxes>& place) {
  JointVector<Scalar, Joints> q = JointVector<Scalar, Joints>::Zero();
  for (std::size_t joint = 1; joint + 1 < Joints; ++joint) {
    q[static_cast<Eigen::Index>(joint)] = static_cast<Scalar>(header.fixed_angle[joint]);
  }
  for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
    q[static_cast<Eigen::Index>(header.grid_joint[axis])] =
        static_cast<Scalar>(header.grid_lower[axis]) +
        place[axis] * static_cast<Scalar>(header.grid_step[axis]);
  }
  return q;
}

template <typename Scalar, int Joints>
bool check_grid(const RobotModel<Scalar, Joints>& model, const Table& table,
                const TableError<Scalar>& tolerance, Scalar share, TableError<Scalar>* worst) {
  const TableHeader& header = table.header();
  const WrenchBound<Scalar> bound{static_cast<Scalar>(header.force_bound),
                                  static_cast<Scalar>(header.moment_bound)};
  const ModelBounds<Scalar, Joints> bounds = model_bounds(model, bound);
  const TableError<Scalar> curvature = box_curvature(bounds);
  Scalar squares = 0;
  for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
    const auto step = static_cast<Scalar>(header.grid_step[axis]);
    squares += step * step / Scalar(8);
  }
  const Scalar excess = std::max(squares * curvature.position / tolerance.position,
                                 squares * curvature.orientation / tolerance.orientation);
  const Scalar wanted = std::max(Scalar(2), std::ceil(std::sqrt(excess / share)));
  if (!(wanted <= Scalar(kMostDivisions))) {
    return false;
  }
  const auto divisions = static_cast<std::uint32_t>(wanted);
  const Scalar between = squares / static_cast<Scalar>(divisions * divisions);

  std::array<std::uint32_t, kMaxGridAxes> points{};
  for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
    points[axis] = (header.grid_nodes[axis] - 1) * divisions + 1;
  }
  LatticeCounter counter(points, header.grid_axes);
  do {
    std::array<Scalar, kMaxGridAxes> place{};
    for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
      place[axis] = static_cast<Scalar>(counter[axis]) / static_cast<Scalar>(divisions);
    }
    const JointVector<Scalar, Joints> q = grid_angles<Scalar, Joints>(header, place);
    TableError<Scalar> error =
        entry_error(model, exact_entry(model, q), look_up_grid<Scalar, Joints>(table, q), bound);
    error.position += between * curvature.position + bounds.rounding.position;
    error.orientation += between * curvature.orientation + bounds.rounding.orientation;
    *worst = larger(*worst, error);
    if (!(error.position <= tolerance.position && error.orientation <= tolerance.orientation)) {
      return false;
    }
  } while (counter.advance());
  return true;
}

#define FLEXCOMP_GRID_CERTIFICATE(Scalar, Joints)                                            \
  template bool is_invariant(const RobotModel<Scalar, Joints>&);                             \
  template JointVector<Scalar, Joints> grid_angles(const TableHeader&,                       \
                                                   const std::array<Scalar, kMaxGridAxes>&); \
  template bool check_grid(const RobotModel<Scalar, Joints>&, const Table&,                  \
                           const TableError<Scalar>&, Scalar, TableError<Scalar>*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_GRID_CERTIFICATE)

}  // namespace flexcomp
