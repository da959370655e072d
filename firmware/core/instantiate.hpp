#pragma once

/// The precisions and joint counts that the core library contains. A robot with another joint
/// count is one more line here.
#define FLEXCOMP_INSTANTIATE(DEFINE) \
  DEFINE(float, 6)                   \
  DEFINE(double, 6)
