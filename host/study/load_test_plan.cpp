#include "study/load_test_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "flexcomp/chain.hpp"
#include "linear_algebra/decompositions.hpp"
#include "statistics/median.hpp"

namespace flexcomp::study {
namespace {

constexpr double kQuantile = 1.959963984540054;  // of the normal distribution, two-sided 95 %
constexpr double kLeastCompliance = 1e-9;        // rad/(N·m) and m/N, for springs not in the model
constexpr double kPrior = 1e-9;  // information there is before any test, so that it has an inverse
constexpr double kInformed = 1e-6;  // more than the prior, by far

constexpr int kMostSprings = 18;

/// A candidate and what it adds: its columns over the noise, per part of the model's compliance.
struct InformedTest {
  LoadTest test;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostSprings> columns;  ///< 3 × springs
};

Eigen::VectorXd compliances(const RobotModel<double, 6>& model, const SoughtSprings& sought) {
  std::vector<double> all;
  for (const Joint<double>& joint : model.joints) {
    all.push_back(joint.compliance);
  }
  for (const auto& [is_sought, values] : {std::pair{sought.base, &model.base_compliance},
                                          std::pair{sought.tool, &model.tool_compliance}}) {
    for (Eigen::Index i = 0; i < 6 && is_sought; ++i) {
      all.push_back((*values)[i]);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()))
      .cwiseMax(kLeastCompliance);
}

InformedTest candidate_of(const RobotModel<double, 6>& model, const LoadTest& test,
                          const PlanRequest& request) {
  // The difference of a loaded and an unloaded reading has twice the variance of one.
  return {test, spring_columns(model, test, request.sought) *
                    compliances(model, request.sought).asDiagonal() /
                    (std::sqrt(2) * request.noise)};
}

Eigen::MatrixXd information_of(const std::vector<InformedTest>& chosen, Eigen::Index springs) {
  Eigen::MatrixXd information = kPrior * Eigen::MatrixXd::Identity(springs, springs);
  for (const InformedTest& each : chosen) {
    information += each.columns.transpose() * each.columns;
  }
  return information;
}

Eigen::VectorXd half_widths(const Eigen::MatrixXd& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  Eigen::VectorXd widths(information.rows());
  for (Eigen::Index i = 0; i < widths.size(); ++i) {
    double variance = 0;
    for (Eigen::Index k = 0; k < widths.size(); ++k) {
      const double share = std::pow(solver.eigenvectors()(i, k), 2);
      const double own = solver.eigenvalues()[k];
      variance += own > kInformed     ? share / own
                  : share > kInformed ? std::numeric_limits<double>::infinity()
                                      : 0;
    }
    widths[i] = kQuantile * std::sqrt(variance);
  }
  return widths;
}

/// Logarithm of the determinant's growth by a candidate, of an information with that inverse.
double growth(const InformedTest& candidate, const Eigen::MatrixXd& inverse) {
  const Eigen::Matrix3d inner =
      Eigen::Matrix3d::Identity() + candidate.columns * inverse * candidate.columns.transpose();
  return std::log(std::max(inner.determinant(), 1e-300));
}

const InformedTest& best_of(const std::vector<InformedTest>& all, const Eigen::MatrixXd& inverse) {
  return *std::max_element(all.begin(), all.end(),
                           [&](const InformedTest& a, const InformedTest& b) {
                             return growth(a, inverse) < growth(b, inverse);
                           });
}

void check(const PlanRequest& request) {
  const auto is_size = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_size(request.force) || !is_size(request.noise) || !is_size(request.precision) ||
      request.most < 1 || request.most > 10000) {
    throw InputError(
        "force, noise and precision must be above zero, the number of tests from 1 to 10000");
  }
}

bool is_allowed(const RobotModel<double, 6>& model, const PlanRequest& request,
                const JointVector<double, 6>& q) {
  for (std::size_t i = 0; i < 6; ++i) {
    const double angle = q[static_cast<Eigen::Index>(i)];
    if (angle < model.joints[i].lower || angle > model.joints[i].upper) {
      return false;
    }
  }
  return forward_kinematics<double, 6>(model, q).tcp.position.z() >= request.least_height;
}

/// Loads along the base's axes and halfway between them.
std::vector<Vector3<double>> directions() {
  std::vector<Vector3<double>> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = 0; z <= 1; ++z) {
        // One of two opposite loads is enough.
        if (z > 0 || y > 0 || (y == 0 && x > 0)) {
          all.push_back(Vector3<double>(x, y, z).normalized());
        }
      }
    }
  }
  return all;
}

/// Builds a plan up.
class Planner {
 public:
  Planner(const RobotModel<double, 6>& model, const PlanRequest& request)
      : model_(model), request_(request), random_(request.seed) {
    for (LoadTest test : random_tests(model, request, request.candidates, &random_)) {
      for (const Vector3<double>& direction : directions()) {
        test.wrench.head<3>() = request.force * direction;
        candidates_.push_back(candidate_of(model, test, request));
      }
    }
    springs_ = candidates_.front().columns.cols();
    best_widths_ = half_widths(information_of(candidates_, springs_));
    // No plan tells a spring that interval holds zero of even if each of its tests were the best
    // one for this spring and nothing else were sought.
    Eigen::ArrayXd most_told = Eigen::ArrayXd::Zero(springs_);
    for (const InformedTest& each : candidates_) {
      most_told = most_told.max(each.columns.colwise().squaredNorm().transpose().array());
    }
    const auto most = static_cast<double>(request.most);
    constexpr double kZero = 1;  // half the interval over the compliance: it holds zero
    best_widths_ = (kQuantile * (most * most_told).rsqrt() > kZero)
                       .select(std::numeric_limits<double>::infinity(), best_widths_);
    matters_ = compliances(model, request.sought).array() > kLeastCompliance;
  }

  void add() { chosen_.push_back(best_of(candidates_, inverse_without(chosen_.size()))); }

  /// Exchanges each test for the best candidate, and that for better ones nearby.
  void exchange() {
    constexpr int kTries = 40;
    std::normal_distribution<double> step(0, 0.2);  // rad
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const Eigen::MatrixXd inverse = inverse_without(i);
      const InformedTest& other = best_of(candidates_, inverse);
      if (growth(other, inverse) > growth(chosen_[i], inverse)) {
        chosen_[i] = other;
      }
      for (int attempt = 0; attempt < kTries; ++attempt) {
        LoadTest test = chosen_[i].test;
        for (double& angle : test.q) {
          angle += step(random_);
        }
        InformedTest moved = candidate_of(model_, test, request_);
        if (is_allowed(model_, request_, test.q) &&
            growth(moved, inverse) > growth(chosen_[i], inverse)) {
          chosen_[i] = std::move(moved);
        }
      }
    }
  }

  /// Widths with the tests chosen so far; infinite where no candidate tells anything.
  Eigen::VectorXd widths() const {
    return best_widths_.array().isInf().select(best_widths_,
                                               half_widths(information_of(chosen_, springs_)));
  }

  /// Is all that can be told, of springs that the model has, told so well?
  bool is_precise(double precision) const {
    const Eigen::VectorXd own = widths();
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      if (matters_[i] && std::isfinite(best_widths_[i]) && !(own[i] <= precision)) {
        return false;
      }
    }
    return true;
  }

  const std::vector<InformedTest>& chosen() const { return chosen_; }

 private:
  Eigen::MatrixXd inverse_without(std::size_t index) const {
    Eigen::MatrixXd information = information_of(chosen_, springs_);
    if (index < chosen_.size()) {
      information -= chosen_[index].columns.transpose() * chosen_[index].columns;
    }
    return information.ldlt().solve(Eigen::MatrixXd::Identity(springs_, springs_));
  }

  const RobotModel<double, 6>& model_;
  const PlanRequest& request_;
  std::mt19937 random_;
  std::vector<InformedTest> candidates_;
  std::vector<InformedTest> chosen_;
  Eigen::Index springs_ = 0;
  Eigen::VectorXd best_widths_;  ///< with all candidates
  Eigen::Array<bool, Eigen::Dynamic, 1> matters_;
};

}  // namespace

std::vector<LoadTest> random_tests(const RobotModel<double, 6>& model, const PlanRequest& request,
                                   std::size_t count, std::mt19937* random) {
  constexpr int kTries = 1000;
  std::vector<LoadTest> tests;
  for (int failed = 0; tests.size() < count;) {
    LoadTest test;
    for (std::size_t i = 0; i < 6; ++i) {
      const Joint<double>& joint = model.joints[i];
      std::uniform_real_distribution<double> angle(std::max(joint.lower, -M_PI),
                                                   std::min(joint.upper, M_PI));
      test.q[static_cast<Eigen::Index>(i)] = angle(*random);
    }
    test.wrench.setZero();
    std::uniform_int_distribution<Eigen::Index> axis(0, 2);
    test.wrench[axis(*random)] = request.force;
    const auto at = forward_kinematics<double, 6>(model, test.q);
    if (at.tcp.position.z() >= request.least_height) {
      tests.push_back(test);
      failed = 0;
    } else if (++failed > kTries) {
      throw InputError("no posture within the joint limits has its TCP above the least height");
    }
  }
  return tests;
}

Eigen::VectorXd expected_half_widths(const RobotModel<double, 6>& model,
                                     const std::vector<LoadTest>& tests,
                                     const PlanRequest& request) {
  std::vector<InformedTest> all;
  all.reserve(tests.size());
  for (const LoadTest& test : tests) {
    all.push_back(candidate_of(model, test, request));
  }
  return half_widths(
      information_of(all, static_cast<Eigen::Index>(spring_names(request.sought).size())));
}

LoadTestPlan plan_load_tests(const RobotModel<double, 6>& model, const PlanRequest& request,
                             const std::function<void(std::size_t, std::size_t)>& progress) {
  check(request);
  Planner planner(model, request);
  LoadTestPlan plan;
  plan.names = spring_names(request.sought);
  while (!plan.is_precise && planner.chosen().size() < request.most) {
    planner.add();
    // Exchanges are dear: only where they may be the last that is needed.
    constexpr double kNear = 1.3;
    if (planner.is_precise(kNear * request.precision) || planner.chosen().size() == request.most) {
      planner.exchange();
    }
    plan.is_precise = planner.is_precise(request.precision);
    progress(planner.chosen().size(), request.most);
  }
  plan.half_width = planner.widths();
  for (const InformedTest& each : planner.chosen()) {
    plan.tests.push_back(each.test);
  }
  return plan;
}

double gain_over_random(const RobotModel<double, 6>& model, const LoadTestPlan& plan,
                        const PlanRequest& request, int repeats) {
  std::mt19937 random(request.seed + 1);
  std::vector<std::vector<double>> variances(plan.names.size());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Eigen::VectorXd widths = expected_half_widths(
        model, random_tests(model, request, plan.tests.size(), &random), request);
    for (std::size_t i = 0; i < variances.size(); ++i) {
      variances[i].push_back(std::pow(widths[static_cast<Eigen::Index>(i)], 2));
    }
  }
  std::vector<double> gains;
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const double own = std::pow(plan.half_width[static_cast<Eigen::Index>(i)], 2);
    if (std::isfinite(own)) {
      gains.push_back(statistics::median(variances[i]) / own);
    }
  }
  return gains.empty() ? 1 : statistics::median(gains);
}

recording::Recording as_recording(const LoadTestPlan& plan) {
  const auto rows = static_cast<Eigen::Index>(2 * plan.tests.size());
  recording::Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, static_cast<double>(rows - 1));
  recording.q_cmd = recording::Samples(rows, 6);
  recording.wrench = recording::Samples::Zero(rows, 6);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LoadTest& test = plan.tests[static_cast<std::size_t>(i / 2)];
    recording.q_cmd->row(i) = test.q.transpose();
    if (i % 2 == 1) {
      recording.wrench->row(i) = test.wrench.transpose();
    }
  }
  return recording;
}

}  // namespace flexcomp::study
