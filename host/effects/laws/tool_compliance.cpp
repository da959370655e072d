#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Range tool_shift(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(of.parameter.back() - 'x');
  return change(of.robot.elastic.tool_compliance[axis],
                softest(kMostShift, kShiftOfReach * of.size.reach, of.size.force));
}

/// The spring gives by the wrench alone. Most springs are so stiff that levers stay as they are.
Term holder(const Values& values, int /*joint*/) {
  return {Term::output, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
            const Eigen::Map<const Vector3<double>> compliance(values.data());
            for (Eigen::Index row = 0; row < scene.rows() && position.cols() > 0; ++row) {
              const Matrix3<double>& tool = at.bent[static_cast<std::size_t>(row)].tcp.rotation;
              const Vector3<double> force = at.wrench.row(row).head<3>().transpose();
              const Vector3<double> give = compliance.cwiseProduct(tool.transpose() * force);
              position.row(row) += (tool * give).transpose();
            }
          }};
}

}  // namespace

// Spindle, holder or flange give: a diagonal spring at the tool frame (Klimchik et al. 2017). Its
// rotations do not move the TCP. By the model's key the payload hangs on it, as on a flange that
// gives; in the form `holder` the payload is in front of it, as a spindle is whose holder gives.
Forms laws::tool_compliance() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 3;
  law.traits.is_in_family = true;
  law.parameters = constant({{"x", "m/N"}, {"y", "m/N"}, {"z", "m/N"}});
  law.statement = says("spindle, holder or flange give");
  Law beyond_payload = law;
  beyond_payload.form = "holder";
  beyond_payload.traits.is_in_family = false;
  beyond_payload.statement = says("the holder gives, beyond the payload");
  beyond_payload.apply = [](const Values& values, int joint, Machine* machine) {
    machine->terms.push_back(holder(values, joint));
    machine->needs_levers = true;
  };
  alter_keys(
      [](const Values& values, int, model::Robot* robot) {
        robot->elastic.tool_compliance.head<3>() +=
            Eigen::Map<const Vector3<double>>(values.data());
      },
      &law);
  return {
      {law, beyond_payload},
      {},
      {{"", " x y z ", tool_shift,
        "a tool that gives by a twentieth of the arm's reach under the force it bore is broken"}}};
}

}  // namespace flexcomp::effects
