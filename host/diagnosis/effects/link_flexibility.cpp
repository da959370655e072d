#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Force and moment about a point of all that acts on the link and beyond: wrench and weights.
void load_beyond(const RobotModel<double, 6>& robot, const Kinematics<double, 6>& at,
                 const Wrench<double>& wrench, std::size_t first, const Vector3<double>& point,
                 Vector3<double>* force, Vector3<double>* moment) {
  *force = wrench.head<3>();
  *moment = wrench.tail<3>() + (at.tcp.position - point).cross(*force);
  const auto add = [&](double mass, const Vector3<double>& center) {
    *force += mass * robot.gravity;
    *moment += (center - point).cross(mass * robot.gravity);
  };
  for (std::size_t i = first; i < 6; ++i) {
    add(robot.joints[i].mass,
        at.links[i].position + at.links[i].rotation * robot.joints[i].center_of_mass);
  }
  add(robot.payload_mass, at.tcp.position + at.tcp.rotation * robot.payload_center);
}

/// At half of its length force and moment of a cantilever do not mix: it turns there by
/// `compliance` times the moment and moves by compliance·length²/12 times the force, both across.
simulation::Term bending_beam(const RobotModel<double, 6>& robot, int joint, double compliance) {
  const auto add = [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
    const auto link = static_cast<std::size_t>(joint - 1);
    const Vector3<double> beam = robot.joints[link + 1].origin.position;
    const double length = beam.norm();
    const Matrix3<double> across =
        Matrix3<double>::Identity() - beam * beam.transpose() / (length * length);
    Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
    for (Eigen::Index row = 0; row < scene.rows() && position.cols() > 0; ++row) {
      const Kinematics<double, 6>& bent = at.bent[static_cast<std::size_t>(row)];
      const Pose<double>& frame = bent.links[link];
      const Vector3<double> middle = frame.position + frame.rotation * (0.5 * beam);
      Vector3<double> force;
      Vector3<double> moment;
      load_beyond(robot, bent, at.wrench.row(row).transpose(), link, middle, &force, &moment);
      const Matrix3<double> base = frame.rotation * across * frame.rotation.transpose();
      const Vector3<double> turn = compliance * base * moment;
      const Vector3<double> shift = compliance * length * length / 12 * base * force;
      position.row(row) += (shift + turn.cross(bent.tcp.position - middle)).transpose();
    }
  };
  return {simulation::Term::output, add};
}

}  // namespace

// The link that a joint moves bends or twists: springs across the joint's axis at its root
// (virtual-joint model, Klimchik et al. 2017), or a cantilever beam as long as the link (Euler and
// Bernoulli). About the axis itself it cannot be told from the joint's spring. Needs the TCP, and
// load.
std::vector<Hypothesis> link_flexibility(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::tcp_position) &&
        (observations.has_wrench() || observations.has_weight()))) {
    return all;
  }
  for (int joint = 1; joint <= 5; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "link_flexibility";
    hypothesis.joint = joint;
    hypothesis.statement = fmt::format("the link that joint {} moves gives", joint);
    const std::size_t index = static_cast<std::size_t>(joint - 1);
    Eigen::Index along = 0;
    observations.machine.robot.elastic.joints[index].axis.cwiseAbs().maxCoeff(&along);
    hypothesis.parameters.clear();
    const Eigen::Index across[] = {(along + 1) % 3, (along + 2) % 3};
    for (const Eigen::Index axis : across) {
      hypothesis.parameters.push_back(
          {fmt::format("bending_{}", "xyz"[axis]), "rad/(N·m)", 0, 1, 1e-7});
    }
    hypothesis.form = "springs";
    hypothesis.linear = 2;
    hypothesis.alters_model = true;
    hypothesis.apply = [index, first = across[0], second = across[1]](const Values& values,
                                                                      Machine* machine) {
      DiagonalCompliance<double>& link = machine->robot.elastic.joints[index].link_compliance;
      link[3 + first] += values[0];
      link[3 + second] += values[1];
    };
    all.push_back(hypothesis);
    if (observations.machine.robot.elastic.joints[index + 1].origin.position.norm() < 0.2) {
      continue;
    }
    hypothesis.parameters = {{"beam", "rad/(N·m)", 0, 1, 1e-7}};
    hypothesis.form = "beam";
    hypothesis.linear = 1;
    hypothesis.alters_model = false;
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back(bending_beam(machine->robot.elastic, joint, values[0]));
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
