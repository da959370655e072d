#include <Eigen/Geometry>

#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// The frame that positions are measured in stands elsewhere; values: x, y, z (m), rx, ry, rz (rad,
/// rotation vector).
void move_frame(const Values& values, Prediction* prediction) {
  Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
  if (position.cols() == 0) {
    return;
  }
  const Vector3<double> shift(values[0], values[1], values[2]);
  const Vector3<double> turn(values[3], values[4], values[5]);
  const double angle = turn.norm();
  const Matrix3<double> rotation = angle > 0
                                       ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                       : Matrix3<double>::Identity();
  position = ((position * rotation.transpose()).rowwise() + shift.transpose()).eval();
}

}  // namespace

// The frame in which the TCP is measured is not the robot's base frame: a tracker's registration
// that is off by a translation and a rotation (ISO 9283, clause 6; Mooring, Roth and Driels 1991).
// Needs the TCP at places that lie apart.
std::vector<Hypothesis> base_frame(const Observations& observations) {
  if (!observations.has(simulation::tcp_position)) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "base_frame";
  hypothesis.parameters = {{"x", "m", -0.1, 0.1, 1e-4},    {"y", "m", -0.1, 0.1, 1e-4},
                           {"z", "m", -0.1, 0.1, 1e-4},    {"rx", "rad", -0.1, 0.1, 1e-4},
                           {"ry", "rad", -0.1, 0.1, 1e-4}, {"rz", "rad", -0.1, 0.1, 1e-4}};
  hypothesis.linear = 6;
  if (!observations.spans_workspace()) {
    hypothesis.starts.clear();  // known of the machine it may be, but not found here
  }
  hypothesis.statement = "the frame of the TCP measurement is not the robot's base frame";
  hypothesis.apply = [](const Values& values, Machine* machine) {
    machine->terms.push_back(
        {simulation::Term::output, [=](const Scene&, const Simulation&, Prediction* prediction) {
           move_frame(values, prediction);
         }});
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
