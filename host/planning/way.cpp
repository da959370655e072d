#include "planning/way.hpp"

#include <algorithm>
#include <cmath>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

OnWay Way::on_piece(std::size_t piece, const Vector3<double>& point) const {
  const Vector3<double> along = points_[piece + 1] - points_[piece];
  const double length = along.squaredNorm();
  const double share =
      length > 0 ? std::clamp(along.dot(point - points_[piece]) / length, 0.0, 1.0) : 0;
  return {piece, share, (points_[piece] + share * along - point).norm()};
}

OnWay Way::nearest(std::size_t from, double room, const Vector3<double>& point) const {
  OnWay best = on_piece(from, point);
  double passed = 0;
  for (std::size_t piece = from + 1; piece < pieces() && passed <= room; ++piece) {
    const OnWay at = on_piece(piece, point);
    if (at.off < best.off) {
      best = at;
    }
    passed += (points_[piece + 1] - points_[piece]).norm();
  }
  return best;
}

std::vector<Vector3<double>> places_of(const RobotModel<double, 6>& model,
                                       const recording::Samples& q) {
  std::vector<Vector3<double>> places;
  places.reserve(static_cast<std::size_t>(q.rows()));
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    places.push_back(forward_kinematics<double, 6>(model, q.row(row).transpose()).tcp.position);
  }
  return places;
}

ContourError contour_error(const Way& way, const recording::Samples& places, double room) {
  ContourError error;
  std::size_t piece = 0;
  double squares = 0;
  for (Eigen::Index row = 0; row < places.rows(); ++row) {
    const double step = row > 0 ? (places.row(row) - places.row(row - 1)).norm() : 0;
    const OnWay at = way.nearest(piece, 2 * step + room, places.row(row).transpose());
    piece = at.piece;
    squares += at.off * at.off;
    if (at.off > error.largest) {
      error.largest = at.off;
      error.row = static_cast<std::size_t>(row);
    }
  }
  error.mean_square =
      std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(places.rows(), 1)));
  return error;
}

}  // namespace flexcomp::planning
