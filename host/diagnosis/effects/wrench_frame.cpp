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
  hypothesis.apply = [](const Values& values, Machine* machine) {
    const Vector3<double> turn(values[0], values[1], values[2]);
    const double angle = turn.norm();
    const Matrix3<double> back = angle > 0
                                     ? Eigen::AngleAxisd(-angle, turn / angle).toRotationMatrix()
                                     : Matrix3<double>::Identity();
    machine->terms.push_back(sensor([back](const Wrench<double>& read) {
      Wrench<double> truth;
      truth << back * read.head<3>(), back * read.tail<3>();
      return truth;
    }));
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
