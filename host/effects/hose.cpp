#include "effects/hose.hpp"

#include <algorithm>
#include <limits>

namespace flexcomp::effects {

HoseCourse hose_course(const simulation::Simulation& simulation, int joint, const HoseEnds& ends,
                       const Rows& rows) {
  const Eigen::Index joints = simulation.q.cols();
  HoseCourse course{Eigen::VectorXd(rows.count), Eigen::MatrixXd::Zero(rows.count, joints),
                    Eigen::VectorXi(rows.count)};
  for (Eigen::Index i = 0; i < rows.count; ++i) {
    const auto row = static_cast<std::size_t>(i * rows.step);
    const model::ChainKinematics& at = simulation.bent[row];
    const Pose<double>& arm = at.links[static_cast<std::size_t>(joint - 2)];
    const Vector3<double> from_tcp = at.tcp.rotation * ends.tool;
    const Vector3<double> span =
        at.tcp.position + from_tcp - (arm.position + arm.rotation * ends.arm);
    const double length = span.norm();
    course.length[i] = length;
    const Vector3<double> along = span / std::max(length, std::numeric_limits<double>::min());
    for (Eigen::Index other = joint - 1; other < joints; ++other) {
      const Eigen::Matrix<double, 6, 1> lever = simulation.jacobian[row].col(other);
      course.slope(i, other) =
          along.dot(lever.head<3>() + Vector3<double>(lever.tail<3>()).cross(from_tcp));
    }
    course.direction[i] = simulation::direction_of_motion(
        course.slope.row(i).dot(simulation.velocity.row(i * rows.step)));
  }
  return course;
}

Eigen::VectorXd stretch(const HoseCourse& course, double slack_length) {
  return (course.length.array() - slack_length).max(0.0).matrix();
}

}  // namespace flexcomp::effects
