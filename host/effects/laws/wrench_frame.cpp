#include <Eigen/Geometry>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// The force sensor is mounted rotated: it reads the wrench turned by a rotation vector, in the tool
// frame.
Forms laws::wrench_frame() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 3;
  law.traits.is_curved = true;
  law.parameters = constant({{"rx", "rad"}, {"ry", "rad"}, {"rz", "rad"}});
  law.words = "orientation of the force sensor";
  law.statement = says("the force sensor is mounted turned");
  alter_sensor(
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
      &law);
  return {{law},
          {},
          {{"", " rx ry rz ",
            [](const Subject&) {
              return Range{-3.2, 3.2, Rest::both};
            },
            "any turn is one by at most half a revolution"}}};
}

}  // namespace flexcomp::effects
