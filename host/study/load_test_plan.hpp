#pragma once

#include <functional>
#include <random>
#include <vector>

#include "study/identification.hpp"

namespace flexcomp::study {

/// Requirements and means of load tests.
struct PlanRequest {
  SoughtSprings sought;
  double force = 1000;           ///< N, of every load
  double noise = 50e-6;          ///< m, standard deviation of a measured coordinate
  double precision = 0.05;       ///< half a 95 % interval over the compliance, of every spring
  double least_height = 0.3;     ///< m, of the TCP above the base frame's origin
  std::size_t most = 200;        ///< tests
  std::size_t candidates = 600;  ///< postures to choose from
  unsigned seed = 1;
};

/// Load tests, each the same posture without and with its load.
struct LoadTestPlan {
  std::vector<LoadTest> tests;
  std::vector<std::string> names;  ///< of the springs, in the order of identification
  Eigen::VectorXd half_width;  ///< of 95 % intervals over the model's compliance; infinite where
                               ///< tests cannot tell it: not by `most` tests, each of them the best
  bool is_precise = false;     ///< is every spring that can be told told to the precision?
};

/// Half the 95 % intervals that tests would give, over the compliances of the model.
Eigen::VectorXd expected_half_widths(const RobotModel<double, 6>& model,
                                     const std::vector<LoadTest>& tests,
                                     const PlanRequest& request);

/// Tests at random: postures within the joint limits, loads along the base's axes.
std::vector<LoadTest> random_tests(const RobotModel<double, 6>& model, const PlanRequest& request,
                                   std::size_t count, std::mt19937* random);

/// As few tests as give the precision: one by one the candidate that adds most to the determinant
/// of the information, then exchanged for better ones, moved about too (D-optimal; Fedorov 1972).
/// Throws InputError for a request that makes no sense or a robot with no posture above the height.
LoadTestPlan plan_load_tests(const RobotModel<double, 6>& model, const PlanRequest& request,
                             const std::function<void(std::size_t, std::size_t)>& progress);

/// The median, over the springs, of the variance that random designs of a plan's size give (their
/// median over `repeats`), over that of the plan.
double gain_over_random(const RobotModel<double, 6>& model, const LoadTestPlan& plan,
                        const PlanRequest& request, int repeats = 100);

/// The plan as a recording: t = 0, 1, 2, …, q_cmd and the wrench, without and with each load.
recording::Recording as_recording(const LoadTestPlan& plan);

}  // namespace flexcomp::study
