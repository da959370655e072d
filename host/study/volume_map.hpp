#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/circularity_map.hpp"
#include "study/milled_circle.hpp"

namespace flexcomp::study {

/// Circles all over a box, the tool standing across each, for several directions of the tool.
struct VolumeRequest {
  Vector3<double> lower;  ///< m, base frame; nodes lie `step` apart from here on
  Vector3<double> upper;
  double step = 0.1;
  std::vector<Vector3<double>> tool_axes;  ///< unit, where the TCP's z axis points
  MilledCircle circle;                     ///< its point is the TCP
};

/// Circularity over a box. Work is cut into layers: one height, one direction of the tool.
class VolumeMap {
 public:
  /// Throws InputError for a box or a circle that has no such map, or more than 10⁸ circles.
  VolumeMap(RobotModel<double, 6> model, VolumeRequest request);

  std::size_t layers() const;
  std::size_t circles() const;
  int columns() const { return count_[0]; }  ///< along x
  int rows() const { return count_[1]; }     ///< along y
  int heights() const { return count_[2]; }

  Vector3<double> node(std::size_t layer, std::size_t index) const;
  const Vector3<double>& tool_axis(std::size_t layer) const;

  /// m, row by row (x fastest); NaN where out of reach. The same numbers whoever computes it.
  std::vector<double> layer(std::size_t layer) const;

  /// Tells maps apart: of the robot, the box and the circle.
  std::string fingerprint() const;

 private:
  RobotModel<double, 6> model_;
  VolumeRequest request_;
  std::array<int, 3> count_{};
};

/// The processes that share the work, as mpirun (Open MPI, MPICH) or srun number them; 0 of 1 for
/// one that was started alone.
struct Ranks {
  int rank = 0;
  int size = 1;
};
Ranks ranks_from_environment();

/// Computes layers on all cores and all ranks and keeps each in a file of `folder` as soon as it is
/// there: what was computed before is not computed again, and all ranks must see the same folder.
/// Rank 0 returns all of them, the others nothing. `progress` is told: layers that are there.
std::vector<std::vector<double>> compute_layers(
    const VolumeMap& map, const std::filesystem::path& folder, const Ranks& ranks,
    const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace flexcomp::study
