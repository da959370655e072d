#include <cmath>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

/// Torque by the joint's angle; values: stiffness torque K, pull torque P, anchor ratio r, zero
/// angle.
double balancing_torque(const Values& values, double q) {
  const double lean = q + values[3];
  const double length = std::sqrt(1 + values[2] * values[2] - 2 * values[2] * std::cos(lean));
  return -std::sin(lean) * (values[0] + values[1] / length);
}

double sine_torque(const Values& values, double q) {
  return -values[0] * std::sin(q) - values[1] * std::cos(q);
}

using Balance = double (*)(const Values&, double q);

void balance(Law* law, Balance torque_at) {
  law->traits.alters_model = true;
  law->apply = [torque_at](const Values& values, int joint, Machine* machine) {
    machine->balancers.emplace_back([=](const simulation::JointValues& q) {
      simulation::JointValues torque = simulation::JointValues::Zero(q.size());
      torque[joint - 1] = torque_at(values, q[joint - 1]);
      return torque;
    });
  };
}

/// To first order: the drives and springs carry so much less.
Term balancer(const Values& values, int joint) {
  return {Term::wrench, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::Index column = joint - 1;
            const Eigen::VectorXd torque =
                at.q.col(column).unaryExpr([&](double q) { return balancing_torque(values, q); });
            add_joint_angle(at, joint, at.joint_compliance[column] * torque, prediction);
            prediction->load.col(column) += torque;
            if (prediction->dynamic_load.cols() > 0) {
              prediction->dynamic_load.col(column) += torque;
            }
            add_torque(joint, -torque, prediction);
          }};
}

}  // namespace

// A coil spring or gas balancer between two links, missing from the model: anchored at distances a
// and b from the joint's axis, l apart, it pulls with F0 + k (l - l0). Its torque is -sin(lean) (K
// + P / l'), with l' = sqrt(1 + r^2 - 2 r cos(lean)), lean the angle from where it does nothing, r
// = b/a. The form `sine` is P = 0, a spring that pulls in proportion to its whole length: all that
// small ranges of the angle can tell, and the curve by which a link's mass pulls too.
Forms laws::gravity_compensator() {
  Law spring;
  spring.joints = every_joint;
  spring.traits.linear_in = 2;
  spring.traits.is_of_few = true;
  spring.words = "gravity compensator";
  spring.statement = says("a balancer acts on joint {}");
  spring.impossible = [](const model::Robot& robot, int joint) {
    return robot.elastic.joint(joint - 1).slides() ? "it slides, and a balancer leans" : "";
  };
  Law sine = spring;
  spring.parameters = constant({{"stiffness_torque", "N·m"},
                                {"pull_torque", "N·m"},
                                {"anchor_ratio", "1"},
                                {"zero_angle", "rad"}});
  balance(&spring, balancing_torque);
  spring.sketch = balancer;
  sine.form = "sine";
  sine.traits.is_curve_only = true;
  sine.traits.joins_family = true;
  sine.parameters = constant({{"sine_torque", "N·m"}, {"cosine_torque", "N·m"}});
  balance(&sine, sine_torque);
  return {
      {spring, sine},
      {},
      {{"", " stiffness_torque pull_torque ",
        [](const Subject& of) { return within(10 * of.size.weight_torque); },
        "a balancer holds about the arm's weight; its preload and rate may work against each "
        "other"},
       {"", " sine_torque cosine_torque ",
        [](const Subject& of) { return within(3 * of.size.weight_torque); },
        "a balancer holds about the arm's weight"},
       {"", " anchor_ratio ",
        [](const Subject&) {
          return Range{0, 1, Rest::below};
        },
        "anchored at the same distance twice it would fold; near the axis its torque is a sine"},
       {"", " zero_angle ",
        [](const Subject&) {
          return Range{-4, 4, Rest::both};
        },
        "any angle is one of half a revolution either way"}}};
}

}  // namespace flexcomp::effects
