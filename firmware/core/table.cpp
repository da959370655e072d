#include "flexcomp/table.hpp"

#include "grid_chart.hpp"
#include "instantiate.hpp"
#include "path_chart.hpp"
#include "table_record.hpp"

namespace flexcomp {

std::uint64_t Table::model_hash() const {
  return (std::uint64_t{header_->model_hash_high} << 32) | header_->model_hash_low;
}

namespace {

bool is_path(const TableHeader& header) {
  return header.chart == static_cast<std::uint32_t>(Chart::path);
}

}  // namespace

GainBasis gain_basis(const TableHeader& header) {
  const float* const at = header.fixed_angle;
  return is_path(header) ? GainBasis{at[0], at[1], at[2], at[3], at[4], at[5]} : GainBasis{};
}

void set_gain_basis(const GainBasis& basis, TableHeader* header) {
  float* const at = header->fixed_angle;
  at[0] = basis.least_push;
  at[1] = basis.most_push;
  at[2] = basis.depth_of_cut;
  at[3] = basis.period;
  at[4] = basis.filter_cutoff;
  at[5] = basis.delay;
}

InsideError inside_error(const TableHeader& header) {
  return is_path(header) ? InsideError{header.grid_lower[0], header.grid_lower[1]} : InsideError{};
}

void set_inside_error(const InsideError& error, TableHeader* header) {
  header->grid_lower[0] = error.position;
  header->grid_lower[1] = error.orientation;
}

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up(const Table& table, const JointVector<Scalar, Joints>& q,
                                   TableCursor* cursor) {
  return table.chart() == Chart::path ? look_up_path<Scalar, Joints>(table, q, cursor)
                                      : look_up_grid<Scalar, Joints>(table, q);
}

template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> respond(const Table& table, const TableEntry<Scalar, Joints>& entry,
                                      const Wrench<Scalar>& wrench) {
  const JointVector<Scalar, Joints> torque =
      wrench_torque<Scalar, Joints>(entry.jacobian, wrench) + entry.weight_torque;
  JointVector<Scalar, Joints> windup;
  for (std::size_t i = 0; i < Joints; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const Scalar t = torque[joint];
    windup[joint] = (static_cast<Scalar>(table.header().compliance[i]) +
                     static_cast<Scalar>(table.header().cubic_compliance[i]) * t * t) *
                    t;
  }
  TableResponse<Scalar, Joints> response;
  response.deflection = entry.jacobian.lazyProduct(windup);
  response.correction = -windup;
  if (table.has_structure()) {
    response.deflection += entry.structure.lazyProduct(wrench) + entry.structure_weight;
    response.correction -=
        entry.structure_motion.lazyProduct(wrench) + entry.structure_weight_motion;
  }
  return response;
}

/// A function of its own, so that path tables need not make room for an entry.
template <typename Scalar, int Joints>
[[gnu::noinline]] static TableResponse<Scalar, Joints> respond_on_grid(
    const Table& table, const JointVector<Scalar, Joints>& q, const Wrench<Scalar>& wrench,
    Scalar* outside) {
  const TableEntry<Scalar, Joints> entry = look_up_grid<Scalar, Joints>(table, q);
  *outside = entry.outside;
  return respond<Scalar, Joints>(table, entry, wrench);
}

template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> look_up_response(const Table& table,
                                               const JointVector<Scalar, Joints>& q,
                                               const Wrench<Scalar>& wrench, TableCursor* cursor,
                                               Scalar* outside) {
  if (table.chart() == Chart::path) {
    return respond_on_path<Scalar, Joints>(table, q, wrench, cursor, outside);
  }
  return respond_on_grid<Scalar, Joints>(table, q, wrench, outside);
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot stand in them
#define FLEXCOMP_TABLE(Scalar, Joints)                                                            \
  template TableEntry<Scalar, Joints> look_up(const Table&, const JointVector<Scalar, Joints>&,   \
                                              TableCursor*);                                      \
  template TableResponse<Scalar, Joints> respond(const Table&, const TableEntry<Scalar, Joints>&, \
                                                 const Wrench<Scalar>&);                          \
  template TableResponse<Scalar, Joints> look_up_response(                                        \
      const Table&, const JointVector<Scalar, Joints>&, const Wrench<Scalar>&, TableCursor*,      \
      Scalar*);
// NOLINTEND(bugprone-macro-parentheses)
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE)

}  // namespace flexcomp
