#include "control/arm_uncertainty.hpp"

#include <Eigen/LU>
#include <limits>
#include <random>
#include <stdexcept>

#include "linear_algebra/decompositions.hpp"

namespace flexcomp::control {
namespace {

constexpr int kPostures = 3000;
constexpr double kMargin = 1.1;

template <int Joints>
using Square = Eigen::Matrix<double, Joints, Joints>;

// These take any size, though the sizes are known: a compiler takes seconds for each.

double norm_of(const Eigen::MatrixXd& matrix) { return matrix.jacobiSvd().singularValues()[0]; }

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) { return matrix.inverse(); }

/// Eigenvalues of a symmetric matrix, the least first.
Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// The arm with its masses scaled and another payload.
template <int Joints>
InverseDynamics<double, Joints> dynamics_of(simulation::FlexibleArm<Joints> arm, double links,
                                            double payload) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(Joints); ++i) {
    arm.model.joints[i].mass *= links;
    arm.inertia[i] *= links;
  }
  arm.model.payload_mass = payload;
  InverseDynamics<double, Joints> dynamics;
  if (dynamics.configure(arm.model, arm.inertia) != Result::ok) {
    throw std::invalid_argument("the arm has a number that is not finite or out of its range");
  }
  return dynamics;
}

/// The dynamics at one posture, by columns.
template <int Joints>
class Posture {
 public:
  using Angles = JointVector<double, Joints>;

  Posture(const InverseDynamics<double, Joints>& dynamics, const Angles& q)
      : dynamics_(dynamics), q_(q), weight_(dynamics.torque(q, zero(), zero(), zero())) {}

  const Angles& weight() const { return weight_; }

  Square<Joints> inertia() const {
    Square<Joints> d;
    for (Eigen::Index i = 0; i < Joints; ++i) {
      d.col(i) = dynamics_.torque(q_, zero(), zero(), Angles::Unit(i)) - weight_;
    }
    return d;
  }

  /// Each joint's norm of the bilinear form of its velocity torque.
  Angles velocity_norms() const {
    std::array<Square<Joints>, static_cast<std::size_t>(Joints)> forms;
    for (Eigen::Index k = 0; k < Joints; ++k) {
      for (Eigen::Index l = 0; l < Joints; ++l) {
        const Angles column =
            dynamics_.torque(q_, Angles::Unit(k), Angles::Unit(l), zero()) - weight_;
        for (Eigen::Index j = 0; j < Joints; ++j) {
          forms[static_cast<std::size_t>(j)](k, l) = column[j];
        }
      }
    }
    Angles norms;
    for (Eigen::Index j = 0; j < Joints; ++j) {
      norms[j] = norm_of(forms[static_cast<std::size_t>(j)]);
    }
    return norms;
  }

 private:
  static Angles zero() { return Angles::Zero(); }

  const InverseDynamics<double, Joints>& dynamics_;
  Angles q_;
  Angles weight_;
};

template <int Joints>
void widen(const Posture<Joints>& at, typename ArmExtremes<Joints>::Unit* unit) {
  unit->weight = unit->weight.cwiseMax(kMargin * at.weight().cwiseAbs());
  unit->inertia = unit->inertia.cwiseMax(kMargin * at.inertia().rowwise().norm());
  unit->velocity = unit->velocity.cwiseMax(kMargin * at.velocity_norms());
}

}  // namespace

template <int Joints>
ArmExtremes<Joints> sample_extremes(const simulation::FlexibleArm<Joints>& arm,
                                    const ArmUncertainty& uncertainty,
                                    const JointVector<double, Joints>& weight) {
  using Angles = JointVector<double, Joints>;
  simulation::FlexibleArm<Joints> at_tool = arm;
  at_tool.model.payload_center.setZero();
  const auto nominal = dynamics_of(arm, 1, arm.model.payload_mass);
  const auto links = dynamics_of(arm, 1, 0);
  const auto payload = dynamics_of(arm, 0, 1);
  const auto point = dynamics_of(at_tool, 0, 1);
  const Interval factor = uncertainty.link_mass.support();
  const Interval load = uncertainty.payload.support();
  const auto lightest = dynamics_of(arm, factor.lower, load.lower);
  const auto heaviest = dynamics_of(arm, factor.upper, load.upper);
  const Angles root = weight.cwiseSqrt();

  ArmExtremes<Joints> found;
  found.effective.setConstant(std::numeric_limits<double>::infinity());
  found.least_inertia = std::numeric_limits<double>::infinity();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < kPostures; ++i) {
    Angles q;
    for (Eigen::Index j = 0; j < Joints; ++j) {
      const Joint<double>& joint = arm.model.joints[static_cast<std::size_t>(j)];
      q[j] = joint.lower + uniform(random) * (joint.upper - joint.lower);
    }
    widen(Posture<Joints>(links, q), &found.links);
    widen(Posture<Joints>(payload, q), &found.payload);
    // A point of 1 kg at the TCP: D = JᵀJ with the linear Jacobian J.
    found.lever = found.lever.cwiseMax(
        kMargin * Posture<Joints>(point, q).inertia().diagonal().cwiseMax(0).cwiseSqrt());
    const Square<Joints> mobility = inverse_of(Posture<Joints>(nominal, q).inertia());
    found.effective = found.effective.cwiseMin(mobility.diagonal().cwiseInverse() / kMargin);
    const Square<Joints> light = Posture<Joints>(lightest, q).inertia();
    const Square<Joints> heavy = Posture<Joints>(heaviest, q).inertia();
    found.least_inertia = std::min(found.least_inertia, eigenvalues_of(light)[0] / kMargin);
    found.largest_inertia =
        std::max(found.largest_inertia, kMargin * eigenvalues_of(heavy)[Joints - 1]);
    const Square<Joints> light_mobility = inverse_of(light);
    const Square<Joints> coupled = root.asDiagonal() * light_mobility * root.asDiagonal();
    found.coupling = std::max(found.coupling, kMargin * eigenvalues_of(coupled)[Joints - 1]);
  }
  return found;
}

#define FLEXCOMP_EXTREMES(Joints)                                                      \
  template ArmExtremes<Joints> sample_extremes(const simulation::FlexibleArm<Joints>&, \
                                               const ArmUncertainty&,                  \
                                               const JointVector<double, Joints>&);
FLEXCOMP_EXTREMES(1)
FLEXCOMP_EXTREMES(2)
FLEXCOMP_EXTREMES(6)

}  // namespace flexcomp::control
