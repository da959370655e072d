#pragma once

#include <string>
#include <vector>

#include "diagnosis/dictionary.hpp"

namespace flexcomp::diagnosis {

/// How much recordings can say about a joint. A resolution is the half-width of the 95 % interval
/// with which a change would be known if it were the only one; not finite where it would not show.
struct Excitation {
  int joint = 0;
  double range = 0;           ///< rad
  double largest_speed = 0;   ///< rad/s
  double largest_load = 0;    ///< N·m, by the model
  double largest_torque = 0;  ///< N·m, as measured where torques were; else by the model
  int reversals = 0;          ///< of its motion
  double stiffness;           ///< resolution of its compliance, relative
  double zero;                ///< resolution of its encoder's zero, rad
  double friction;            ///< resolution of its friction, N·m
  bool slides = false;        ///< then m and N in place of rad and N·m

  bool tells_nothing() const;
  bool shows_friction() const;
};

/// The excitation of every joint, by how far the dictionary's hypotheses would show over the noise.
std::vector<Excitation> excitation(const Observations& observations,
                                   const std::vector<Hypothesis>& hypotheses,
                                   const Dictionary& dictionary);

/// One plain clause: what can be told of the joint, or why nothing can.
std::string verdict(const Excitation& excitation);

}  // namespace flexcomp::diagnosis
