#pragma once

#include "effects/law.hpp"

namespace flexcomp::effects {

/// A law at a place with its values: what is learnt of a machine.
struct Placed {
  LawPointer law;
  int joint = 0;  ///< from 1 on, 0 for the whole machine
  Values values;
};

/// Gives a machine effects: first those that alter the model, since terms may hold a copy of it;
/// within both in the order of the catalogue and of the joints. Turns and gains do not commute, and
/// a machine must not depend on the order in which its effects are listed.
void add_effects(const std::vector<Placed>& effects, Machine* machine);

/// The law behind an effect that a robot's file lists, a formula included. Throws InputError as
/// below.
LawPointer law_of(const model::Robot& robot, const model::LearnedEffect& learned);

/// The effects that a robot's file lists. Throws InputError for an effect, form, joint or parameter
/// that is unknown, missing, or cannot be of this robot.
std::vector<Placed> listed_effects(const model::Robot& robot);

/// The machine that a robot's file describes, with the effects that it lists, and with play by its
/// key `backlash` where the list has none. Throws InputError as `listed_effects` does.
Machine machine_of(const model::Robot& robot);

/// The machine for these recordings. Throws InputError too if they lack a signal that an effect
/// follows: temperatures, for a drift by temperature.
Machine machine_of(const model::Robot& robot, const std::vector<Scene>& scenes);

/// The robot with effects that were found: by the keys of its file where there are any, else as
/// entries of its list. A formula that is listed already, with parameters that all act in
/// proportion, gets what was found added to them.
model::Robot with_learned(model::Robot robot, const std::vector<Placed>& found);

}  // namespace flexcomp::effects
