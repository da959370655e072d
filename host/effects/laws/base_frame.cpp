#include <Eigen/Geometry>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
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
Forms laws::base_frame() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 6;
  law.traits.is_in_family = true;
  law.traits.can_be_undone = false;
  law.traits.registers = Registers::frame;
  law.parameters =
      constant({{"x", "m"}, {"y", "m"}, {"z", "m"}, {"rx", "rad"}, {"ry", "rad"}, {"rz", "rad"}});
  law.words = "place of the base";
  law.statement = says("the frame of the TCP measurement is not the robot's base frame");
  add_term(
      [](const Values& values, int) {
        return Term{Term::instrument, [=](const Scene&, const Simulation&, Prediction* prediction) {
                      move_frame(values, prediction);
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " x y z ", [](const Subject&) { return within(80); },
            "laser trackers' data sheets: they reach 80 m"},
           {"", " rx ry rz ", [](const Subject&) { return within(M_PI); },
            "any turn is one by at most half a revolution"}}};
}

}  // namespace flexcomp::effects
