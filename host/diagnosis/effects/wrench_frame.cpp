#include <Eigen/Geometry>

#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// The force sensor is mounted rotated: it reads the wrench turned by a rotation vector, in the tool
// frame. Needs a wrench.
std::vector<Hypothesis> wrench_frame(const Observations& observations) {
  if (!observations.has_wrench()) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "wrench_frame";
  constexpr const char* kNames[] = {"rx", "ry", "rz"};
  for (const char* name : kNames) {
    hypothesis.parameters.push_back({name, "rad", -3.2, 3.2, 0.05});
  }
  hypothesis.linear = 3;
  hypothesis.statement = "the force sensor is mounted turned";
  hypothesis.is_curved = true;
  set_sensor(
      [](const Values& values, const Wrench<double>& read) {
        const Vector3<double> turn(values[0], values[1], values[2]);
        const double angle = turn.norm();
        if (!(angle > 0)) {
          return read;
        }
        const Matrix3<double> back = Eigen::AngleAxisd(-angle, turn / angle).toRotationMatrix();
        Wrench<double> truth;
        truth << back * read.head<3>(), back * read.tail<3>();
        return truth;
      },
      &hypothesis);
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
