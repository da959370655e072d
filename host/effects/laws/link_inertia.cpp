#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kLeastShare = 1e-6;   // of the largest second moment: below it a body is flat
constexpr double kLeastMoment = 1e-3;  // kg·m²: a model's link may have none

/// Second moments of a body's density about its centre of mass, kg·m²: positive definite where the
/// body can be (Wensing, Kim and Slotine 2018).
Eigen::SelfAdjointEigenSolver<Matrix3<double>> second_moments(const Matrix3<double>& inertia) {
  return Eigen::SelfAdjointEigenSolver<Matrix3<double>>(
      0.5 * inertia.trace() * Matrix3<double>::Identity() - inertia);
}

/// The negative part of the second moments, further than that of the model's own link: the six
/// numbers of a symmetric matrix, each as often as it stands there. Unlike the least eigenvalue
/// they change smoothly where two eigenvalues meet.
Eigen::VectorXd negative_moments(const model::Robot& model, const model::Robot& altered,
                                 const MachineSize& /*size*/, int joint, double margin) {
  const auto known = second_moments(model.link_inertia[index_of(joint)]);
  const auto now = second_moments(altered.link_inertia[index_of(joint)]);
  const double flat = kLeastShare * now.eigenvalues()[2];
  const double least = std::min(known.eigenvalues()[0] + kLeastShare * known.eigenvalues()[2], 0.0);
  const double size = std::max(known.eigenvalues()[2], kLeastMoment);
  const Vector3<double> excess =
      (((least - flat) - now.eigenvalues().array()) / size + margin).max(0.0);
  const Matrix3<double> negative =
      now.eigenvectors() * excess.asDiagonal() * now.eigenvectors().transpose();
  Eigen::VectorXd numbers(6);
  numbers << negative.diagonal(),
      std::sqrt(2.0) * Vector3<double>(negative(0, 1), negative(0, 2), negative(1, 2));
  return numbers;
}

Range within_size(const Subject& of) {
  const double length = std::max(0.3 * of.size.reach, of.joint().center_of_mass.norm());
  return within(std::max(of.joint().mass, 0.1) * length * length);
}

}  // namespace

// Inertia of the link that a joint moves, about the joint's origin, in the link's frame (rigid-body
// dynamics).
Forms laws::link_inertia() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 6;
  law.traits.is_in_family = true;
  law.traits.is_body = true;
  law.traits.tells_inertia = true;
  law.excess = negative_moments;
  law.no_body = "a link whose density is negative somewhere cannot be";
  law.parameters = constant({{"ixx", "kg·m^2"},
                             {"iyy", "kg·m^2"},
                             {"izz", "kg·m^2"},
                             {"ixy", "kg·m^2"},
                             {"ixz", "kg·m^2"},
                             {"iyz", "kg·m^2"}});
  law.statement = says("the inertia of the link that joint {} moves is another");
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        Matrix3<double> change;
        change << values[0], values[3], values[4],  //
            values[3], values[1], values[5],        //
            values[4], values[5], values[2];
        robot->link_inertia[index_of(joint)] += change;
      },
      &law);
  return {{law},
          {},
          {{"", " ixx iyy izz ixy ixz iyz ", within_size,
            "the link's own mass at a third of the arm's reach: no link is spread wider"}}};
}

}  // namespace flexcomp::effects
