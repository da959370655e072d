#pragma once

/// The precisions and joint counts that the core library contains. A robot with another joint
/// count is one more line here.
#define FLEXCOMP_INSTANTIATE(DEFINE) \
  DEFINE(float, 6)                   \
  DEFINE(double, 6)

/// The same for adaptive robust control, which does not ask for a tool's six degrees of freedom.
#define FLEXCOMP_INSTANTIATE_CONTROL(DEFINE) \
  DEFINE(float, 1)                           \
  DEFINE(float, 2)                           \
  DEFINE(float, 6)                           \
  DEFINE(float, 7)                           \
  DEFINE(double, 1)                          \
  DEFINE(double, 2)                          \
  DEFINE(double, 6)                          \
  DEFINE(double, 7)
