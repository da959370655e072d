#pragma once

namespace flexcomp::test {

/// How many random cases to try where the release build tries `all`: under the sanitizers, which
/// look for other faults and take twenty times as long, a tenth.
template <typename Integer>
constexpr Integer cases(Integer all) {
  return FLEXCOMP_SANITIZED != 0 ? all / 10 : all;
}

}  // namespace flexcomp::test
