#include <algorithm>
#include <array>
#include <optional>

#include "diagnosis/least_squares.hpp"
#include "diagnosis/search/search.hpp"
#include "effects/hose.hpp"

namespace flexcomp::diagnosis {
namespace {

using effects::HoseCourse;
using effects::HoseEnds;

/// What the training samples of some rows of a scene tell of torques on the joints' springs and
/// drives.
struct TorqueRows {
  const Simulation* simulation;
  effects::Rows rows;
  Eigen::MatrixXd root;  ///< rows × joints, 1/(N·m): a torque over its noise is root · torque
  Eigen::MatrixXd seen;  ///< rows × joints, residual torque over its noise
};

/// The hose that is sought: numbers are the length at which it is slack, and its ends.
constexpr Eigen::Index kNumbers = 7;
using Numbers = Eigen::Matrix<double, kNumbers, 1>;

// Of the reach, chosen by judgement: an upper arm is half of it long, and a tool's hoses are held
// beside the tool.
constexpr double kUsualArm = 0.2;
constexpr double kUsualTool = 0.1;

HoseEnds ends_of(const Eigen::VectorXd& numbers) {
  return {numbers.segment<3>(1), numbers.segment<3>(4)};
}

std::vector<TorqueRows> torque_rows(const Observations& observations,
                                    const Eigen::VectorXd& unexplained) {
  constexpr Eigen::Index kMost = 400;  // rows of a recording: more take longer and show no more
  std::vector<TorqueRows> all;
  for (std::size_t s = 0; s < observations.train_scenes; ++s) {
    const Eigen::Index rows = observations.scenes[s].rows();
    const Eigen::Index step = 1 + rows / kMost;
    const effects::Rows taken{step, (rows + step - 1) / step};
    const Eigen::MatrixXd none =
        Eigen::MatrixXd::Zero(taken.count, observations.simulations[s].q.cols());
    all.push_back({&observations.simulations[s], taken, none, none});
  }
  // By least squares of both channels: a torque shows with the other sign, for the drive bears
  // what nothing else does, and as the wind-up that it gives.
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    TorqueRows& rows = all[at.scene];
    if (at.channel == simulation::tcp_position || at.row % rows.rows.step != 0) {
      continue;
    }
    const double shown =
        (at.channel == simulation::joint_torque ? -1
                                                : rows.simulation->joint_compliance[at.component]) /
        observations.noise[i];
    const Eigen::Index row = at.row / rows.rows.step;
    rows.root(row, at.component) += shown * shown;
    rows.seen(row, at.component) += shown * unexplained[i];
  }
  for (TorqueRows& rows : all) {
    rows.root = rows.root.cwiseSqrt();
    rows.seen = (rows.root.array() > 0).select(rows.seen.array() / rows.root.array(), 0.0);
  }
  return all;
}

/// A hose of one place, by the residual torques.
class HoseSquares : public SumOfSquares {
 public:
  HoseSquares(const std::vector<TorqueRows>& torques, const Hypothesis& hypothesis)
      : torques_(torques), joint_(hypothesis.joint), tolerance_(tolerance_of(hypothesis)) {}

  /// The residual without what the best stiffness and friction of such a hose show.
  Eigen::VectorXd left(const Eigen::VectorXd& numbers) const {
    const Eigen::MatrixX2d by_one = shown(numbers);
    return seen() - by_one * best_pull(by_one);
  }

  std::optional<double> half(const Eigen::VectorXd& numbers) override {
    return held(numbers).squaredNorm() / 2;
  }

  std::optional<Quadratic> quadratic(const Eigen::VectorXd& numbers) override {
    constexpr double kStep = 1e-4;  // m
    const Eigen::VectorXd here = held(numbers);
    Eigen::MatrixXd slopes(here.size(), numbers.size());
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      Eigen::VectorXd beside = numbers;
      beside[i] += kStep;
      slopes.col(i) = (held(beside) - here) / kStep;
    }
    return Quadratic{here.squaredNorm() / 2, slopes.transpose() * here,
                     slopes.transpose() * slopes};
  }

  Eigen::VectorXd seen() const {
    Eigen::VectorXd all(count());
    Eigen::Index filled = 0;
    for (const TorqueRows& rows : torques_) {
      all.segment(filled, rows.seen.size()) = rows.seen.reshaped();
      filled += rows.seen.size();
    }
    return all;
  }

  /// The squares that it takes off a residual where it does not rub.
  double gain_by_pull(const Eigen::VectorXd& numbers) const {
    const Eigen::VectorXd pull = shown(numbers).col(0);
    const double product = std::max(pull.dot(seen()), 0.0);
    return product > 0 ? product * product / pull.squaredNorm() : 0.0;
  }

  /// The squares that it takes off a residual, joint by joint.
  Eigen::VectorXd gains(const Eigen::VectorXd& numbers) const {
    const Eigen::ArrayXd gain = seen().array().square() - left(numbers).array().square();
    Eigen::VectorXd by_joint = Eigen::VectorXd::Zero(torques_.front().seen.cols());
    Eigen::Index taken = 0;
    for (const TorqueRows& rows : torques_) {
      by_joint += gain.segment(taken, rows.seen.size())
                      .reshaped(rows.seen.rows(), rows.seen.cols())
                      .colwise()
                      .sum()
                      .matrix()
                      .transpose();
      taken += rows.seen.size();
    }
    return by_joint;
  }

 private:
  static Eigen::VectorXd tolerance_of(const Hypothesis& hypothesis) {
    Eigen::VectorXd all(kNumbers);
    for (Eigen::Index i = 0; i < kNumbers; ++i) {
      all[i] = hypothesis.parameters[hypothesis.linear + static_cast<std::size_t>(i)].tolerance;
    }
    return all;
  }

  /// What is left, and the numbers over what holds them.
  Eigen::VectorXd held(const Eigen::VectorXd& numbers) const {
    Eigen::VectorXd all(count() + kNumbers);
    all << left(numbers), numbers.cwiseQuotient(tolerance_);
    return all;
  }

  /// What a stiffness of one and a friction of one show in all rows and joints, over the noise.
  Eigen::MatrixX2d shown(const Eigen::VectorXd& numbers) const {
    Eigen::MatrixX2d all(count(), 2);
    Eigen::Index filled = 0;
    for (const TorqueRows& rows : torques_) {
      const HoseCourse course =
          effects::hose_course(*rows.simulation, joint_, ends_of(numbers), rows.rows);
      const Eigen::ArrayXXd lever = -course.slope.array() * rows.root.array();
      const Eigen::ArrayXd stretch = effects::stretch(course, numbers[0]).array();
      const Eigen::ArrayXd direction = course.direction.cast<double>().array();
      all.col(0).segment(filled, lever.size()) = (lever.colwise() * stretch).reshaped();
      all.col(1).segment(filled, lever.size()) = (lever.colwise() * direction).reshaped();
      filled += lever.size();
    }
    return all;
  }

  /// The stiffness and the friction that explain most; neither is below zero.
  Eigen::Vector2d best_pull(const Eigen::MatrixX2d& by_one) const {
    const Eigen::Vector2d squares = by_one.colwise().squaredNorm().transpose();
    const Eigen::Vector2d product = by_one.transpose() * seen();
    const double both = by_one.col(0).dot(by_one.col(1));
    const auto alone = [&](int i) { return squares[i] > 0 ? product[i] / squares[i] : 0.0; };
    const double left_over = squares.prod() - both * both;
    if (left_over > 1e-9 * squares.prod()) {
      const Eigen::Vector2d pull(squares[1] * product[0] - both * product[1],
                                 squares[0] * product[1] - both * product[0]);
      if (pull.minCoeff() >= 0) {
        return pull / left_over;
      }
    }
    const Eigen::Vector2d gain = product.cwiseMax(0).cwiseProduct(
        Eigen::Vector2d(std::max(alone(0), 0.0), std::max(alone(1), 0.0)));
    return gain[0] >= gain[1] ? Eigen::Vector2d(std::max(alone(0), 0.0), 0)
                              : Eigen::Vector2d(0, std::max(alone(1), 0.0));
  }

  Eigen::Index count() const {
    Eigen::Index all = 0;
    for (const TorqueRows& rows : torques_) {
      all += rows.seen.size();
    }
    return all;
  }

  const std::vector<TorqueRows>& torques_;
  int joint_;
  Eigen::VectorXd tolerance_;
};

/// The least, middle and largest length of a hose along the recordings.
std::array<double, 3> lengths(const std::vector<TorqueRows>& torques, int joint,
                              const HoseEnds& ends) {
  std::vector<double> all;
  for (const TorqueRows& rows : torques) {
    const HoseCourse course = effects::hose_course(*rows.simulation, joint, ends, rows.rows);
    all.insert(all.end(), course.length.begin(), course.length.end());
  }
  std::sort(all.begin(), all.end());
  return {all.front(), all[all.size() / 2], all.back()};
}

/// The middle of the link before a joint, in its frame: between its own joint and the next.
Vector3<double> middle_of_link(const Observations& observations, int joint) {
  const model::ChainKinematics& at = observations.simulations.front().bent.front();
  const Pose<double>& link = at.links[static_cast<std::size_t>(joint - 2)];
  return link.rotation.transpose() *
         (at.links[static_cast<std::size_t>(joint - 1)].position - link.position) / 2;
}

/// Does it explain most of what is unexplained, mostly by its pull, and in several joints?
bool is_shown(const HoseSquares& squares, const Eigen::VectorXd& numbers) {
  // All chosen by judgement. Nine numbers imitate a part of whatever is smooth, and what rubs is
  // friction of the joints: on a Panda without its friction 0.84 of the squares, and 0.01 by the
  // pull alone. Hoses of another engine explained 0.99, and 0.98 by the pull alone.
  constexpr double kLeastShare = 0.6;      // of the squares beyond the noise
  constexpr double kLeastPull = 0.5;       // of all that it gains, by the pull alone
  constexpr double kLeastOfSecond = 0.01;  // of that, in the joint that is second: what one joint
                                           // alone shows, such as a balancer's torque, is its own
  constexpr double kLeastSquares = 50;     // of the noise, in that joint
  const Eigen::VectorXd seen = squares.seen();
  const double beyond_noise = seen.squaredNorm() - static_cast<double>((seen.array() != 0).count());
  Eigen::VectorXd gains = squares.gains(numbers);
  const double all = gains.sum();
  std::sort(gains.begin(), gains.end());
  return all > std::max(kLeastShare * beyond_noise, 0.0) &&
         squares.gain_by_pull(numbers) > kLeastPull * all &&
         gains[gains.size() - 2] > std::max(kLeastOfSecond * all, kLeastSquares);
}

using Guess = std::pair<double, Eigen::VectorXd>;  // half the sum of squares, and the numbers

bool is_nearer(const Guess& one, const Guess& other) { return one.first < other.first; }

/// Hoses held beside the middle of the link and beside the tool, taut always, mostly or seldom; the
/// best first.
std::vector<Guess> guesses(const std::vector<TorqueRows>& torques, int joint,
                           const Vector3<double>& middle, double aside, HoseSquares* squares) {
  std::vector<Vector3<double>> asides{Vector3<double>::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-aside, aside}) {
      asides.emplace_back(side * Vector3<double>::Unit(axis));
    }
  }
  std::vector<Guess> all;
  for (const Vector3<double>& arm : asides) {
    for (const Vector3<double>& tool : asides) {
      const HoseEnds ends{middle + arm, tool};
      const auto [least, half, most] = lengths(torques, joint, ends);
      for (const double slack : {0.5 * least, 0.7 * least + 0.3 * half, 0.5 * (half + most)}) {
        Numbers numbers;
        numbers << slack, ends.arm, ends.tool;
        all.emplace_back(*squares->half(numbers), numbers);
      }
    }
  }
  std::sort(all.begin(), all.end(), is_nearer);
  return all;
}

/// The best guesses are drawn to where they explain most; the best of these is the start.
std::vector<Values> seek_dress_pack(const Observations& observations,
                                    const Eigen::VectorXd& unexplained,
                                    const Hypothesis& hypothesis) {
  constexpr double kAside = 0.1;    // of the reach: hoses are held beside a link and a tool
  constexpr std::size_t kMost = 4;  // guesses that are drawn
  constexpr Steps kSteps{40, 1e-4};
  const std::vector<TorqueRows> torques = torque_rows(observations, unexplained);
  HoseSquares squares(torques, hypothesis);
  const double reach = effects::size_of(observations.machine.robot).reach;
  std::vector<Guess> found =
      guesses(torques, hypothesis.joint, middle_of_link(observations, hypothesis.joint),
              kAside * reach, &squares);
  found.resize(std::min(found.size(), kMost));
  Box box{Numbers::Constant(-0.5 * reach), Numbers::Constant(0.5 * reach)};
  box.lower[0] = -3 * reach;
  box.upper[0] = 3 * reach;
  for (auto& [half, numbers] : found) {
    numbers = least_squares(&squares, box, box.nearest(numbers), kSteps);
    half = *squares.half(numbers);
  }
  const Eigen::VectorXd& best = std::min_element(found.begin(), found.end(), is_nearer)->second;
  return is_shown(squares, best) ? std::vector<Values>{Values(best.begin(), best.end())}
                                 : std::vector<Values>{};
}

/// Needs torques of several joints, and an arm that moves.
bool prepare_dress_pack(const Observations& observations, Hypothesis* hypothesis) {
  const bool sees_joints =
      observations.has(simulation::joint_deflection) || sees_moving_torques(observations);
  const double reach = effects::size_of(observations.machine.robot).reach;
  const Bounds end{-0.5 * reach, 0.5 * reach, 1e-3 * reach};
  std::vector<Bounds> bounds{{0, 1e5, 1}, {0, 1e4, 1}};  // N/m and N
  bounds.push_back({-3 * reach, 3 * reach, 1e-3 * reach});
  bounds.insert(bounds.end(), 6, end);
  hypothesis->set_bounds(bounds);
  // Torques tell the line along which a hose pulls better than where on it the hose is held.
  for (std::size_t i = 0; i < 6; ++i) {
    hypothesis->parameters[hypothesis->linear + 1 + i].tolerance =
        (i < 3 ? kUsualArm : kUsualTool) * reach;
  }
  return sees_joints && observations.simulations.front().q.cols() > 2 &&
         !observations.simulations.front().jacobian.empty();
}

}  // namespace

Search search::dress_pack() { return {prepare_dress_pack, seek_dress_pack}; }

}  // namespace flexcomp::diagnosis
