#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Law coupled(const char* form, const char* statement) {
  Law law;
  law.form = form;
  law.joints = all_but_the_first;
  law.traits.is_curved = true;
  law.parameters = constant({{"ratio", "1"}});
  law.words = "coupling of the drives";
  law.statement = says(statement);
  return law;
}

void couple(const Values& values, int joint, model::Robot* robot) {
  robot->transmission(joint - 1, joint - 2) += values[0];
}

Law with_torques_of_joints() {
  Law law = coupled("", "the motor of joint {} turns with the joint before it as well");
  law.traits.couples_drives = true;
  alter_keys(couple, &law);
  return law;
}

Law with_torques_of_motors() {
  Law law = coupled("motor_torques",
                    "the motor of joint {} turns with the joint before it as well, and the torques "
                    "are those of the motors");
  law.traits.alters_model = true;
  law.traits.can_be_undone = false;
  law.apply = [](const Values& values, int joint, Machine* machine) {
    couple(values, joint, &machine->robot);
    machine->shows_motor_torques = true;
  };
  return law;
}

}  // namespace

// A motor that turns with the joint before its own as well, by so many turns of its own joint a
// turn of that one: a coupled wrist, whose last motors sit in the forearm (Siciliano et al. 2009,
// Robotics, section 7.2: friction and rotors act by the motors' speeds). Forms: the torques are
// those of the joints, or of the motors, as a drive's current tells them.
Forms laws::transmission() {
  return {{with_torques_of_joints(), with_torques_of_motors()},
          {},
          {{"", " ratio ", [](const Subject&) { return within(3); },
            "wrists are coupled one to one, or by the quotient of two gear ratios"}}};
}

}  // namespace flexcomp::effects
