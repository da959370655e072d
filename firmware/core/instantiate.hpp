#pragma once

/// The precisions of tables and of the compensator that reads them: the format holds six joints.
#define FLEXCOMP_INSTANTIATE(DEFINE) \
  DEFINE(float, 6)                   \
  DEFINE(double, 6)

/// The precisions and joint counts of chain, compliance and guards. Another joint count is one more
/// line here.
#define FLEXCOMP_INSTANTIATE_ARM(DEFINE) \
  FLEXCOMP_INSTANTIATE(DEFINE)           \
  DEFINE(float, 7)                       \
  DEFINE(double, 7)

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
