#pragma once

#include <kdl/frames.hpp>

#include "flexcomp/types.hpp"

namespace flexcomp::model {

inline KDL::Vector to_kdl(const Vector3<double>& v) { return {v.x(), v.y(), v.z()}; }

inline KDL::Frame to_kdl(const Pose<double>& pose) {
  const Matrix3<double>& r = pose.rotation;
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                        r(2, 2)),
          to_kdl(pose.position)};
}

}  // namespace flexcomp::model
