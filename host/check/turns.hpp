#pragma once

namespace flexcomp::check {

constexpr double kHalfTurn = 3.141592653589793;  // rad
constexpr double kQuarterTurn = kHalfTurn / 2;
constexpr double kDegree = kHalfTurn / 180;

}  // namespace flexcomp::check
