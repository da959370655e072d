#include "simulation/sample_arms.hpp"

namespace flexcomp::simulation {
namespace {

/// A link along x that turns up from level with growing angle.
void set_link(double mass, double center, double across, double stiffness, Joint<double>* joint,
              Matrix3<double>* inertia) {
  joint->axis = -Vector3<double>::UnitY();
  joint->lower = -3;
  joint->upper = 3;
  joint->compliance = 1 / stiffness;
  joint->mass = mass;
  joint->center_of_mass = {center, 0, 0};
  *inertia = Vector3<double>(0.01 * across, across, across).asDiagonal();
}

}  // namespace

FlexibleArm<1> one_link_arm() {
  constexpr double kMass = 40;
  constexpr double kLever = 80 / (kMass * 9.81);
  FlexibleArm<1> arm;
  set_link(kMass, kLever, 4 - kMass * kLever * kLever, 1e4, &arm.model.joints.front(),
           &arm.inertia.front());
  arm.model.gravity = {0, 0, -9.81};
  arm.model.tool.position = {2 * kLever, 0, 0};
  arm.rotor_inertia << 1;
  arm.viscous << 6;
  arm.coulomb << 2;
  arm.torque_limit << 400;
  return arm;
}

FlexibleArm<2> two_link_arm() {
  FlexibleArm<2> arm;
  set_link(15, 0.5, 15 * 1.0 / 12, 2e4, &arm.model.joints.front(), &arm.inertia.front());
  set_link(10, 0.4, 10 * 0.64 / 12, 1e4, &arm.model.joints[1], &arm.inertia[1]);
  arm.model.joints[1].origin.position = {1, 0, 0};
  arm.model.tool.position = {0.8, 0, 0};
  arm.model.gravity = {0, 0, -9.81};
  arm.rotor_inertia << 2, 1;
  arm.viscous << 10, 6;
  arm.coulomb << 3, 2;
  arm.torque_limit << 1200, 500;
  return arm;
}

}  // namespace flexcomp::simulation
