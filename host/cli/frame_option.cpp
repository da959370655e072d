#include "cli/frame_option.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "model/whole_turn.hpp"

namespace flexcomp::cli {

CLI::Option* add_frame(CLI::App* command, std::vector<double>* frame) {
  return command
      ->add_option("--frame", *frame,
                   "work frame in the base frame: x,y,z[,roll,pitch,yaw], m and rad")
      ->delimiter(',')
      ->expected(1, 6)
      ->type_name("X,Y,Z[,R,P,Y]");
}

std::optional<Pose<double>> frame_of(const std::vector<double>& numbers) {
  if (numbers.empty()) {
    return std::nullopt;
  }
  const bool is_finite =
      std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); });
  if ((numbers.size() != 3 && numbers.size() != 6) || !is_finite) {
    throw InputError("--frame: expected x,y,z or x,y,z,roll,pitch,yaw");
  }
  constexpr double kFar = 50;  // m: no robot reaches a tenth of it
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i < 3 ? std::abs(numbers[i]) > kFar : model::is_beyond_a_turn(numbers[i])) {
      throw InputError(fmt::format("--frame: expected {}, found {:g}", i < 3 ? "metres" : "radians",
                                   numbers[i]));
    }
  }
  Pose<double> frame;
  frame.position = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 6) {
    using Eigen::AngleAxisd;
    using Vector = Vector3<double>;
    frame.rotation =
        (AngleAxisd(numbers[5], Vector::UnitZ()) * AngleAxisd(numbers[4], Vector::UnitY()) *
         AngleAxisd(numbers[3], Vector::UnitX()))
            .toRotationMatrix();
  }
  return frame;
}

std::array<double, 6> frame_numbers(const Pose<double>& frame) {
  const Matrix3<double>& turn = frame.rotation;
  return {frame.position.x(),
          frame.position.y(),
          frame.position.z(),
          std::atan2(turn(2, 1), turn(2, 2)),
          std::atan2(0.0 - turn(2, 0), std::hypot(turn(0, 0), turn(1, 0))),
          std::atan2(turn(1, 0), turn(0, 0))};
}

}  // namespace flexcomp::cli
