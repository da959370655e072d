#pragma once

#include <Eigen/Core>

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// The value of `least_squares_circularity` for a profile that is nearly a circle about the origin,
/// as a circle off by its deflections is: several times as fast, for maps of millions of circles.
/// Newton's method from the origin, which is left for the general function if it does not settle at
/// once. x and y: the points' coordinates, three at least, all finite.
double nearly_round_circularity(const Eigen::Ref<const Eigen::ArrayXd>& x,
                                const Eigen::Ref<const Eigen::ArrayXd>& y);

}  // namespace flexcomp::geometry
