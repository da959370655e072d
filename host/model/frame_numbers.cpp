#include "model/frame_numbers.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace flexcomp::model {

std::array<double, 6> frame_numbers(const Pose<double>& frame) {
  const Matrix3<double>& turn = frame.rotation;
  return {frame.position.x(),
          frame.position.y(),
          frame.position.z(),
          std::atan2(turn(2, 1), turn(2, 2)),
          std::atan2(0.0 - turn(2, 0), std::hypot(turn(0, 0), turn(1, 0))),
          std::atan2(turn(1, 0), turn(0, 0))};
}

Pose<double> frame_of_numbers(const std::array<double, 6>& numbers) {
  using Eigen::AngleAxisd;
  using Vector = Vector3<double>;
  Pose<double> frame;
  frame.position = {numbers[0], numbers[1], numbers[2]};
  frame.rotation =
      (AngleAxisd(numbers[5], Vector::UnitZ()) * AngleAxisd(numbers[4], Vector::UnitY()) *
       AngleAxisd(numbers[3], Vector::UnitX()))
          .toRotationMatrix();
  return frame;
}

}  // namespace flexcomp::model
