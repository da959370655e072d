#pragma once

#include <string>
#include <vector>

#include "control/arc_design.hpp"
#include "control/tracking.hpp"

namespace flexcomp::control {

/// One controller's run of a trial, thinned for pictures.
template <int Joints>
struct TrialRun {
  std::string controller;
  TrackingFigures<Joints> before;  ///< before the load changes
  TrackingFigures<Joints> after;   ///< after
  std::vector<double> time;        ///< s
  std::vector<double> error;       ///< rad, norm over the joints
  /// N·m, constant part of the adapted bounds of the links; empty for a controller without.
  std::vector<JointVector<double, Joints>> bound;
};

/// A swinging arm that picks up a load half-way, under five controllers: the motors' servo; the
/// same with the nominal arm's feed-forward; the virtual control without robust terms; with robust
/// terms against fixed, typical bounds; and adaptive.
template <int Joints>
struct Trial {
  simulation::FlexibleArm<Joints> nominal;
  ArcDesign<Joints> design;
  simulation::FlexibleArm<Joints> arm;  ///< the true one
  double load = 0;                      ///< kg, payload from half-way on
  JointVector<double, Joints> center;   ///< rad, about which it swings
  JointVector<double, Joints> size;     ///< rad
  double frequency = 2;                 ///< rad/s
  JointVector<double, Joints> disturbance = JointVector<double, Joints>::Zero();  ///< N·m, at 3 Hz
  double duration = 10;                                                           ///< s
};

template <int Joints>
std::vector<TrialRun<Joints>> run_trial(const Trial<Joints>& trial);

/// The two-link arm of the literature, 15 % heavier and a fifth softer than believed, that picks up
/// 3 kg.
Trial<2> two_link_trial();

/// A six-axis robot whose links, springs and friction are off its model within the request's sets
/// (one seeded draw), and which changes from the least to the largest payload in them.
Trial<6> six_axis_trial(const simulation::FlexibleArm<6>& nominal,
                        const ArmUncertainty& uncertainty, const MotionLimits& motion,
                        const ArcDesign<6>& design);

/// gnuplot scripts: errors over time, and the adapted bounds of the adaptive run.
template <int Joints>
std::string error_script(const std::vector<TrialRun<Joints>>& runs, const std::string& title);
template <int Joints>
std::string bound_script(const TrialRun<Joints>& run, const std::string& title);

}  // namespace flexcomp::control
