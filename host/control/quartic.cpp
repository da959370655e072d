#include "control/quartic.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace flexcomp::control {

double positive_root(double p, double r) {
  double root = std::pow(r, 0.25);
  if (p != 0) {
    // The resolvent cubic y³ + 4 r y − p² = 0 splits the quartic into two quadratics.
    const double c = 4 * r / 3;
    const double y = 2 * std::sqrt(c) * std::sinh(std::asinh(0.5 * p * p / std::pow(c, 1.5)) / 3);
    const double a = std::sqrt(y);
    const double t = (y + std::abs(p) / a) / 2;
    const double b = r / t;
    const double s = a + std::sqrt(y + 4 * b);
    root = p > 0 ? 2 * b / s : s / 2;
  }
  for (int i = 0; i < 2; ++i) {
    const double value = ((root * root * root) + p) * root - r;
    const double slope = 4 * root * root * root + p;
    root -= slope > 0 ? value / slope : 0;
  }
  return root;
}

std::vector<double> positive_roots_by_companion(double p, double r) {
  // The largest term is the unit, which keeps the matrix balanced.
  const double unit = std::pow(r, 0.25) + std::cbrt(std::abs(p));
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  companion.diagonal<-1>().setOnes();
  companion(0, 3) = r / std::pow(unit, 4);
  companion(1, 3) = -p / std::pow(unit, 3);
  // It is of Hessenberg's form already. What solves any matrix takes a compiler six seconds longer.
  const double largest = companion.cwiseAbs().maxCoeff();
  Eigen::RealSchur<Eigen::Matrix4d> schur;
  schur.computeFromHessenberg(companion / largest, Eigen::Matrix4d::Identity(), false);
  const Eigen::Matrix4d& triangle = schur.matrixT();
  std::vector<double> roots;
  for (Eigen::Index i = 0; i < 4; ++i) {
    // A pair of complex roots stays coupled.
    const bool is_real = (i == 3 || triangle(i + 1, i) == 0) && (i == 0 || triangle(i, i - 1) == 0);
    if (is_real && triangle(i, i) > 0) {
      roots.push_back(unit * (largest * triangle(i, i)));
    }
  }
  return roots;
}

}  // namespace flexcomp::control
