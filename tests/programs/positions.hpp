#pragma once

#include "flexcomp/types.hpp"
#include "unity_main.hpp"

namespace flexcomp::test {

/// Is a position (m) at a place given in millimetres?
inline void assert_at(double x, double y, double z, const Vector3<double>& position) {
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, (1e3 * position - Vector3<double>(x, y, z)).norm());
}

}  // namespace flexcomp::test
