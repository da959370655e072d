#include "study/identification.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "linear_algebra/decompositions.hpp"
#include "statistics/distributions.hpp"

namespace flexcomp::study {
namespace {

constexpr double kSamePosture = 1e-4;  // rad, of every joint
constexpr double kTold = 1e-6;         // of the largest singular value, columns over their lengths
constexpr const char* kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};

/// The linear problem: observed = columns × compliances + a place for each posture, in weighted
/// coordinates, three a row of the recording.
struct Problem {
  Eigen::MatrixXd columns;
  Eigen::MatrixXd cubes;  ///< the same by the cubes of the joints' torques
  Eigen::VectorXd observed;
  std::vector<Eigen::Index> rows;  ///< of the recording, of each triple
  Eigen::Index postures = 0;
};

/// Takes the mean of each posture's coordinates away, of columns and observations alike: the same
/// as an unknown place for each.
class Postures {
 public:
  explicit Postures(const recording::Samples& q) {
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const auto found = std::find_if(members_.begin(), members_.end(), [&](const auto& posture) {
        return (q.row(posture.front()) - q.row(i)).cwiseAbs().maxCoeff() < kSamePosture;
      });
      if (found == members_.end()) {
        members_.push_back({i});
      } else {
        found->push_back(i);
      }
    }
  }

  Eigen::Index count() const { return static_cast<Eigen::Index>(members_.size()); }

  void center(Eigen::MatrixXd* stacked) const {
    for (const std::vector<Eigen::Index>& posture : members_) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(stacked->cols());
        for (const Eigen::Index row : posture) {
          mean += stacked->row(3 * row + axis);
        }
        mean /= static_cast<double>(posture.size());
        for (const Eigen::Index row : posture) {
          stacked->row(3 * row + axis) -= mean;
        }
      }
    }
  }

 private:
  std::vector<std::vector<Eigen::Index>> members_;
};

/// Rows of a load test that have all they need.
struct Tests {
  recording::Samples q;
  recording::Samples wrench;
  recording::Samples position;
  std::vector<Eigen::Index> rows;
};

Tests complete_rows(const recording::Recording& recording) {
  const recording::Samples* angles = recording.angles();
  if (angles == nullptr || !recording.wrench || !recording.position) {
    throw InputError(fmt::format(
        "{}: a load test needs q_meas or q_cmd, the wrench fx..mz and x, y, z", recording.file));
  }
  Tests tests;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (angles->row(i).allFinite() && recording.wrench->row(i).allFinite() &&
        recording.position->row(i).allFinite()) {
      tests.rows.push_back(i);
    }
  }
  tests.q = (*angles)(tests.rows, Eigen::all);
  tests.wrench = (*recording.wrench)(tests.rows, Eigen::all);
  tests.position = (*recording.position)(tests.rows, Eigen::all);
  return tests;
}

/// Displacement of the TCP by each joint's wind-up of τ³, m per rad/(N·m)³.
Eigen::Matrix<double, 3, 6> cubic_columns(const RobotModel<double, 6>& model,
                                          const LoadTest& test) {
  const auto at = forward_kinematics<double, 6>(model, test.q);
  const Jacobian<double, 6> jacobian = geometric_jacobian(at);
  const JointVector<double, 6> torque = wrench_torque<double, 6>(jacobian, test.wrench);
  return jacobian.topRows<3>() * torque.array().cube().matrix().asDiagonal();
}

Problem problem_of(const RobotModel<double, 6>& model, const Tests& tests,
                   const SoughtSprings& sought, const Vector3<double>& deviations) {
  const Eigen::Index n = tests.q.rows();
  const auto springs = static_cast<Eigen::Index>(spring_names(sought).size());
  Eigen::MatrixXd stacked(3 * n, springs + 6 + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const LoadTest test{tests.q.row(i).transpose(), tests.wrench.row(i).transpose()};
    const Vector3<double> unloaded = forward_kinematics<double, 6>(model, test.q).tcp.position;
    stacked.block(3 * i, 0, 3, springs) = spring_columns(model, test, sought);
    stacked.block(3 * i, springs, 3, 6) = cubic_columns(model, test);
    stacked.block(3 * i, springs + 6, 3, 1) = tests.position.row(i).transpose() - unloaded;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      stacked.row(3 * i + axis) /= deviations[axis];
    }
  }
  const Postures postures(tests.q);
  postures.center(&stacked);
  return {stacked.leftCols(springs), stacked.middleCols(springs, 6), stacked.rightCols(1),
          tests.rows, postures.count()};
}

/// Chance of so large a fall of the sum of squares by so many parameters more, were they nothing.
double chance_of_gain(double before, double after, Eigen::Index parameters, Eigen::Index freedom) {
  if (parameters < 1 || freedom < 1 || !(after > 0)) {
    return 1;
  }
  const auto more = static_cast<double>(parameters);
  const auto left = static_cast<double>(freedom);
  const double ratio = std::max((before - after) / more, 0.0) / (after / left);
  return statistics::fisher_above(ratio, more, left);
}

/// Chance that the cubes of the joints' torques explain nothing beside the linear springs.
double nonlinearity_chance(const Problem& problem, double sum, Eigen::Index freedom) {
  Eigen::MatrixXd all(problem.columns.rows(), problem.columns.cols() + problem.cubes.cols());
  all << problem.columns, problem.cubes;
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const double length = all.col(i).norm();
    all.col(i) /= length > 0 ? length : 1;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> linear(all.leftCols(problem.columns.cols()));
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> cubic(all);
  linear.setThreshold(kTold);
  cubic.setThreshold(kTold);
  const Eigen::Index more = cubic.rank() - linear.rank();
  const double left = (problem.observed - all * cubic.solve(problem.observed)).squaredNorm();
  return chance_of_gain(sum, left, more, freedom - more);
}

/// The solution of the linear problem, with what is needed to judge it.
struct Solution {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;  ///< over the noise's variance
  Eigen::VectorXd untold;      ///< each spring's share, 0 to 1, in directions that no test tells
  double condition_number = 0;
  Eigen::Index rank = 0;
};

/// Least squares by singular values of the columns over their lengths; the smallest solution where
/// not all is told.
Solution solve(const Problem& problem) {
  const Eigen::VectorXd length = problem.columns.colwise().norm().transpose();
  const Eigen::VectorXd scale =
      length.unaryExpr([](double own) { return own > 0 ? 1 / own : 0.0; });
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(problem.columns * scale.asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const double limit = length.maxCoeff() > 0 ? kTold * singular[0] : 0;
  Solution solution;
  solution.rank = (singular.array() > limit).count();
  if (solution.rank == 0) {
    return solution;
  }
  solution.condition_number = singular[0] / singular[solution.rank - 1];
  const Eigen::VectorXd inverse =
      singular.unaryExpr([&](double value) { return value > limit ? 1 / value : 0.0; });
  const Eigen::MatrixXd root = scale.asDiagonal() * svd.matrixV() * inverse.asDiagonal();
  solution.value = root * (svd.matrixU().transpose() * problem.observed);
  solution.covariance = root * root.transpose();
  solution.untold = svd.matrixV().rightCols(singular.size() - solution.rank).rowwise().norm();
  solution.untold = (length.array() > 0).select(solution.untold, 1);
  return solution;
}

/// rad/(N·m) and m/N; a joint of a desktop arm has some 1e-3, a robot's bearing some 1e-8.
constexpr double kMostCompliance = 1e-2;

/// `untold`: as in Solution; `share`: of what was observed that it moves the TCP; `far`:
/// deviations, to where none of the springs gets by chance.
Told told_of(const IdentifiedSpring& spring, double untold, double share, double far) {
  if (untold > 1e-3) {
    return Told::not_loaded;
  }
  if (share < kTold) {
    return Told::within_noise;  // of rounding, if of nothing else
  }
  if (spring.value < -far * spring.deviation) {
    return Told::against_load;
  }
  if (!(spring.lower > 0)) {
    return Told::within_noise;
  }
  return spring.lower > kMostCompliance ? Told::not_plausible : Told::yes;
}

/// Sums of two springs that are not told whose columns hardly differ in direction.
std::vector<IdentifiedSum> told_sums(const Problem& problem, const Solution& solution,
                                     const std::vector<IdentifiedSpring>& springs, double noise,
                                     double reach) {
  constexpr double kAlike = 0.9;  // cosine between columns
  std::vector<IdentifiedSum> sums;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    for (std::size_t k = i + 1; k < springs.size(); ++k) {
      const auto a = problem.columns.col(static_cast<Eigen::Index>(i));
      const auto b = problem.columns.col(static_cast<Eigen::Index>(k));
      const double alike = a.dot(b) / (a.norm() * b.norm());
      if (springs[i].is_told() || springs[k].is_told() || !(alike > kAlike)) {
        continue;
      }
      IdentifiedSum sum{i, k, a.dot(b) / a.squaredNorm(), 0, 0, 0};
      Eigen::VectorXd weight = Eigen::VectorXd::Zero(solution.value.size());
      weight[static_cast<Eigen::Index>(i)] = 1;
      weight[static_cast<Eigen::Index>(k)] = sum.factor;
      sum.value = weight.dot(solution.value);
      const double half = reach * noise * std::sqrt(weight.dot(solution.covariance * weight));
      sum.lower = sum.value - half;
      sum.upper = sum.value + half;
      if (sum.lower > 0) {
        sums.push_back(sum);
      }
    }
  }
  return sums;
}

}  // namespace

std::vector<std::string> spring_names(const SoughtSprings& sought) {
  std::vector<std::string> names;
  for (int joint = 1; joint <= 6; ++joint) {
    names.push_back(fmt::format("joint_{}", joint));
  }
  for (const auto& [is_sought, what] :
       {std::pair{sought.base, "base"}, std::pair{sought.tool, "tool"}}) {
    for (const char* axis : kAxes) {
      if (is_sought) {
        names.push_back(fmt::format("{}_{}", what, axis));
      }
    }
  }
  return names;
}

Eigen::MatrixXd spring_columns(const RobotModel<double, 6>& model, const LoadTest& test,
                               const SoughtSprings& sought) {
  const auto at = forward_kinematics<double, 6>(model, test.q);
  const Jacobian<double, 6> jacobian = geometric_jacobian(at);
  const JointVector<double, 6> torque = wrench_torque<double, 6>(jacobian, test.wrench);
  const auto springs = static_cast<Eigen::Index>(spring_names(sought).size());
  Eigen::MatrixXd columns(3, springs);
  columns.leftCols<6>() = jacobian.topRows<3>() * torque.asDiagonal();
  Eigen::Index next = 6;
  const auto add_structure = [&](DiagonalCompliance<double> RobotModel<double, 6>::*which) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      RobotModel<double, 6> alone = model;
      alone.base_compliance.setZero();
      alone.tool_compliance.setZero();
      for (Joint<double>& joint : alone.joints) {
        joint.link_compliance.setZero();
      }
      (alone.*which)[axis] = 1;
      columns.col(next++) =
          (structure_compliance<double, 6>(alone, at) * test.wrench).template head<3>();
    }
  };
  if (sought.base) {
    add_structure(&RobotModel<double, 6>::base_compliance);
  }
  if (sought.tool) {
    add_structure(&RobotModel<double, 6>::tool_compliance);
  }
  return columns;
}

Identification identify_springs(const RobotModel<double, 6>& model,
                                const recording::Recording& recording, const SoughtSprings& sought,
                                const Vector3<double>& deviations) {
  if (!(deviations.minCoeff() > 0) || !deviations.allFinite()) {
    throw InputError("the deviations of x, y and z must be above zero");
  }
  const Tests tests = complete_rows(recording);
  const Problem problem = problem_of(model, tests, sought, deviations);
  const std::vector<std::string> names = spring_names(sought);
  const Solution solution = solve(problem);

  Identification result;
  result.postures = problem.postures;
  result.freedom = problem.observed.size() - 3 * problem.postures - solution.rank;
  if (solution.rank == 0 || result.freedom < 1) {
    throw InputError(fmt::format(
        "{}: {} rows in {} postures tell nothing of springs: each posture needs two loads or more, "
        "and all together more coordinates than unknowns",
        recording.file, tests.rows.size(), problem.postures));
  }
  result.condition_number = solution.condition_number;
  const Eigen::VectorXd residual = problem.observed - problem.columns * solution.value;
  const double sum = residual.squaredNorm();
  const auto freedom = static_cast<double>(result.freedom);
  result.noise = std::sqrt(sum / freedom);
  const double reach = statistics::student_exceeds(0.025, freedom);
  const double far =
      statistics::student_exceeds(0.001 / static_cast<double>(names.size()), freedom);
  for (Eigen::Index i = 0; i < solution.value.size(); ++i) {
    IdentifiedSpring spring;
    spring.name = names[static_cast<std::size_t>(i)];
    spring.value = solution.value[i];
    spring.deviation = result.noise * std::sqrt(solution.covariance(i, i));
    spring.lower = spring.value - reach * spring.deviation;
    spring.upper = spring.value + reach * spring.deviation;
    const double share =
        problem.columns.col(i).norm() * std::abs(spring.value) / problem.observed.norm();
    spring.told = told_of(spring, solution.untold[i], share, far);
    result.springs.push_back(spring);
  }
  result.sums = told_sums(problem, solution, result.springs, result.noise, reach);

  Eigen::Index worst = 0;
  const double largest = residual.cwiseAbs().maxCoeff(&worst);
  result.largest_row = tests.rows[static_cast<std::size_t>(worst / 3)];
  if (result.noise > 0) {
    // Residuals are smaller than the noise by what the fit takes of it.
    const double share = std::sqrt(static_cast<double>(result.freedom) /
                                   static_cast<double>(problem.observed.size()));
    result.largest_residual = largest / (result.noise * share);
    const double alone = 2 * statistics::normal_above(result.largest_residual);
    result.outlier_chance = std::min(1.0, alone * static_cast<double>(problem.observed.size()));
    result.nonlinearity_chance = nonlinearity_chance(problem, sum, result.freedom);
  }
  return result;
}

}  // namespace flexcomp::study
