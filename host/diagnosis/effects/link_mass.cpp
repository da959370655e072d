#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Adds a point mass at the link's origin and a first moment (kg·m), which has no inertia of its
/// own.
void mount(double mass, const Vector3<double>& moment, std::size_t index, model::Robot* robot) {
  Joint<double>& link = robot->elastic.joints[index];
  const auto about_origin = [](double m, const Vector3<double>& c) {
    return Matrix3<double>(m * (c.squaredNorm() * Matrix3<double>::Identity() - c * c.transpose()));
  };
  const Matrix3<double> inertia =
      robot->link_inertia[index] + about_origin(link.mass, link.center_of_mass);
  const Vector3<double> total = link.mass * link.center_of_mass + moment;
  link.mass = std::max(link.mass + mass, 1e-3);
  link.center_of_mass = total / link.mass;
  robot->link_inertia[index] = inertia - about_origin(link.mass, link.center_of_mass);
}

}  // namespace

// Mass of a link that differs from the model's: the same body heavier or lighter in all its parts,
// or mass and first moment (link frame) of something mounted on it. Needs gravity in the model or,
// for torques, motion.
std::vector<Hypothesis> link_mass(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has_weight() || observations.has(simulation::joint_torque))) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "link_mass";
    hypothesis.joint = joint;
    const auto index = static_cast<std::size_t>(joint - 1);
    const double mass = observations.machine.robot.elastic.joints[index].mass;
    hypothesis.statement = fmt::format("the link that joint {} moves has another mass", joint);
    hypothesis.alters_model = true;
    if (mass > 0) {
      hypothesis.parameters = {{"mass", "kg", -0.95 * mass, 10 * mass, 0.1 * mass}};
      hypothesis.form = "body";
      hypothesis.linear = 1;
      hypothesis.apply = [index](const Values& values, Machine* machine) {
        Joint<double>& link = machine->robot.elastic.joints[index];
        machine->robot.link_inertia[index] *= 1 + values[0] / link.mass;
        link.mass += values[0];
      };
      all.push_back(hypothesis);
    }
    // A moment that is more than the link's own (or much for what can be mounted on a small one) is
    // no mass: a balancer pulls so.
    const double most = std::max(
        50.0, mass * observations.machine.robot.elastic.joints[index].center_of_mass.norm());
    hypothesis.parameters = {{"mass", "kg", -0.95 * mass, 2000, 10},
                             {"mx", "kg·m", -most, most, 1},
                             {"my", "kg·m", -most, most, 1},
                             {"mz", "kg·m", -most, most, 1}};
    hypothesis.form = "mounted";
    hypothesis.linear = 4;
    hypothesis.apply = [index](const Values& values, Machine* machine) {
      mount(values[0], {values[1], values[2], values[3]}, index, &machine->robot);
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
