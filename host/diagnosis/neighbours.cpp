#include "diagnosis/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace flexcomp::diagnosis {
namespace {

constexpr std::size_t kFewestPoses = 20;  // poses
constexpr std::size_t kMostPoses = 1500;  // poses: the search takes the square of the time
constexpr std::size_t kNeighbours = 4;    // of each
constexpr int kDeals = 200;               // at random: their spread is known to 5 % then

using Rows = std::vector<std::vector<std::size_t>>;  ///< of each pose, its neighbours

/// Poses of load tests: where they are, and what is left there.
struct Poses {
  Eigen::MatrixXd places;      ///< poses × (joints + 6), angles and wrench
  Eigen::MatrixXd remainders;  ///< poses × components; zero where nothing was measured
};

/// Component of a sample among those of all channels.
Eigen::Index column_of(const Sample& at, Eigen::Index joints) {
  return static_cast<Eigen::Index>(at.channel) * std::max<Eigen::Index>(joints, 3) + at.component;
}

Poses poses_of(const Observations& observations, const Eigen::VectorXd& remainder) {
  const Eigen::Index joints = observations.scenes.front().joints();
  std::map<std::pair<std::size_t, Eigen::Index>, Eigen::Index> index;
  for (const Sample& at : observations.samples) {
    index.emplace(std::make_pair(at.scene, at.row), static_cast<Eigen::Index>(index.size()));
  }
  const auto count = static_cast<Eigen::Index>(index.size());
  Poses poses{Eigen::MatrixXd(count, joints + 6),
              Eigen::MatrixXd::Zero(count, 3 * std::max<Eigen::Index>(joints, 3))};
  for (const auto& [place, row] : index) {
    const Scene& scene = observations.scenes[place.first];
    poses.places.row(row) << scene.q.row(place.second), scene.wrench.row(place.second);
  }
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    poses.remainders(index.at({at.scene, at.row}), column_of(at, joints)) = remainder[i];
  }
  return poses;
}

/// Some rows of a matrix, evenly taken.
Eigen::MatrixXd thinned(const Eigen::MatrixXd& all) {
  const auto each = (all.rows() + static_cast<Eigen::Index>(kMostPoses) - 1) /
                    static_cast<Eigen::Index>(kMostPoses);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < all.rows(); row += std::max<Eigen::Index>(each, 1)) {
    rows.push_back(row);
  }
  return all(rows, Eigen::all);
}

/// Columns less their mean, over their spread where they have any.
Eigen::MatrixXd over_spread(Eigen::MatrixXd values) {
  values.rowwise() -= values.colwise().mean().eval();
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    const double spread = values.col(column).norm();
    values.col(column) /= spread > 0 ? spread : 1;
  }
  return values;
}

Rows nearest(const Eigen::MatrixXd& places) {
  const Eigen::MatrixXd by_pose = places.transpose();
  Rows all;
  for (Eigen::Index i = 0; i < by_pose.cols(); ++i) {
    const Eigen::VectorXd distance =
        (by_pose.colwise() - by_pose.col(i)).colwise().squaredNorm().transpose();
    std::vector<std::size_t> order;
    for (Eigen::Index k = 0; k < by_pose.cols(); ++k) {
      if (k != i) {
        order.push_back(static_cast<std::size_t>(k));
      }
    }
    std::partial_sort(
        order.begin(), order.begin() + kNeighbours, order.end(), [&](std::size_t a, std::size_t b) {
          return distance[static_cast<Eigen::Index>(a)] < distance[static_cast<Eigen::Index>(b)];
        });
    order.resize(kNeighbours);
    all.push_back(std::move(order));
  }
  return all;
}

/// Products of what is left at neighbours, where the remainder of pose i is column `dealt[i]`.
double likeness(const Eigen::MatrixXd& by_pose, const Rows& neighbours,
                const std::vector<std::size_t>& dealt) {
  double sum = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const auto own = by_pose.col(static_cast<Eigen::Index>(dealt[i]));
    for (const std::size_t other : neighbours[i]) {
      sum += own.dot(by_pose.col(static_cast<Eigen::Index>(dealt[other])));
    }
  }
  return sum;
}

}  // namespace

double likeness_of_neighbours(const Observations& observations, const Eigen::VectorXd& remainder) {
  const Poses poses = poses_of(observations, remainder);
  const Eigen::MatrixXd places = over_spread(thinned(poses.places));
  const Eigen::MatrixXd by_pose = over_spread(thinned(poses.remainders)).transpose();
  const auto count = static_cast<std::size_t>(by_pose.cols());
  if (count < kFewestPoses) {
    return 0;
  }
  const Rows neighbours = nearest(places);
  std::vector<std::size_t> dealt(count);
  std::iota(dealt.begin(), dealt.end(), std::size_t{0});
  const double found = likeness(by_pose, neighbours, dealt);
  std::mt19937_64 random(1);  // the same answer every time
  double sum = 0;
  double squares = 0;
  for (int deal = 0; deal < kDeals; ++deal) {
    std::shuffle(dealt.begin(), dealt.end(), random);
    const double by_chance = likeness(by_pose, neighbours, dealt);
    sum += by_chance;
    squares += by_chance * by_chance;
  }
  const double mean = sum / kDeals;
  const double variance = (squares - kDeals * mean * mean) / (kDeals - 1);
  return variance > 0 ? (found - mean) / std::sqrt(variance) : 0;
}

}  // namespace flexcomp::diagnosis
