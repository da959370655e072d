#include "diagnosis/jump.hpp"

#include <Eigen/QR>
#include <limits>

#include "linear_algebra/span.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kMoments = 40;      // of a recording at which a jump is tried: it tells one well
constexpr double kAtOnce = 1e-6;  // s: time constant of what has grown whole in every row

/// The moment (s) in a recording at a share of its length.
double moment_of(const Scene& scene, double share) {
  return scene.time[0] + share * (scene.time[scene.rows() - 1] - scene.time[0]);
}

/// One in each sample to fit to that is after the moment at a share of its recording, else zero.
Eigen::VectorXd after(const Observations& observations, double share) {
  Eigen::VectorXd is_after(observations.train);
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const Scene& scene = observations.scenes[at.scene];
    is_after[i] = scene.time[at.row] >= moment_of(scene, share) ? 1 : 0;
  }
  return is_after;
}

/// The best jump along columns (samples to fit to × directions), beside a fit.
Jump best_jump(const Observations& observations, const Fit& beside, const Eigen::MatrixXd& whole) {
  const Eigen::Index n = observations.train;
  const Eigen::MatrixXd basis = linear_algebra::orthonormal_basis(beside.derivative.topRows(n));
  const Eigen::VectorXd remainder = clipped(beside.remainder.head(n));
  const Eigen::VectorXd left = remainder - basis * (basis.transpose() * remainder);
  Jump best{0, std::numeric_limits<double>::infinity(), static_cast<std::size_t>(whole.cols()) + 1};
  for (int moment = 1; moment < kMoments; ++moment) {
    const double share = static_cast<double>(moment) / kMoments;
    Eigen::MatrixXd columns = after(observations, share).asDiagonal() * whole;
    columns -= basis * (basis.transpose() * columns).eval();
    const Eigen::VectorXd size = columns.colPivHouseholderQr().solve(left);
    const double sum = (left - columns * size).squaredNorm();
    if (sum < best.left) {
      best.time = moment_of(observations.scenes.front(), share);
      best.left = sum;
    }
  }
  return best;
}

}  // namespace

Jump jump_of_place(const Observations& observations, const Fit& beside) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(observations.train, 3);
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.channel == simulation::tcp_position) {
      whole(i, at.component) = 1 / observations.noise[i];
    }
  }
  return best_jump(observations, beside, whole);
}

bool jumps_instead(const Observations& observations, const Fit& without, const Fit& with) {
  const Hypothesis& gradual = with.chosen.back().hypothesis;
  if (!gradual.traits().is_gradual) {
    return false;
  }
  const Eigen::Index n = observations.train;
  const std::size_t others = gradual.parameters.size() - gradual.linear;
  const Eigen::MatrixXd whole =
      Changes(observations).columns(gradual, Values(others, kAtOnce)).topRows(n);
  return best_jump(observations, without, whole).left <
         clipped(with.remainder.head(n)).squaredNorm();
}

}  // namespace flexcomp::diagnosis
