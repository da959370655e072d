#include "check/registration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "statistics/median.hpp"

namespace flexcomp::check {

Points Registration::of(const Points& from) const {
  return (scale * from * rotation.transpose()).rowwise() + translation.transpose();
}

Registration register_points(const Points& from, const Points& to, bool mirrored, bool scaled) {
  const Eigen::RowVector3d from_middle = from.colwise().mean();
  const Eigen::RowVector3d to_middle = to.colwise().mean();
  const Points centred = from.rowwise() - from_middle;
  const Matrix3<double> covariance = (to.rowwise() - to_middle).transpose() * centred;
  const Eigen::JacobiSVD<Matrix3<double>> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3<double> sign = Vector3<double>::Ones();
  const bool is_improper = svd.matrixU().determinant() * svd.matrixV().determinant() < 0;
  sign[2] = is_improper == mirrored ? 1 : -1;
  Registration found;
  found.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double power = centred.squaredNorm();
  if (scaled && power > 0) {
    found.scale = svd.singularValues().dot(sign) / power;
  }
  found.translation =
      to_middle.transpose() - found.scale * found.rotation * from_middle.transpose();
  return found;
}

Vector3<double> extents(const Points& points) {
  const Points centred = points.rowwise() - points.colwise().mean();
  const Matrix3<double> scatter =
      centred.transpose() * centred / static_cast<double>(std::max<Eigen::Index>(points.rows(), 1));
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> solved(scatter);
  return solved.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
}

double median_distance(const Points& a, const Points& b) {
  const Eigen::VectorXd distance = (a - b).rowwise().norm();
  return statistics::median({distance.begin(), distance.end()});
}

double angle_of(const Matrix3<double>& rotation) {
  return std::acos(std::clamp((rotation.trace() - 1) / 2, -1.0, 1.0));
}

}  // namespace flexcomp::check
