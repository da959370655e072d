#include "planning/way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

OnWay Way::on_piece(std::size_t piece, double least_share, const Vector3<double>& point) const {
  const Vector3<double> along = points_[piece + 1] - points_[piece];
  const double length = along.squaredNorm();
  const double share =
      length > 0 ? std::clamp(along.dot(point - points_[piece]) / length, least_share, 1.0)
                 : least_share;
  return {piece, share, (points_[piece] + share * along - point).norm(), 0};
}

OnWay Way::next(const OnWay& from, double step, double room, const Vector3<double>& point) const {
  constexpr double kAhead = 0.1;  // of what is beside the way
  const auto cost = [&](const OnWay& at) {
    return std::hypot(at.off, kAhead * (at.passed - step));
  };
  OnWay best;
  double least = std::numeric_limits<double>::infinity();
  double passed = 0;  // up to the piece
  for (std::size_t piece = from.piece; piece < pieces() && passed <= step + room; ++piece) {
    const double share = piece == from.piece ? from.share : 0;
    const double length = (points_[piece + 1] - points_[piece]).norm();
    OnWay at = on_piece(piece, share, point);
    at.passed = passed + (at.share - share) * length;
    if (cost(at) < least) {
      best = at;
      least = cost(at);
    }
    passed += (1 - share) * length;
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
  OnWay at;
  double squares = 0;
  for (Eigen::Index row = 0; row < places.rows(); ++row) {
    const double step = row > 0 ? (places.row(row) - places.row(row - 1)).norm() : 0;
    at = way.next(at, step, room, places.row(row).transpose());
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
