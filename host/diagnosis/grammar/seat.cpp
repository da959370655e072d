#include "diagnosis/grammar/seat.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/search/search.hpp"
#include "linear_algebra/span.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

/// Times the noise: below it time would go into what is noise.
constexpr double kMoreThanNoise = 1.1;

/// A place by its words in robot.yaml.
struct Words {
  const char* name;
  const char* axis;
  int joint;
};

std::vector<Words> places_of(const Observations& observations) {
  std::vector<Words> all;
  for (int joint = 1; joint <= observations.machine.robot.joints(); ++joint) {
    if (sees_moving_torques(observations)) {
      all.push_back({"joint_torque", "", joint});
      all.push_back({"sensor tau", "", joint});
    }
    if (sees_angles(observations)) {
      all.push_back({"joint_angle", "", joint});
    }
  }
  if (observations.has(simulation::tcp_position)) {
    for (const char* axis : {"x", "y", "z"}) {
      all.push_back({"tcp_base", axis, 0});
      all.push_back({"tcp_tool", axis, 0});
    }
    for (const char* turn : {"rx", "ry", "rz"}) {
      all.push_back({"base", turn, 0});
    }
    for (const char* each : {"sensor x", "sensor y", "sensor z"}) {
      all.push_back({each, "", 0});
    }
  }
  if (observations.has_wrench()) {
    for (const char* each :
         {"sensor fx", "sensor fy", "sensor fz", "sensor mx", "sensor my", "sensor mz"}) {
      all.push_back({each, "", 0});
    }
  }
  return all;
}

double rows_shown(const Seat& seat) {
  return static_cast<double>((seat.weight.array() > 0).count());
}

/// Squares of the remainder, over the noise.
double squares_of(const Seat& seat) {
  constexpr double kTiny = 1e-300;  // against a division by zero
  const auto shown = seat.weight.array() > 0;
  return shown.select(seat.product.array().square() / seat.weight.array().max(kTiny), 0.0).sum();
}

}  // namespace

bool Seat::is_sensor() const { return !effects::moves_the_robot(place); }

double Seat::left() const {
  return std::sqrt(squares_of(*this) / std::max(rows_shown(*this), 1.0));
}

double Seat::beyond_noise() const { return squares_of(*this) - rows_shown(*this); }

Rows::Rows(const Observations& observations) {
  constexpr Eigen::Index kMostRows = 3000;  // time: every shape of every driver is computed on them
  Eigen::Index all = 0;
  for (const Scene& scene : observations.scenes) {
    all += scene.rows();
  }
  each = std::max<Eigen::Index>(1, (all + kMostRows - 1) / kMostRows);
  time.resize(all);
  for (const Scene& scene : observations.scenes) {
    first.push_back(count);
    for (Eigen::Index row = 0; row < scene.rows(); row += each) {
      stretch.push_back(stretches + static_cast<int>(stretch_of(row, scene.rows())));
      time[count++] = scene.time[row];
    }
    stretches += static_cast<int>(kHoldoutStretches);
  }
  time.conservativeResize(count);
}

Eigen::VectorXd Rows::of(const Eigen::VectorXd& values) const {
  Eigen::VectorXd taken((values.size() + each - 1) / each);
  for (Eigen::Index i = 0; i < taken.size(); ++i) {
    taken[i] = values[i * each];
  }
  return taken;
}

Eigen::Index Rows::at(std::size_t scene, Eigen::Index row) const {
  return row % each == 0 ? first[scene] + row / each : -1;
}

Eigen::Index Rows::rows(std::size_t scene) const {
  return (scene + 1 < first.size() ? first[scene + 1] : count) - first[scene];
}

Eigen::VectorXd levers_of(const Observations& observations, const effects::LawPlace& place) {
  std::vector<Prediction> moved;
  for (const Simulation& at : observations.simulations) {
    Prediction prediction = at.prediction;
    for (Eigen::MatrixXd& channel : prediction.channel) {
      channel.setZero();
    }
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(at.q.rows());
    effects::add_at(place, ones, ones, at, &prediction);
    moved.push_back(std::move(prediction));
  }
  return observations.stacked(moved);
}

std::vector<Seat> seats_of(const Observations& observations, const Rows& rows, const Fit& fit) {
  const Eigen::Index train = observations.train;
  const Eigen::MatrixXd base = linear_algebra::orthonormal_basis(fit.derivative.topRows(train));
  Eigen::VectorXd left = clipped(fit.remainder.head(train));
  // What a few more steps of the fit would take away is no law's.
  left -= base * (base.transpose() * left);
  std::vector<Seat> seats;
  for (const Words& words : places_of(observations)) {
    Seat seat{effects::read_place(words.name, words.axis, words.joint),
              words.name,
              words.axis,
              Eigen::VectorXd::Zero(rows.count),
              Eigen::VectorXd::Zero(rows.count),
              Eigen::MatrixXd::Zero(rows.count, base.cols())};
    const Eigen::VectorXd lever = levers_of(observations, seat.place);
    for (Eigen::Index i = 0; i < train; ++i) {
      const Sample& at = observations.samples[static_cast<std::size_t>(i)];
      const Eigen::Index row = rows.at(at.scene, at.row);
      if (row < 0) {
        continue;
      }
      seat.weight[row] += lever[i] * lever[i];
      seat.product[row] += lever[i] * left[i];
      seat.fitted.row(row) += lever[i] * base.row(i);
    }
    if (seat.weight.sum() > 0 && seat.left() > kMoreThanNoise) {
      seats.push_back(std::move(seat));
    }
  }
  return seats;
}

}  // namespace flexcomp::diagnosis::grammar
