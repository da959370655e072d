#include "diagnosis/plausible.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "diagnosis/fit.hpp"
#include "simulation/inverse_dynamics.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kRestTolerance = 1e-3;  // of a parameter's step
constexpr double kFullyPositive = 1e-9;  // of the largest eigenvalue
constexpr Eigen::Index kPostures = 10;   // of a scene in which the inertia matrix is looked at

/// Judgement of a number that rests on a bound.
enum AtBound { kBoundTellsNothing, kBoundIsPossible };

/// Why a number cannot be; empty if it can.
std::string why_not(const Parameter& parameter, const Range& range, double value,
                    AtBound at_bound) {
  const double tolerance = kRestTolerance * parameter.step;
  if (!std::isfinite(value) || value < range.lower - tolerance || value > range.upper + tolerance) {
    return fmt::format("{} of {:.3g} {} cannot be: {}", parameter.name, value, parameter.unit,
                       range.source);
  }
  const bool below = range.rest == Rest::below || range.rest == Rest::both;
  const bool above = range.rest == Rest::above || range.rest == Rest::both;
  if (at_bound == kBoundTellsNothing && ((value <= parameter.lower + tolerance && !below) ||
                                         (value >= parameter.upper - tolerance && !above))) {
    return fmt::format("{} rests on its bound of {:.3g} {}", parameter.name, value, parameter.unit);
  }
  return "";
}

/// Joint-space inertia matrix of the arm with its rotors, kg·m².
model::JointMatrix inertia_matrix(const model::Robot& robot, const model::JointValues& q) {
  model::Robot weightless = robot;
  weightless.elastic.gravity.setZero();
  const Eigen::Index joints = q.size();
  const model::JointValues at_rest = model::JointValues::Zero(joints);
  model::JointMatrix inertia(joints, joints);
  for (Eigen::Index joint = 0; joint < joints; ++joint) {
    inertia.col(joint) = simulation::inverse_dynamics(weightless, q, at_rest,
                                                      model::JointValues::Unit(joints, joint));
    inertia(joint, joint) += robot.dynamics[static_cast<std::size_t>(joint)].rotor_inertia;
  }
  return inertia;
}

bool is_positive(const model::JointMatrix& inertia) {
  const Eigen::SelfAdjointEigenSolver<model::JointMatrix> solver(inertia, Eigen::EigenvaluesOnly);
  const auto& eigenvalues = solver.eigenvalues();  // in rising order
  return eigenvalues[0] > kFullyPositive * eigenvalues[eigenvalues.size() - 1];
}

bool can_move(const Observations& observations, const model::Robot& learned) {
  for (const Scene& scene : observations.scenes) {
    const Eigen::Index step = std::max<Eigen::Index>(scene.rows() / kPostures, 1);
    for (Eigen::Index row = 0; row < scene.rows(); row += step) {
      const model::JointValues q = scene.q.row(row).transpose();
      if (!is_positive(inertia_matrix(learned, q)) &&
          is_positive(inertia_matrix(observations.machine.robot, q))) {
        return false;
      }
    }
  }
  return true;
}

/// Why masses cannot be so, of a machine in which a law that changes them acts; empty if they can.
std::string why_no_body(const Observations& observations, const MachineSize& size,
                        const Hypothesis& hypothesis, const model::Robot& learned) {
  const effects::Law& law = *hypothesis.law;
  if (law.excess &&
      !law.excess(observations.machine.robot, learned, size, hypothesis.joint, 0).isZero(0)) {
    return law.no_body;
  }
  return !hypothesis.traits().tells_inertia || can_move(observations, learned)
             ? ""
             : "an arm of negative inertia cannot be";
}

/// The robot while one of a fit's hypotheses acts, which may have ceased since.
model::Robot robot_with(const Observations& observations, const Fit& fit, const Chosen& chosen) {
  return chosen.hypothesis.when ? machine_with(observations, acting(fit.chosen)).robot
                                : fit.machine.robot;
}

/// Why one of a fit's hypotheses, as fitted, cannot be so; empty if it can.
std::string why_not_so(const Observations& observations, const Fit& fit, std::size_t index,
                       AtBound at_bound) {
  const Chosen& chosen = fit.chosen[index];
  const MachineSize size = size_of(observations);
  for (std::size_t i = 0; i < chosen.values.size(); ++i) {
    const Parameter& parameter = chosen.hypothesis.parameters[i];
    const Range range = plausible_range(*chosen.hypothesis.law, observations.machine.robot, size,
                                        chosen.hypothesis.joint, parameter.name);
    std::string why = why_not(parameter, range, chosen.values[i], at_bound);
    if (!why.empty()) {
      return why;
    }
  }
  return why_no_body(observations, size, chosen.hypothesis, robot_with(observations, fit, chosen));
}

}  // namespace

MachineSize size_of(const Observations& observations) {
  MachineSize size = size_of(observations.machine.robot);
  for (int joint = 1; joint <= observations.machine.robot.joints(); ++joint) {
    size.load[static_cast<std::size_t>(joint - 1)] = observations.largest_load(joint);
  }
  for (const Scene& scene : observations.scenes) {
    size.force = std::max(size.force, scene.wrench.leftCols<3>().rowwise().norm().maxCoeff());
  }
  return size;
}

void keep_plausible(const model::Robot& robot, const MachineSize& size, Hypothesis* hypothesis) {
  for (std::size_t i = 0; i < hypothesis->parameters.size(); ++i) {
    Parameter& parameter = hypothesis->parameters[i];
    Range range = plausible_range(*hypothesis->law, robot, size, hypothesis->joint, parameter.name);
    if (i < hypothesis->linear) {  // the model as it is, is believed to be
      range.lower = std::min(range.lower, 0.0);
      range.upper = std::max(range.upper, 0.0);
    }
    const double lower = std::max(parameter.lower, range.lower);
    const double upper = std::min(parameter.upper, range.upper);
    if (lower > upper) {
      hypothesis->starts.clear();
      continue;
    }
    parameter.lower = lower;
    parameter.upper = upper;
  }
}

std::string why_impossible(const Observations& observations, const Fit& fit, std::size_t index) {
  return why_not_so(observations, fit, index, kBoundTellsNothing);
}

bool could_be(const Observations& observations, const Fit& fit, std::size_t index) {
  if (fit.chosen[index].hypothesis.is_regression) {
    return true;
  }
  const bool is_body = fit.chosen[index].hypothesis.traits().is_body;
  return why_not_so(observations, fit, index, is_body ? kBoundIsPossible : kBoundTellsNothing)
      .empty();
}

}  // namespace flexcomp::diagnosis
