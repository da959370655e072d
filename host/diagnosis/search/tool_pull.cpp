#include <algorithm>
#include <functional>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kFarthest = 2.2;  // reaches from the base: from farther off it is a constant force
constexpr int kGridSteps = 6;      // of the grid of places, either way

/// Samples as forces on the tool show in them.
struct Forces {
  Eigen::MatrixXd lever;     ///< n×3, sample over noise by a force (N) on the tool, base frame
  Eigen::MatrixXd place;     ///< n×3, of the TCP, m
  Eigen::VectorXd residual;  ///< n, over the noise
  Eigen::VectorXi joint;     ///< n, that shows the sample, from 1 on; 0 where it is the TCP
};

/// How a force of 1 N on the tool along an axis of the base frame shows in all samples.
Eigen::VectorXd shown_along(const Observations& observations, Eigen::Index axis) {
  std::vector<Prediction> changes = observations.predictions;
  for (std::size_t s = 0; s < changes.size(); ++s) {
    for (Eigen::MatrixXd& channel : changes[s].channel) {
      channel.setZero();
    }
    Eigen::MatrixXd wrench = Eigen::MatrixXd::Zero(observations.scenes[s].rows(), 6);
    wrench.col(axis).setOnes();
    add_wrench(observations.simulations[s], wrench, &changes[s]);
  }
  return observations.stacked(changes);
}

/// Of the samples to fit to, evenly taken: a pull is smooth.
Forces forces_of(const Observations& observations, const Eigen::VectorXd& unexplained) {
  constexpr Eigen::Index kMost = 1500;  // more take longer and show no more
  const Eigen::Index step = 1 + observations.train / kMost;
  const Eigen::Index count = (observations.train + step - 1) / step;
  Forces forces{Eigen::MatrixXd(count, 3), Eigen::MatrixXd(count, 3), Eigen::VectorXd(count),
                Eigen::VectorXi(count)};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    forces.lever.col(axis) = shown_along(observations, axis)(Eigen::seqN(0, count, step));
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index index = i * step;
    const Sample& sample = observations.samples[static_cast<std::size_t>(index)];
    const Simulation& simulation = observations.simulations[sample.scene];
    forces.place.row(i) =
        simulation.bent[static_cast<std::size_t>(sample.row)].tcp.position.transpose();
    forces.residual[i] = unexplained[index];
    forces.joint[i] =
        sample.channel == simulation::tcp_position ? 0 : static_cast<int>(sample.component) + 1;
  }
  return forces;
}

/// What a pull toward a place shows in the samples: by its constant part, and by the part that
/// grows with the distance.
Eigen::MatrixXd shown_toward(const Forces& forces, const Vector3<double>& place) {
  const Eigen::MatrixXd toward = (-forces.place).rowwise() + place.transpose();
  const Eigen::ArrayXd growing = forces.lever.cwiseProduct(toward).rowwise().sum().array();
  const Eigen::ArrayXd distance = toward.rowwise().norm().array().max(1e-6);
  Eigen::MatrixXd columns(growing.size(), 2);
  columns << (growing / distance).matrix(), growing.matrix();
  return columns;
}

/// By least squares.
Eigen::Vector2d best_pull(const Forces& forces, const Eigen::MatrixXd& shown) {
  const Eigen::Matrix2d gram = shown.transpose() * shown;
  return gram.ldlt().solve(shown.transpose() * forces.residual);
}

/// The squares that a pull toward a place takes off the residual.
double gain_toward(const Forces& forces, const Vector3<double>& place) {
  const Eigen::MatrixXd shown = shown_toward(forces, place);
  return best_pull(forces, shown).dot(shown.transpose() * forces.residual);
}

/// Do several joints tell of it, or the TCP? What one joint alone shows, such as a balancer's
/// torque, is its own.
bool is_felt_by_several(const Forces& forces, const Vector3<double>& place) {
  constexpr double kLeastOfSecond = 0.1;  // of all that it gains; chosen by judgement
  const Eigen::MatrixXd shown = shown_toward(forces, place);
  const Eigen::VectorXd left = forces.residual - shown * best_pull(forces, shown);
  std::vector<double> gain(static_cast<std::size_t>(forces.joint.maxCoeff()) + 1, 0.0);
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    gain[static_cast<std::size_t>(forces.joint[i])] +=
        forces.residual[i] * forces.residual[i] - left[i] * left[i];
  }
  const double all = forces.residual.squaredNorm() - left.squaredNorm();
  if (gain.front() > kLeastOfSecond * all) {
    return true;
  }
  std::sort(gain.begin(), gain.end(), std::greater<>());
  return gain.size() > 1 && gain[1] > kLeastOfSecond * all;
}

/// Places on a grid about the base, the best first, that lie apart.
std::vector<Values> seek_tool_pull(const Observations& observations,
                                   const Eigen::VectorXd& unexplained,
                                   const Hypothesis& /*hypothesis*/) {
  // Of the squares beyond the noise. A pull has five numbers, which imitate a part of whatever is
  // smooth: up to 0.26 on a KR 300 with its balancer and friction left out, and 0.93 where there
  // was one. Beside others it is found once they are.
  constexpr double kLeastShare = 0.5;
  constexpr std::size_t kMost = 3;  // starts
  const double spacing =
      kFarthest * effects::size_of(observations.machine.robot).reach / kGridSteps;
  const Forces forces = forces_of(observations, unexplained);
  std::vector<std::pair<double, Vector3<double>>> found;
  for (int x = -kGridSteps; x <= kGridSteps; ++x) {
    for (int y = -kGridSteps; y <= kGridSteps; ++y) {
      for (int z = -kGridSteps; z <= kGridSteps; ++z) {
        const Vector3<double> place = spacing * Vector3<double>(x, y, z);
        found.emplace_back(-gain_toward(forces, place), place);
      }
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Values> starts;
  const double beyond_noise =
      forces.residual.squaredNorm() - static_cast<double>(forces.residual.size());
  for (const auto& [loss, place] : found) {
    const Vector3<double>& at = place;
    const bool is_new = std::all_of(starts.begin(), starts.end(), [&](const Values& other) {
      return (Eigen::Map<const Vector3<double>>(other.data()) - at).norm() > 1.5 * spacing;
    });
    if (is_new && starts.size() < kMost && -loss > std::max(kLeastShare * beyond_noise, 0.0) &&
        is_felt_by_several(forces, place)) {
      starts.push_back({at.x(), at.y(), at.z()});
    }
  }
  return starts;
}

/// Needs a TCP that moves about: along a small path any place far off does as well.
bool prepare_tool_pull(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kLeastTravel = 0.2;  // of the reach, in two directions; chosen by judgement
  const double reach = effects::size_of(observations.machine.robot).reach;
  Eigen::AlignedBox3d box;
  for (const Simulation& simulation : observations.simulations) {
    for (const model::ChainKinematics& at : simulation.bent) {
      box.extend(at.tcp.position);
    }
  }
  if (box.isEmpty()) {
    return false;
  }
  Vector3<double> travel = box.sizes();
  std::sort(travel.begin(), travel.end());
  const Bounds place{-3 * reach, 3 * reach, 0.02 * reach};
  const Bounds stiffness{0, 1e5, 1};  // N/m: nothing that hangs pulls less where it is stretched
  hypothesis->set_bounds({{-1e5, 1e5, 1}, stiffness, place, place, place});
  return travel[1] > kLeastTravel * reach;
}

}  // namespace

Search search::tool_pull() { return {prepare_tool_pull, seek_tool_pull}; }

}  // namespace flexcomp::diagnosis
