#pragma once

#include <cstddef>
#include <functional>

namespace flexcomp {

/// Does `work` for 0 … count − 1 on all cores that this process may use; `progress` is told from
/// this thread: done, count. The first exception of any of them is thrown here.
void in_parallel(std::size_t count, const std::function<void(std::size_t, std::size_t)>& progress,
                 const std::function<void(std::size_t)>& work);

}  // namespace flexcomp
