#include <array>

#include "instantiate.hpp"
#include "path_chart.hpp"
#include "table_certificate.hpp"

namespace flexcomp {

template <typename Scalar, int Joints>
TableError<Scalar> table_error_at(const RobotModel<Scalar, Joints>& model, const Table& table,
                                  const JointVector<Scalar, Joints>& q, TableCursor* cursor) {
  const WrenchBound<Scalar> bound{static_cast<Scalar>(table.header().force_bound),
                                  static_cast<Scalar>(table.header().moment_bound)};
  return entry_error(model, exact_entry(model, q), look_up<Scalar, Joints>(table, q, cursor),
                     bound);
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> chart_angles(const Table& table, const Scalar (&place)[kMaxGridAxes]) {
  const TableHeader& header = table.header();
  JointVector<Scalar, Joints> q;
  if (table.chart() == Chart::path) {
    const RecordLayout layout = record_layout(table);
    const std::uint32_t last = header.node_count - 2;
    const Scalar along = place[0] * static_cast<Scalar>(header.node_count - 1);
    const auto whole = static_cast<std::uint32_t>(along);
    const std::uint32_t segment = whole > last ? last : whole;
    const Scalar t = along - static_cast<Scalar>(segment);
    const float* from = table.record(segment) + layout.angles;
    const float* to = table.record(segment + 1) + layout.angles;
    for (Eigen::Index i = 0; i < Joints; ++i) {
      const auto a = static_cast<Scalar>(from[i]);
      q[i] = a + t * (static_cast<Scalar>(to[i]) - a);
    }
    return q;
  }
  for (Eigen::Index i = 0; i < Joints; ++i) {
    q[i] = static_cast<Scalar>(header.fixed_angle[i]);
  }
  for (std::size_t axis = 0; axis < header.grid_axes; ++axis) {
    q[static_cast<Eigen::Index>(header.grid_joint[axis])] =
        static_cast<Scalar>(header.grid_lower[axis]) +
        place[axis] * static_cast<Scalar>(header.grid_nodes[axis] - 1) *
            static_cast<Scalar>(header.grid_step[axis]);
  }
  return q;
}

#define FLEXCOMP_TABLE_VERIFICATION(Scalar, Joints)                                             \
  template TableError<Scalar> table_error_at(const RobotModel<Scalar, Joints>&, const Table&,   \
                                             const JointVector<Scalar, Joints>&, TableCursor*); \
  template JointVector<Scalar, Joints> chart_angles(const Table&, const Scalar(&)[kMaxGridAxes]);
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE_VERIFICATION)

}  // namespace flexcomp
