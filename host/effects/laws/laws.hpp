#pragma once

#include <fmt/format.h>

#include <array>

#include "effects/law.hpp"
#include "effects/terms.hpp"

namespace flexcomp::effects {

/// The laws of one effect, a law for each form it takes, and the ranges of their parameters.
struct Forms {
  std::vector<Law> laws;
  std::function<void(const model::Robot&, int joint, Machine*)> apply_keys;
  std::vector<ParameterRange> ranges;
};

namespace laws {

#define FLEXCOMP_EFFECT(name) Forms name();
#include "effects/catalogue.inc"
#undef FLEXCOMP_EFFECT

}  // namespace laws

/// Parameters that are the same for every robot and joint.
std::function<std::vector<Parameter>(const model::Robot&, int joint)> constant(
    std::vector<Parameter> parameters);

/// Parameters of a law at a joint, with the units that they have at one that turns: at one that
/// slides they are m for rad, N for N·m, and so on.
std::function<std::vector<Parameter>(const model::Robot&, int joint)> of_joint(
    std::vector<Parameter> parameters);

/// Amplitudes of a sine and a cosine along a joint (their unit as at one that turns), and how many
/// waves there are in a turn, or radians of the wave in a metre.
std::function<std::vector<Parameter>(const model::Robot&, int joint)> wave_of_joint(
    const std::string& unit);

/// The whole of a joint's number that a law's first parameter changes (its unit as at a joint that
/// turns). None where the model's number is zero: the change is the whole there.
std::function<std::vector<Derived>(const model::Robot&, int joint, const Values&)> whole_of(
    const std::string& name, const std::string& unit, double model::JointDynamics::*number);

/// A clause about a joint, its number in the place of {}.
std::function<std::string(int joint)> says(const char* clause);

/// The same for a law of the whole machine (joint 0) or of one joint.
std::function<std::string(int joint)> says(const char* of_all, const char* of_one);

/// A law that alters the robot.
using Alteration = std::function<void(const Values&, int joint, model::Robot*)>;

/// Completes a law by what it alters of the robot.
void alter_robot(Alteration alteration, Law* law);

/// The same where keys of the robot's file say all of it.
void alter_keys(Alteration alteration, Law* law);

/// Completes a law by the term that it adds.
void add_term(std::function<Term(const Values&, int joint)> term, Law* law);

/// The wrench that a force sensor's reading stands for, tool frame.
using SensorModel = std::function<Wrench<double>(const Values&, const Wrench<double>& read)>;

/// Completes a law about the force sensor.
void alter_sensor(SensorModel truth, Law* law);

/// Places where laws act.
std::vector<int> whole_machine(int joints);
std::vector<int> every_joint(int joints);
std::vector<int> all_but_the_first(int joints);
std::vector<int> all_but_the_last(int joints);
std::vector<int> machine_or_joint(int joints);

/// The two axes of a frame that lie most across a direction in it, in their order: 0 is x.
std::array<int, 2> axes_across(const Vector3<double>& direction);

/// The two axes of a link's frame across the axis of the joint that moves it.
std::array<int, 2> axes_across_joint(const model::Robot& robot, int joint);

/// A parameter for each of two axes, named by it behind a prefix: tilt_x, tilt_z.
std::vector<Parameter> of_axes(const std::array<int, 2>& axes, const std::string& prefix,
                               const std::string& unit);

/// Index of a joint (from 1 on) in a robot's arrays.
inline std::size_t index_of(int joint) { return static_cast<std::size_t>(joint - 1); }

}  // namespace flexcomp::effects
