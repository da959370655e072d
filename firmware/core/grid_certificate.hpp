#pragma once

#include <array>

#include "table_certificate.hpp"

namespace flexcomp {

/// Does turning joints 1 and 6 leave the compliance as it is, but for the rotation about axis 1?
///
/// Tried at postures that have nothing in common; what varies with the angle would show at these.
template <typename Scalar, int Joints>
bool is_invariant(const RobotModel<Scalar, Joints>& model);

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

/// Joint angles at a place of a grid, given in steps along each axis; joints 1 and 6 stand at zero.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> grid_angles(const TableHeader& header,
                                        const std::array<Scalar, kMaxGridAxes>& place);

/// Checks a lattice finer than the grid, so fine that `share` of the tolerance is left for what
/// happens between its points. `worst` grows to the largest error found; false at the first point
/// where it is beyond the tolerance, or if no lattice of a bearable size is fine enough.
template <typename Scalar, int Joints>
bool check_grid(const RobotModel<Scalar, Joints>& model, const Table& table,
                const TableError<Scalar>& tolerance, Scalar share, TableError<Scalar>* worst);

}  // namespace flexcomp
