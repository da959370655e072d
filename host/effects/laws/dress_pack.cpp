#include "effects/hose.hpp"
#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

/// Values of the law.
struct Hose {
  double stiffness;     ///< N/m
  double friction;      ///< N
  double slack_length;  ///< m
  HoseEnds ends;
};

Hose hose_of(const Values& values) {
  using Place = Eigen::Map<const Vector3<double>>;
  return {values[0], values[1], values[2], {Place(&values[3]), Place(&values[6])}};
}

Eigen::VectorXd tension_of(const Hose& hose, const HoseCourse& course) {
  return hose.stiffness * stretch(course, hose.slack_length) +
         hose.friction * course.direction.cast<double>();
}

/// Drives and springs carry what the hose does not.
void add_tension(const HoseCourse& course, const Eigen::VectorXd& tension, int first_joint,
                 const Simulation& at, Prediction* prediction) {
  for (Eigen::Index column = first_joint - 1; column < course.slope.cols(); ++column) {
    const Eigen::VectorXd torque = -tension.cwiseProduct(course.slope.col(column));
    const int joint = static_cast<int>(column) + 1;
    add_joint_angle(at, joint, at.joint_compliance[column] * torque, prediction);
    prediction->load.col(column) += torque;
    if (prediction->dynamic_load.cols() > 0) {
      prediction->dynamic_load.col(column) += torque;
    }
    add_torque(joint, -torque, prediction);
  }
}

/// Neither the first, as nothing moves before it, nor the last, on which it is a torque alone.
std::vector<int> all_in_between(int joints) {
  std::vector<int> places = all_but_the_first(joints);
  if (!places.empty()) {
    places.pop_back();
  }
  return places;
}

}  // namespace

// A hose, cable or dress pack along the arm, held on the link before a joint and at the tool. It
// pulls its ends together with k (l − l0) where it is longer than l0, and with nothing where it is
// slack; one whose l0 is below zero pulls everywhere. Its guide holds it against the motion, as dry
// friction.
Forms laws::dress_pack() {
  Law law;
  law.joints = all_in_between;
  law.traits.linear_in = 2;
  law.traits.is_curved = true;
  law.traits.is_of_few = true;
  law.parameters = constant({{"stiffness", "N/m"},
                             {"friction", "N"},
                             {"slack_length", "m"},
                             {"arm_x", "m"},
                             {"arm_y", "m"},
                             {"arm_z", "m"},
                             {"tool_x", "m"},
                             {"tool_y", "m"},
                             {"tool_z", "m"}});
  law.words = "dress pack";
  law.statement = says("a hose or cable from the link before joint {} to the tool pulls");
  law.apply = [](const Values& values, int joint, Machine* machine) {
    machine->needs_levers = true;
    machine->terms.push_back(
        {Term::wrench, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
           const Hose hose = hose_of(values);
           const HoseCourse course = hose_course(at, joint, hose.ends, {1, scene.rows()});
           add_tension(course, tension_of(hose, course), joint, at, prediction);
         }});
  };
  return {
      {law},
      {},
      {{"", " stiffness ", [](const Subject& of) { return up_to(10 * of.size.payload * kGravity); },
        "hoses and cables pull by less than ten payloads more for every metre"},
       {"", " friction ", [](const Subject& of) { return up_to(of.size.payload * kGravity); },
        "a hose rubs with less than the weight that the robot carries"},
       {"", " slack_length ", [](const Subject& of) { return within(3 * of.size.reach); },
        "a hose along the arm is about as long as the arm"},
       {"", " arm_x arm_y arm_z tool_x tool_y tool_z ",
        [](const Subject& of) { return within(0.5 * of.size.reach); },
        "a hose is held at the link and at the tool"}}};
}

}  // namespace flexcomp::effects
