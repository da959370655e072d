#pragma once

#include "flexcomp/table.hpp"

namespace flexcomp {

/// Floats of the largest record.
constexpr std::uint32_t kMaxRecordSize = 4 * 6 + 1 + 36 + 6 + 21 + 36 + 6 + 6;

/// Where the parts of a node's record stand, in floats.
struct RecordLayout {
  std::uint32_t angles;      ///< path: joint angles of the node, rad
  std::uint32_t switching;   ///< path: unit normal, in joint space, of the plane through the node
                             ///< where one segment hands over to the next; zero where the program
                             ///< turns back on itself
  std::uint32_t normal_in;   ///< path: unit normal of the plane that ends the blend of the segment
                             ///< before the node; the same but at a sharp corner
  std::uint32_t normal_out;  ///< path: and of that which begins the blend of the segment after it
  std::uint32_t width;    ///< path: rad, how far the program strays from the chord to the next node
  std::uint32_t blended;  ///< from here on the record is interpolated
  std::uint32_t jacobian;  ///< column by column
  std::uint32_t weight_torque;
  std::uint32_t structure;         ///< lower triangle, row by row
  std::uint32_t structure_motion;  ///< column by column
  std::uint32_t structure_weight;
  std::uint32_t structure_weight_motion;
  std::uint32_t size;
  bool has_weight;
  bool has_structure;
};

constexpr RecordLayout record_layout(Chart chart, bool weight, bool structure) {
  std::uint32_t next = 0;
  const auto take = [&next](std::uint32_t floats) {
    const std::uint32_t at = next;
    next += floats;
    return at;
  };
  const std::uint32_t path = chart == Chart::path ? 6 : 0;
  RecordLayout layout{};
  layout.angles = take(path);
  layout.switching = take(path);
  layout.normal_in = take(path);
  layout.normal_out = take(path);
  layout.width = take(path > 0 ? 1 : 0);
  layout.blended = next;
  layout.jacobian = take(36);
  layout.weight_torque = take(weight ? 6 : 0);
  layout.structure = take(structure ? 21 : 0);
  layout.structure_motion = take(structure ? 36 : 0);
  layout.structure_weight = take(structure && weight ? 6 : 0);
  layout.structure_weight_motion = take(structure && weight ? 6 : 0);
  layout.size = next;
  layout.has_weight = weight;
  layout.has_structure = structure;
  return layout;
}

inline RecordLayout record_layout(const Table& table) {
  return record_layout(table.chart(), table.has_weight(), table.has_structure());
}

/// Writes the interpolated part of a record.
template <typename Scalar, int Joints>
void pack(const TableEntry<Scalar, Joints>& entry, const RecordLayout& layout, float* record);

/// Reads a whole record's interpolated part, given as numbers of the caller's precision.
template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> unpack(const Scalar* record, const RecordLayout& layout);

/// The entry that a perfect table would return at joint angles `q`, from the model itself.
template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> exact_entry(const RobotModel<Scalar, Joints>& model,
                                       const JointVector<Scalar, Joints>& q);

}  // namespace flexcomp
