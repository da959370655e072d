#include "planning/inverse_kinematics.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <kdl/chainiksolverpos_lma.hpp>

#include "flexcomp/compliance.hpp"
#include "model/kdl.hpp"
#include "planning/closed_form.hpp"

namespace flexcomp::planning {
namespace {

using model::to_kdl;

KDL::Chain kinematic_chain(const RobotModel<double, 6>& model) {
  KDL::Chain chain;
  for (const Joint<double>& joint : model.joints) {
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(joint.origin)));
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Vector::Zero(), to_kdl(joint.axis), KDL::Joint::RotAxis)));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(model.tool)));
  return chain;
}

/// Moves an angle by whole turns to the one nearest to `near` within limits.
double nearest_turn(double angle, double near, const Joint<double>& joint) {
  double turned = angle + 2 * M_PI * std::round((near - angle) / (2 * M_PI));
  while (turned > joint.upper && turned - 2 * M_PI >= joint.lower) {
    turned -= 2 * M_PI;
  }
  while (turned < joint.lower && turned + 2 * M_PI <= joint.upper) {
    turned += 2 * M_PI;
  }
  return turned;
}

/// A step of the joints, rad, after which the solver is at a solution or stuck where there is none.
constexpr double kStuck = 1e-6;

/// Metres and radians count alike.
const Eigen::Matrix<double, 6, 1> kEqualWeights = Eigen::Matrix<double, 6, 1>::Ones();

bool is_within_limits(const RobotModel<double, 6>& model, const Angles& q) {
  for (std::size_t i = 0; i < 6; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (!(q[joint] >= model.joints[i].lower && q[joint] <= model.joints[i].upper)) {
      return false;
    }
  }
  return true;
}

/// Newton's method, to the last digits; nothing if it does not begin close to a solution. Not
/// damped as the core's inverse is, which near singularities would cost its quadratic convergence;
/// a direction that is singular outright is left as it is.
std::optional<Angles> by_newton(const RobotModel<double, 6>& model, const Pose<double>& target,
                                Angles q) {
  constexpr int kMostSteps = 8;
  constexpr double kSingular = 1e-6;  // of the largest singular value
  for (int step = 0; step < kMostSteps; ++step) {
    const Kinematics<double, 6> at = forward_kinematics<double, 6>(model, q);
    const Twist<double> off = pose_difference(at.tcp, target);
    if (off.cwiseAbs().maxCoeff() <= 1e-13) {
      break;
    }
    Eigen::CompleteOrthogonalDecomposition<Jacobian<double, 6>> jacobian;
    jacobian.setThreshold(kSingular);
    q += jacobian.compute(geometric_jacobian<double, 6>(at)).solve(off);
  }
  const Pose<double> reached = forward_kinematics<double, 6>(model, q).tcp;
  if (!(pose_difference(reached, target).cwiseAbs().maxCoeff() <= 1e-9)) {
    return std::nullopt;
  }
  return q;
}

class Solver {
 public:
  explicit Solver(const RobotModel<double, 6>& model)
      : model_(model),
        chain_(kinematic_chain(model)),
        solver_(chain_, kEqualWeights, 1e-10, 500, kStuck) {}

  std::optional<Angles> solve(const Pose<double>& target, const Angles& seed) {
    KDL::JntArray start(6);
    KDL::JntArray found(6);
    start.data = seed;
    solver_.CartToJnt(start, to_kdl(target), found);
    Angles q;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      q[joint] = nearest_turn(found.data[joint], seed[joint], model_.joints[i]);
    }
    if (!is_within_limits(model_, q)) {
      return std::nullopt;
    }
    return by_newton(model_, target, q);
  }

 private:
  const RobotModel<double, 6>& model_;
  KDL::Chain chain_;
  KDL::ChainIkSolverPos_LMA solver_;
};

/// How far the angles are from the middle of the joint ranges; 6 at worst.
double off_middle(const RobotModel<double, 6>& model, const Angles& q) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint<double>& joint = model.joints[i];
    const double middle = (joint.lower + joint.upper) / 2;
    sum += std::pow((q[static_cast<Eigen::Index>(i)] - middle) / (joint.upper - middle), 2);
  }
  return sum;
}

/// From many starts; it may miss some and find others more than once.
std::vector<Angles> search(const RobotModel<double, 6>& model, const Pose<double>& target) {
  Solver solver(model);
  std::vector<Angles> solutions;
  const auto seed_angle = [&](std::size_t joint, double share) {
    return model.joints[joint].lower +
           share * (model.joints[joint].upper - model.joints[joint].lower);
  };
  for (const double first : {0.5, 0.25, 0.75}) {
    for (const double second : {0.5, 0.25, 0.75}) {
      for (const double third : {0.5, 0.75, 0.25}) {
        for (const double fifth : {0.7, 0.3}) {
          for (const double wrist : {-M_PI / 2, 0.0, M_PI / 2}) {
            Angles seed;
            seed << seed_angle(0, first), seed_angle(1, second), seed_angle(2, third), wrist,
                seed_angle(4, fifth), wrist;
            if (const std::optional<Angles> q = solver.solve(target, seed)) {
              solutions.push_back(*q);
            }
          }
        }
      }
    }
  }
  return solutions;
}

/// Solutions within the joint limits, each once, the farthest from the limits first. Each joint is
/// turned by whole turns to as near the middle of its range as it may be.
std::vector<Angles> within_limits(const RobotModel<double, 6>& model, const Pose<double>& target,
                                  const std::vector<Angles>& solutions) {
  std::vector<Angles> within;
  for (Angles q : solutions) {
    for (std::size_t i = 0; i < 6; ++i) {
      const Joint<double>& joint = model.joints[i];
      double& angle = q[static_cast<Eigen::Index>(i)];
      angle = nearest_turn(angle, (joint.lower + joint.upper) / 2, joint);
    }
    const std::optional<Angles> exact = by_newton(model, target, q);
    const bool is_new =
        exact && std::none_of(within.begin(), within.end(), [&](const Angles& other) {
          return (other - *exact).cwiseAbs().maxCoeff() < 1e-6;
        });
    if (is_new && is_within_limits(model, *exact)) {
      within.push_back(*exact);
    }
  }
  std::sort(within.begin(), within.end(), [&](const Angles& a, const Angles& b) {
    return off_middle(model, a) < off_middle(model, b);
  });
  return within;
}

}  // namespace

std::optional<Angles> solve_near(const RobotModel<double, 6>& model, const Pose<double>& target,
                                 const Angles& seed) {
  constexpr double kNear = 0.5;  // rad: farther than this Newton's method went elsewhere
  std::optional<Angles> q = by_newton(model, target, seed);
  if (q && (*q - seed).cwiseAbs().maxCoeff() < kNear && is_within_limits(model, *q)) {
    return q;
  }
  return Solver(model).solve(target, seed);
}

std::vector<Angles> solve_all(const RobotModel<double, 6>& model, const Pose<double>& target) {
  const std::optional<ClosedForm> closed = solve_closed_form(model, target);
  if (!closed) {
    return search_all(model, target);
  }
  std::vector<Angles> solutions = within_limits(model, target, closed->solutions);
  return solutions.empty() && !closed->is_exact ? search_all(model, target) : solutions;
}

std::vector<Angles> search_all(const RobotModel<double, 6>& model, const Pose<double>& target) {
  return within_limits(model, target, search(model, target));
}

}  // namespace flexcomp::planning
