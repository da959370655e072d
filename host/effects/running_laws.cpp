#include "effects/running_laws.hpp"

#include <fmt/format.h>

#include <cmath>

#include "effects/learned.hpp"
#include "error.hpp"

namespace flexcomp::effects {
namespace {

/// A scene of one row that shows the TCP alone.
Scene one_row(int joints) {
  Scene scene;
  scene.file = "the plant";
  scene.time = Eigen::VectorXd::Zero(1);
  scene.has_wrench = true;
  scene.q = scene.velocity = scene.acceleration = Eigen::MatrixXd::Zero(1, joints);
  scene.wrench = Eigen::MatrixXd::Zero(1, 6);
  scene.measured[simulation::tcp_position] = Eigen::MatrixXd::Zero(1, 3);
  return scene;
}

std::vector<double> values_of_parameters(const BoundFormula& bound, const Values& parameters) {
  std::vector<double> values(bound.signals.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = bound.signals[i] ? 0 : parameters[bound.parameter[i]];
  }
  return values;
}

}  // namespace

RunningLaws::RunningLaws(const model::Robot& robot, double period)
    : machine_(robot), period_(period), scene_(one_row(robot.joints())) {
  for (const Placed& placed : listed_effects(robot)) {
    if (!placed.law->bound || !placed.law->traits.can_be_undone) {
      continue;
    }
    const BoundFormula& bound = *placed.law->bound;
    if (bound.follows(SignalKind::temperature)) {
      throw InputError(fmt::format("{}: follows temp_c, and the plant has no temperature",
                                   bound.written.where.at("formula")));
    }
    laws_.push_back({placed.law->bound, formula::Course(bound.formula),
                     values_of_parameters(bound, placed.values)});
  }
}

Vector3<double> RunningLaws::next(const model::JointValues& q, const Wrench<double>& wrench) {
  const Eigen::RowVectorXd speed =
      has_begun_ ? Eigen::RowVectorXd((q.transpose() - scene_.q.row(0)) / period_)
                 : Eigen::RowVectorXd::Zero(q.size());
  scene_.acceleration.row(0) = has_begun_
                                   ? Eigen::RowVectorXd((speed - scene_.velocity.row(0)) / period_)
                                   : Eigen::RowVectorXd::Zero(q.size());
  scene_.velocity.row(0) = speed;
  scene_.q.row(0) = q.transpose();
  scene_.wrench.row(0) = wrench.transpose();
  scene_.time[0] += has_begun_ ? period_ : 0;
  has_begun_ = true;
  const Simulation at = simulate(machine_, scene_);
  Prediction prediction = at.prediction;
  for (Running& law : laws_) {
    const BoundFormula& bound = *law.bound;
    for (std::size_t i = 0; i < law.values.size(); ++i) {
      if (bound.signals[i]) {
        law.values[i] =
            values_of(*bound.signals[i], scene_, at, at.prediction, Loads::at_rest, 0)[0];
      }
    }
    const double value = law.course.next(law.values, period_);
    if (!std::isfinite(value)) {
      refuse_unvalued(bound, law.values, scene_.file, scene_.time[0]);
    }
    const Eigen::VectorXd row = Eigen::VectorXd::Constant(1, value);
    add_at(bound.place, row, row, at, &prediction);
  }
  return (prediction.channel[simulation::tcp_position] -
          at.prediction.channel[simulation::tcp_position])
      .transpose();
}

}  // namespace flexcomp::effects
