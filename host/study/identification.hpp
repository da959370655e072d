#pragma once

#include <string>
#include <vector>

#include "flexcomp/model.hpp"
#include "recording/recording.hpp"

namespace flexcomp::study {

/// One load at one posture.
struct LoadTest {
  JointVector<double, 6> q;  ///< rad
  Wrench<double> wrench;     ///< on the tool at the TCP, base frame
};

/// The springs to be found beside those of the joints.
struct SoughtSprings {
  bool base = false;
  bool tool = false;
};

/// Knowledge that tests give of a spring.
enum class Told {
  yes,            ///< its 95 % interval lies above zero
  not_loaded,     ///< no load turns it, or only together with others; the rest is meaningless then
  within_noise,   ///< its 95 % interval holds zero, or lies below it by chance
  against_load,   ///< below zero by more than chance: a spring that gives against its load
  not_plausible,  ///< its 95 % interval lies above every compliance that a machine can have
};

/// A compliance and how well it is known.
struct IdentifiedSpring {
  std::string name;      ///< joint_1 … joint_6, base_x … base_rz, tool_x … tool_rz
  double value = 0;      ///< rad/(N·m), or m/N
  double deviation = 0;  ///< standard
  double lower = 0;      ///< of the 95 % interval (Student's t)
  double upper = 0;
  Told told = Told::yes;

  /// Only then is it known; otherwise the model's value is the better one.
  bool is_told() const { return told == Told::yes; }
};

/// Two springs of which the tests tell no single one, but the sum first + factor × second.
struct IdentifiedSum {
  std::size_t first = 0;  ///< among the springs
  std::size_t second = 0;
  double factor = 1;  ///< how much the second one moves the TCP, over how much the first one does
  double value = 0;   ///< of the sum, in the first one's unit
  double lower = 0;   ///< of its 95 % interval
  double upper = 0;
};

/// Springs from load tests.
struct Identification {
  std::vector<IdentifiedSpring> springs;
  std::vector<IdentifiedSum> sums;  ///< of springs that are not told
  double noise = 0;                 ///< m, standard deviation of a coordinate as the fit leaves it
  double condition_number = 0;      ///< of the columns over their lengths, of what can be told
  Eigen::Index freedom = 0;         ///< coordinates less what was fitted
  Eigen::Index postures = 0;
  double largest_residual = 0;     ///< in standard deviations
  Eigen::Index largest_row = 0;    ///< of the recording, where that is
  double outlier_chance = 1;       ///< of one so large among as many, were all noise
  double nonlinearity_chance = 1;  ///< of cubic terms that explain so much, were springs linear
};

/// How the TCP's place changes with each sought spring's compliance: 3×n, in the springs' order.
Eigen::MatrixXd spring_columns(const RobotModel<double, 6>& model, const LoadTest& test,
                               const SoughtSprings& sought);

/// Names of the sought springs, in the order of the columns.
std::vector<std::string> spring_names(const SoughtSprings& sought);

/// Compliances by weighted least squares from a load test (t = 0, 1, 2, …; q_meas or q_cmd, the
/// wrench, x, y, z). Rows of one posture share an unknown place without load, so that errors of
/// the geometry do not matter; each posture needs two loads or more. `deviations` (m): of x, y and
/// z, where they are not measured alike; only their proportions count.
///
/// A spring is told only where its 95 % interval lies above zero. A column as short as the noise,
/// or hardly another direction than a second one, leaves an interval that holds it.
///
/// Dumas et al. 2011 (static load tests, joint springs linear in the unknowns). Throws InputError
/// for a recording that lacks a group or leaves fewer coordinates than unknowns.
Identification identify_springs(const RobotModel<double, 6>& model,
                                const recording::Recording& recording, const SoughtSprings& sought,
                                const Vector3<double>& deviations = Vector3<double>::Ones());

}  // namespace flexcomp::study
