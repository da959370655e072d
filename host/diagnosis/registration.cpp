#include "diagnosis/registration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "diagnosis/evidence.hpp"
#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kFarShift = 5e-3;  // m: a search that is linear in a frame is off by its square
constexpr double kFarTurn = 5e-3;   // rad, the same
constexpr double kMostLeft = 0.25;  // of the squares: a frame that leaves more is not the cause
constexpr int kReweightings = 10;   // of weights, which settle where outliers are few
constexpr int kFrameSteps = 20;     // of the fit by simulation, from a coarse start

/// Measured and predicted positions, 3 × n, rows to fit to that have all three.
struct Points {
  Eigen::Matrix3Xd measured, predicted;
};

Points points_of(const Observations& observations) {
  std::vector<Eigen::Vector3d> measured;
  std::vector<Eigen::Vector3d> predicted;
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.channel != simulation::tcp_position || at.component != 0) {
      continue;
    }
    const Eigen::Vector3d seen =
        observations.scenes[at.scene].measured[at.channel].row(at.row).transpose();
    if (seen.allFinite()) {
      measured.push_back(seen);
      predicted.emplace_back(
          observations.predictions[at.scene].channel[at.channel].row(at.row).transpose());
    }
  }
  Points points;
  points.measured.resize(3, static_cast<Eigen::Index>(measured.size()));
  points.predicted.resize(3, points.measured.cols());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    points.measured.col(static_cast<Eigen::Index>(i)) = measured[i];
    points.predicted.col(static_cast<Eigen::Index>(i)) = predicted[i];
  }
  return points;
}

/// The proper rigid motion that brings weighted predicted points nearest to the measured ones.
Eigen::Isometry3d nearest(const Points& points, const Eigen::VectorXd& weight) {
  const double sum = weight.sum();
  const Eigen::Vector3d from = points.predicted * weight / sum;
  const Eigen::Vector3d to = points.measured * weight / sum;
  const Eigen::Matrix3d product = (points.measured.colwise() - to) * weight.asDiagonal() *
                                  (points.predicted.colwise() - from).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  motion.translation() = to - motion.linear() * from;
  return motion;
}

Eigen::Isometry3d registered(const Points& points) {
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(points.measured.cols());
  Eigen::Isometry3d motion = nearest(points, weight);
  for (int round = 0; round < kReweightings; ++round) {
    const Eigen::VectorXd distance =
        (points.measured - motion * points.predicted).colwise().norm().transpose();
    const double spread = std::sqrt(weight.dot(distance.cwiseAbs2()) / weight.sum());
    weight = huber_weights(distance, spread);
    motion = nearest(points, weight);
  }
  return motion;
}

/// The hypothesis that places a part of the instrument; null where none is sought.
const Hypothesis* find(const std::vector<Hypothesis>& hypotheses, effects::Registers part) {
  const auto at = std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& each) {
    return each.traits().registers == part;
  });
  return at == hypotheses.end() ? nullptr : &*at;
}

/// The frame that a motion is of, sought within whatever an instrument can be.
Chosen frame_of(const Observations& observations, Hypothesis hypothesis,
                const Eigen::Isometry3d& motion) {
  const MachineSize size = size_of(observations);
  for (Parameter& parameter : hypothesis.parameters) {
    const Range range = plausible_range(*hypothesis.law, observations.machine.robot, size,
                                        hypothesis.joint, parameter.name);
    parameter.lower = range.lower;
    parameter.upper = range.upper;
  }
  const Eigen::AngleAxisd turn(motion.linear());
  const Eigen::Vector3d axis = turn.angle() * turn.axis();
  const Eigen::Vector3d shift = motion.translation();
  return {std::move(hypothesis), {shift[0], shift[1], shift[2], axis[0], axis[1], axis[2]}};
}

bool is_far(const Values& values) {
  const Eigen::Map<const Eigen::VectorXd> all(values.data(),
                                              static_cast<Eigen::Index>(values.size()));
  return all.head<3>().norm() > kFarShift || (all.size() > 3 && all.tail<3>().norm() > kFarTurn);
}

}  // namespace

Fit register_frame(const Observations& observations, const std::vector<Hypothesis>& hypotheses) {
  Fit none = fit(observations, {}, 0);
  const Hypothesis* frame = find(hypotheses, effects::Registers::frame);
  if (frame == nullptr || !observations.spans_workspace()) {
    return none;
  }
  const Chosen coarse = frame_of(observations, *frame, registered(points_of(observations)));
  if (!is_far(coarse.values)) {
    return none;
  }
  Fit best = fit(observations, {coarse}, kFrameSteps);
  const Hypothesis* tool = find(hypotheses, effects::Registers::point);
  if (tool != nullptr) {
    Fit both = fit(observations, {best.chosen.front(), {*tool, Values(3, 0.0)}}, kFrameSteps);
    if (is_far(both.chosen.back().values) && bic_gain(observations, best, both) > kStrongEvidence) {
      best = std::move(both);
    }
  }
  return best.train_sum < kMostLeft * none.train_sum ? best : none;
}

}  // namespace flexcomp::diagnosis
