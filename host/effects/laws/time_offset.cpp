#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

using simulation::Channel;

Term late_channel(Channel channel, double delay) {
  return {Term::clock, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
            Eigen::MatrixXd& values = prediction->channel[channel];
            if (values.cols() > 0 && !scene.is_static) {
              values = simulation::delayed_smoothly(scene.time, values, delay);
              if (channel == simulation::joint_deflection) {
                // Late link encoders show the whole angle late, not the wind-up alone.
                values += simulation::delayed_motion(scene.time, scene.q, scene.velocity, delay) -
                          scene.q;
              }
            }
          }};
}

Term late_wrench(double delay) {
  return {Term::wrench, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            if (!scene.is_static) {
              add_wrench(at, simulation::delayed(scene.time, at.wrench, -delay) - at.wrench,
                         prediction);
            }
          }};
}

Law clock_law(const char* form, const char* clock) {
  Law law;
  law.form = form;
  law.joints = whole_machine;
  law.traits.is_clock = true;
  law.parameters = constant({{"delay", "s"}});
  law.words = "clocks that disagree";
  law.statement = [clock](int) {
    return fmt::format("the clock of the {} disagrees with that of the joint angles", clock);
  };
  return law;
}

Law of_channel(Channel channel, const char* clock) {
  Law law = clock_law(simulation::kChannels[channel], clock);
  law.traits.can_be_undone = false;
  // Friction turns with the motion: a late torque is far from proportion to its delay.
  law.traits.linear_in = channel == simulation::joint_torque ? 0 : 1;
  law.traits.is_in_family = law.traits.linear_in > 0;
  add_term([channel](const Values& values, int) { return late_channel(channel, values[0]); }, &law);
  return law;
}

Law of_wrench() {
  Law law = clock_law("wrench", "force sensor");
  law.traits.alters_model = true;
  law.apply = [](const Values& values, int, Machine* machine) {
    machine->wrench_delay += values[0];
  };
  law.sketch = [](const Values& values, int) { return late_wrench(values[0]); };
  return law;
}

}  // namespace

// Two clocks of the recording disagree: a group of columns belongs to an earlier time than the
// joint angles beside it. Forms: the group.
Forms laws::time_offset() {
  return {{of_channel(simulation::tcp_position, "TCP measurement"),
           of_channel(simulation::joint_torque, "torques"),
           of_channel(simulation::joint_deflection, "link encoders"), of_wrench()},
          {},
          {{"", " delay ", [](const Subject&) { return within(10); },
            "loggers' clocks are set by hand or by a network: to seconds, or far better"}}};
}

}  // namespace flexcomp::effects
