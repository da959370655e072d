#include "control/periodic_path.hpp"

#include <cmath>
#include <stdexcept>

namespace flexcomp::control {
namespace {

constexpr double kTurn = 6.28318530717958647692;

}  // namespace

PeriodicPath::PeriodicPath(const Eigen::MatrixXd& samples, int harmonics)
    : cosine_(Eigen::MatrixXd::Zero(samples.cols(), harmonics + 1)),
      sine_(Eigen::MatrixXd::Zero(samples.cols(), harmonics + 1)) {
  const Eigen::Index rows = samples.rows();
  if (rows <= 2 * harmonics) {
    throw std::invalid_argument("too few samples of a periodic path for its harmonics");
  }
  for (Eigen::Index h = 0; h <= harmonics; ++h) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double angle = kTurn * static_cast<double>(h * i) / static_cast<double>(rows);
      cosine_.col(h) += std::cos(angle) * samples.row(i).transpose();
      sine_.col(h) += std::sin(angle) * samples.row(i).transpose();
    }
  }
  cosine_ *= 2 / static_cast<double>(rows);
  sine_ *= 2 / static_cast<double>(rows);
  cosine_.col(0) /= 2;
}

PeriodicPath::Sample PeriodicPath::at(double turns) const {
  Sample sample{cosine_.col(0), Eigen::VectorXd::Zero(cosine_.rows()),
                Eigen::VectorXd::Zero(cosine_.rows())};
  for (Eigen::Index h = 1; h < cosine_.cols(); ++h) {
    const double frequency = kTurn * static_cast<double>(h);
    const double c = std::cos(frequency * turns);
    const double s = std::sin(frequency * turns);
    const Eigen::VectorXd swing = c * cosine_.col(h) + s * sine_.col(h);
    sample.value += swing;
    sample.slope += frequency * (c * sine_.col(h) - s * cosine_.col(h));
    sample.curvature -= frequency * frequency * swing;
  }
  return sample;
}

}  // namespace flexcomp::control
