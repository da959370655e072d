#include "grid_chart.hpp"

#include <array>
#include <cmath>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// One axis of a grid: the node below, the fraction to the next, and how far outside `q` is.
template <typename Scalar>
struct GridPlace {
  std::uint32_t node;
  Scalar t;
  Scalar outside;
};

template <typename Scalar>
GridPlace<Scalar> place_on_axis(const Table& table, std::size_t axis, Scalar angle) {
  const TableHeader& header = table.header();
  const std::uint32_t nodes = table.shape().grid_nodes[axis];
  const auto last = static_cast<Scalar>(nodes - 1);
  const Scalar step = static_cast<Scalar>(header.grid_step[axis]);
  const Scalar place = (angle - static_cast<Scalar>(header.grid_lower[axis])) / step;
  if (!(place > Scalar(0))) {
    return {0, Scalar(0), -place * step};
  }
  if (place >= last) {
    return {nodes - 2, Scalar(1), (place - last) * step};
  }
  const auto node = static_cast<std::uint32_t>(place);
  return {node, place - static_cast<Scalar>(node), Scalar(0)};
}

}  // namespace

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_grid(const Table& table, const JointVector<Scalar, Joints>& q) {
  const TableHeader& header = table.header();
  const TableShape& shape = table.shape();
  const RecordLayout layout = record_layout(table);
  std::array<GridPlace<Scalar>, kMaxGridAxes> places;
  std::array<bool, Joints> is_axis{};
  Scalar outside = 0;
  for (std::size_t axis = 0; axis < shape.grid_axes; ++axis) {
    const std::uint32_t joint = shape.grid_joint[axis];
    places[axis] = place_on_axis<Scalar>(table, axis, q[static_cast<Eigen::Index>(joint)]);
    is_axis[joint] = true;
    outside = places[axis].outside > outside ? places[axis].outside : outside;
  }
  for (std::size_t joint = 1; joint + 1 < Joints; ++joint) {
    const Scalar off = std::abs(q[static_cast<Eigen::Index>(joint)] -
                                static_cast<Scalar>(header.fixed_angle[joint]));
    outside = !is_axis[joint] && off > outside ? off : outside;
  }

  std::array<Scalar, kMaxRecordSize> blend{};
  const std::uint32_t corners = 1U << shape.grid_axes;
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    Scalar weight = 1;
    std::uint32_t node = 0;
    for (std::size_t axis = 0; axis < shape.grid_axes; ++axis) {
      const bool upper = ((corner >> axis) & 1U) != 0;
      weight *= upper ? places[axis].t : Scalar(1) - places[axis].t;
      node = node * shape.grid_nodes[axis] + places[axis].node + (upper ? 1U : 0U);
    }
    const float* record = table.record(node);
    for (std::uint32_t i = 0; i < layout.size; ++i) {
      blend[i] += weight * static_cast<Scalar>(record[i]);
    }
  }
  TableEntry<Scalar, Joints> entry = unpack<Scalar, Joints>(blend.data(), layout);

  const Vector3<Scalar> axis(static_cast<Scalar>(header.first_axis[0]),
                             static_cast<Scalar>(header.first_axis[1]),
                             static_cast<Scalar>(header.first_axis[2]));
  const Matrix3<Scalar> turn = axis_rotation<Scalar>(axis, q[0]);
  for (Eigen::Index joint = 0; joint < Joints; ++joint) {
    const Vector3<Scalar> linear = entry.jacobian.col(joint).template head<3>();
    const Vector3<Scalar> angular = entry.jacobian.col(joint).template tail<3>();
    entry.jacobian.col(joint) << turn * linear, turn * angular;
  }
  entry.outside = outside;
  return entry;
}

#define FLEXCOMP_GRID_CHART(Scalar, Joints)                      \
  template TableEntry<Scalar, Joints> look_up_grid(const Table&, \
                                                   const JointVector<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE(FLEXCOMP_GRID_CHART)

}  // namespace flexcomp
