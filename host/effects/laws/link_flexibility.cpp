#include <array>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kLinkTurn = 0.02;  // rad, under the load that it bore

/// Force and moment about a point of all that acts on the link and beyond: wrench and weights.
void load_beyond(const model::Chain& robot, const model::ChainKinematics& at,
                 const Wrench<double>& wrench, std::size_t first, const Vector3<double>& point,
                 Vector3<double>* force, Vector3<double>* moment) {
  *force = wrench.head<3>();
  *moment = wrench.tail<3>() + (at.tcp.position - point).cross(*force);
  const auto add = [&](double mass, const Vector3<double>& center) {
    *force += mass * robot.gravity;
    *moment += (center - point).cross(mass * robot.gravity);
  };
  for (std::size_t i = first; i < robot.joints.size(); ++i) {
    add(robot.joints[i].mass,
        at.links[i].position + at.links[i].rotation * robot.joints[i].center_of_mass);
  }
  add(robot.payload_mass, at.tcp.position + at.tcp.rotation * robot.payload_center);
}

/// From the joint to the next one, in the link's frame.
const Vector3<double>& beam_of(const model::Chain& robot, int joint) {
  return robot.joints[index_of(joint) + 1].origin.position;
}

/// At half of its length force and moment of a cantilever do not mix: it turns there by
/// `compliance` times the moment and moves by compliance·length²/12 times the force, both across.
Term bending_beam(const model::Chain& robot, int joint, double compliance) {
  const auto add = [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
    const std::size_t link = index_of(joint);
    const Vector3<double> beam = beam_of(robot, joint);
    const double length = beam.norm();
    const Matrix3<double> across =
        Matrix3<double>::Identity() - beam * beam.transpose() / (length * length);
    Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
    for (Eigen::Index row = 0; row < scene.rows() && position.cols() > 0; ++row) {
      const model::ChainKinematics& bent = at.bent[static_cast<std::size_t>(row)];
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
  return {Term::output, add};
}

Law springs() {
  Law law;
  law.form = "springs";
  law.joints = every_joint;
  law.traits.linear_in = 2;
  law.parameters = [](const model::Robot& robot, int joint) {
    return of_axes(axes_across_joint(robot, joint), "bending_", "rad/(N·m)");
  };
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        const std::array<int, 2> axes = axes_across_joint(*robot, joint);
        DiagonalCompliance<double>& link = robot->elastic.joints[index_of(joint)].link_compliance;
        link[3 + axes[0]] += values[0];
        link[3 + axes[1]] += values[1];
      },
      &law);
  return law;
}

Law beam() {
  Law law;
  law.form = "beam";
  law.joints = all_but_the_last;
  law.traits.linear_in = 1;
  law.parameters = constant({{"beam", "rad/(N·m)"}});
  law.impossible = [](const model::Robot& robot, int joint) {
    return beam_of(robot.elastic, joint).norm() > 0 ? "" : "its link has no length";
  };
  law.apply = [](const Values& values, int joint, Machine* machine) {
    machine->terms.push_back(bending_beam(machine->robot.elastic, joint, values[0]));
  };
  return law;
}

}  // namespace

// The link that a joint moves bends or twists: springs across the joint's axis at its root
// (virtual-joint model, Klimchik et al. 2017), or a cantilever beam as long as the link (Euler and
// Bernoulli). About the axis itself it cannot be told from the joint's spring.
Forms laws::link_flexibility() {
  Forms forms{
      {springs(), beam()},
      {},
      {{"", " bending_x bending_y bending_z beam ",
        [](const Subject& of) { return up_to(softest(kMostTurn, kLinkTurn, of.largest_load())); },
        "a slender aluminium link that bends by 0.02 rad is strained to half of what it yields at "
        "(yield strain 0.4 %, five times as long as high): no arm is built so"}}};
  for (Law& law : forms.laws) {
    law.words = "flexibility of the link";
    law.statement = says("the link that joint {} moves gives");
  }
  return forms;
}

}  // namespace flexcomp::effects
