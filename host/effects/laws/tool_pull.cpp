#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

using Place = Eigen::Map<const Vector3<double>>;

/// The force on the tool at every row; values: pull, stiffness, and the place where it hangs.
Term pull_toward(const Values& values) {
  return {Term::wrench, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            Eigen::MatrixXd wrench = Eigen::MatrixXd::Zero(scene.rows(), 6);
            for (Eigen::Index row = 0; row < wrench.rows(); ++row) {
              const Vector3<double> toward =
                  Place(&values[2]) - at.bent[static_cast<std::size_t>(row)].tcp.position;
              const double distance = toward.norm();
              if (distance > 0) {
                const double force = values[0] + values[1] * distance;
                wrench.row(row).head<3>() = force / distance * toward.transpose();
              }
            }
            add_wrench(at, wrench, prediction);
          }};
}

}  // namespace

// A hose, a cable, a tool balancer or a spring that hangs from a place beside the robot and pulls
// at the TCP, which no force sensor behind it shows: toward the place with P + k d, d its distance.
// A spring of rest length l has P = -k l.
Forms laws::tool_pull() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 2;
  law.traits.is_curved = true;
  law.parameters =
      constant({{"pull", "N"}, {"stiffness", "N/m"}, {"x", "m"}, {"y", "m"}, {"z", "m"}});
  law.words = "pull at the tool";
  law.statement = says("a hose, a cable or a spring pulls the tool toward a place");
  law.apply = [](const Values& values, int /*joint*/, Machine* machine) {
    machine->terms.push_back(pull_toward(values));
    machine->needs_levers = true;
  };
  return {{law},
          {},
          {{"", " pull ", [](const Subject& of) { return within(10 * of.size.payload * kGravity); },
            "a spring stretched to ten times the weight that the robot carries would tear it"},
           {"", " stiffness ",
            [](const Subject& of) { return within(10 * of.size.payload * kGravity); },
            "hoses, cables and balancers pull by less than ten payloads more for every metre"},
           {"", " x y z ", [](const Subject& of) { return within(3 * of.size.reach); },
            "ceilings, stands and gantries are near the robot; from farther off it is a constant "
            "force"}}};
}

}  // namespace flexcomp::effects
