#include "force_sensor/mounting.hpp"

namespace flexcomp {

std::array<double, 6> wrench_at_tcp(const SensorMounting& mounting, const JointAngles& q,
                                    const std::array<double, 6>& load) {
  using Vector = Vector3<double>;
  const auto where = forward_kinematics<double, 6>(
      mounting.arm, Eigen::Map<const JointVector<double, 6>>(q.data()));
  const Pose<double>& link = where.links.back();
  const Matrix3<double> rotation = link.rotation * mounting.frame.rotation;
  const Vector sensor = link.position + link.rotation * mounting.frame.position;
  const Vector center = link.position + link.rotation * mounting.center_of_mass;
  const Vector weight = mounting.mass * mounting.arm.gravity;

  const Vector force = rotation * Eigen::Map<const Vector>(load.data()) - weight;
  const Vector moment = rotation * Eigen::Map<const Vector>(load.data() + 3) -
                        (center - sensor).cross(weight) +
                        (sensor - where.tcp.position).cross(force);
  std::array<double, 6> wrench{};
  Eigen::Map<Vector>(wrench.data()) = force;
  Eigen::Map<Vector>(wrench.data() + 3) = moment;
  return wrench;
}

}  // namespace flexcomp
