#include "diagnosis/cues.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace flexcomp::diagnosis {
namespace {

constexpr int kClasses = 12;  // of a course: a bend shows, and each class keeps samples

/// Classes of equal count, so that no class is empty.
Eigen::VectorXi by_rank(const Eigen::VectorXd& value) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(value.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return value[a] < value[b]; });
  Eigen::VectorXi kind(value.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    kind[order[i]] = static_cast<int>(i * kClasses / order.size());
  }
  return kind;
}

Eigen::VectorXi by_direction(const Eigen::VectorXd& speed) {
  Eigen::VectorXi kind(speed.size());
  for (Eigen::Index row = 0; row < speed.size(); ++row) {
    kind[row] = 1 + simulation::direction_of_motion(speed[row]);
  }
  return kind;
}

/// s since the joint's velocity last changed its sign.
Eigen::VectorXd since_reversal(const Eigen::VectorXd& time, const Eigen::VectorXd& speed) {
  Eigen::VectorXd since(time.size());
  double turned = time[0];
  double side = 0;
  for (Eigen::Index row = 0; row < time.size(); ++row) {
    if (simulation::direction_of_motion(speed[row]) != 0 && speed[row] * side <= 0) {
      turned = side == 0 ? turned : time[row];
      side = speed[row];
    }
    since[row] = time[row] - turned;
  }
  return since;
}

/// Angle about the mean position in the plane of the path's two largest extents.
Eigen::VectorXd path_angle(const Simulation& simulation) {
  const auto rows = static_cast<Eigen::Index>(simulation.bent.size());
  Eigen::MatrixXd position(rows, 3);
  for (Eigen::Index row = 0; row < rows; ++row) {
    position.row(row) = simulation.bent[static_cast<std::size_t>(row)].tcp.position.transpose();
  }
  position.rowwise() -= position.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> extents(position.transpose() * position);
  const Eigen::VectorXd first = position * extents.eigenvectors().col(2);
  const Eigen::VectorXd second = position * extents.eigenvectors().col(1);
  Eigen::VectorXd angle(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    angle[row] = std::atan2(second[row], first[row]);
  }
  return angle;
}

}  // namespace

std::vector<Cue> cues_of(const Scene& scene, const Prediction& prediction,
                         const Simulation& simulation) {
  std::vector<Cue> cues;
  const Eigen::MatrixXd& load = shown_load(scene, prediction);
  for (int joint = 1; joint <= scene.joints(); ++joint) {
    const Eigen::Index column = joint - 1;
    const auto add = [&](const char* what, Eigen::VectorXi kind, int classes) {
      cues.push_back({fmt::format("{} joint {}", what, joint), joint, std::move(kind), classes});
    };
    add("angle of", by_rank(scene.q.col(column)), kClasses);
    add("load on", by_rank(load.col(column)), kClasses);
    if (!scene.is_static) {
      add("speed of", by_rank(scene.velocity.col(column)), kClasses);
      add("direction of motion of", by_direction(scene.velocity.col(column)), 3);
      add("time since the reversal of",
          by_rank(since_reversal(scene.time, scene.velocity.col(column))), kClasses);
    }
  }
  cues.push_back({"time", 0, by_rank(scene.time), kClasses});
  if (scene.temperature.size() > 0) {
    cues.push_back({"temperature", 0, by_rank(scene.temperature), kClasses});
  }
  if (!simulation.bent.empty()) {
    cues.push_back({"path angle", 0, by_rank(path_angle(simulation)), kClasses});
  }
  return cues;
}

}  // namespace flexcomp::diagnosis
