#include "planning/wrench_along.hpp"

#include <fmt/format.h>

#include "error.hpp"
#include "planning/way.hpp"

namespace flexcomp::planning {

recording::Samples wrench_along(const RobotModel<double, 6>& model, const recording::Samples& q,
                                const recording::Recording& other, double farthest) {
  const recording::Samples& other_q = recording::require(other, other.q_cmd, "q_cmd_1..q_cmd_6");
  const recording::Samples& wrench = recording::require(other, other.wrench, "fx..mz");
  if (other_q.rows() < 2) {
    throw InputError(fmt::format("{}: a path needs two rows or more", other.file));
  }
  const Way way(places_of(model, other_q));
  const std::vector<Vector3<double>> places = places_of(model, q);
  recording::Samples found(q.rows(), 6);
  OnWay at;
  for (std::size_t row = 0; row < places.size(); ++row) {
    const double step = row > 0 ? (places[row] - places[row - 1]).norm() : 0;
    at = way.next(at, step, farthest, places[row]);
    if (!(at.off <= farthest)) {
      throw InputError(
          fmt::format("{}: goes another way: {:.4g} mm away from point {} of the program",
                      other.file, 1e3 * at.off, row + 1));
    }
    const auto before = static_cast<Eigen::Index>(at.piece);
    found.row(static_cast<Eigen::Index>(row)) =
        (1 - at.share) * wrench.row(before) + at.share * wrench.row(before + 1);
  }
  return found;
}

}  // namespace flexcomp::planning
