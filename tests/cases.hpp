#pragma once

namespace flexcomp::test {

/// How many random cases to try where the release build tries `all`: a tenth under the sanitizers
/// and in an emulator, which look for other faults and take twenty times as long.
template <typename Integer>
constexpr Integer cases(Integer all) {
  return FLEXCOMP_FEW_CASES != 0 ? all / 10 : all;
}

}  // namespace flexcomp::test
