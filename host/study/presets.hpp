#pragma once

#include <string>
#include <vector>

#include "study/milled_circle.hpp"

namespace flexcomp::study {

/// |F_C| of the study, N, which the figures of every preset stand for.
double study_force();

/// A reading of the study by Klimchik et al. (2017), which leaves tool, wrist, wrench sense and
/// "middle" unsaid.
struct Preset {
  std::string name;
  MilledCircle circle;
};

/// `strict`: eq. 15 as it is written. `flange`: the flange, a radial force fitted to the published
/// table. `counter`: first order, the wrench turning against the path. None of them gives all of
/// the published numbers: `strict` is off by 31 % (root mean square), `flange` by 7 %, `counter` by
/// 4 %.
const std::vector<Preset>& presets();

/// The one of that name. Throws InputError if there is none.
const Preset& preset(const std::string& name);

/// The "middle" circularity (m) of a preset's study: for `counter` the mean over the distance from
/// joint 2 between the least and the largest that joint 3 allows, in closed form.
double counter_middle(const PlanarArm& arm, const MilledCircle& circle);

}  // namespace flexcomp::study
