#pragma once

#include "table_record.hpp"

namespace flexcomp {

template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up_grid(const Table& table, const JointVector<Scalar, Joints>& q);

}  // namespace flexcomp
