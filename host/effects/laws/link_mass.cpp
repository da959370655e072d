#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kLostMass = 0.8;   // of a link's mass
constexpr double kAddedMass = 2;    // times a link's mass
constexpr double kLeastMass = 0.1;  // kg, of a link: a model may have none
constexpr double kLeastLink = 0.2;  // of the reach, about a joint: the size of a link there

double largest_mounted(const Subject& of) {
  return std::max(kAddedMass * of.joint().mass, of.size.payload);
}

/// How large a link can be that joint `index` moves.
double link_size(const model::Chain& elastic, const MachineSize& size, std::size_t index) {
  const Pose<double>& end =
      index + 1 < elastic.joints.size() ? elastic.joints[index + 1].origin : elastic.tool;
  return std::max({end.position.norm(), kLeastLink * size.reach,
                   1.5 * elastic.joints[index].center_of_mass.norm()});
}

/// First moment beyond what a link of its mass can have.
Eigen::VectorXd moment_outside(const model::Robot& model, const model::Robot& altered,
                               const MachineSize& size, int joint, double margin) {
  const model::ChainJoint& link = altered.elastic.joints[index_of(joint)];
  const double radius = link_size(model.elastic, size, index_of(joint));
  const double known = std::max(model.elastic.joints[index_of(joint)].mass, kLeastMass);
  const double excess = link.mass * (link.center_of_mass.norm() - radius) / (known * radius);
  return Eigen::VectorXd::Constant(1, std::max(excess + margin, 0.0));
}

/// Adds a point mass at the link's origin and a first moment (kg·m), which has no inertia of its
/// own.
void mount(double mass, const Vector3<double>& moment, std::size_t index, model::Robot* robot) {
  model::ChainJoint& link = robot->elastic.joints[index];
  const auto about_origin = [](double m, const Vector3<double>& c) {
    return Matrix3<double>(m * (c.squaredNorm() * Matrix3<double>::Identity() - c * c.transpose()));
  };
  const Matrix3<double> inertia =
      robot->link_inertia[index] + about_origin(link.mass, link.center_of_mass);
  const Vector3<double> total = link.mass * link.center_of_mass + moment;
  link.mass = std::max(link.mass + mass, 1e-3);
  link.center_of_mass = total / link.mass;
  robot->link_inertia[index] = inertia - about_origin(link.mass, link.center_of_mass);
}

/// The same where the first moment is that of the mass at one place, which has an inertia about the
/// link's origin. The place is no farther than `farthest` (m), however small the mass.
void mount_lump(double mass, const Vector3<double>& moment, double farthest, std::size_t index,
                model::Robot* robot) {
  mount(mass, moment, index, robot);
  const double place =
      std::abs(mass) * farthest > moment.norm() ? moment.norm() / std::abs(mass) : farthest;
  if (moment.norm() > 0) {
    const Vector3<double> direction = moment.normalized();
    robot->link_inertia[index] += std::copysign(moment.norm() * place, mass) *
                                  (Matrix3<double>::Identity() - direction * direction.transpose());
  }
}

constexpr const char* kWhatIsMounted =
    "no more is mounted on a link than twice its mass or what the flange could carry";
constexpr const char* kWhereItIs = "what is mounted on a link lies within the arm's reach";

Range mounted_mass(const Subject& of) {
  return Range{-kLostMass * of.joint().mass, largest_mounted(of)};
}

Range mounted_moment(const Subject& of) {
  return within((of.joint().mass + largest_mounted(of)) * of.size.reach);
}

}  // namespace

// Mass of a link that differs from the model's: the same body heavier or lighter in all its parts,
// or mass and first moment (link frame) of something mounted on it (rigid-body dynamics). The form
// `mounted` leaves out the inertia that a first moment brings, and is linear; `lump` has that of a
// point mass.
Forms laws::link_mass() {
  Law body;
  body.form = "body";
  body.joints = every_joint;
  body.traits.linear_in = 1;
  body.traits.is_body = true;
  body.words = "mass of the link";
  body.statement = says("the link that joint {} moves has another mass");
  body.excess = moment_outside;
  body.no_body = "a link whose centre of mass lies outside of it cannot be";
  Law mounted = body;
  body.traits.tells_inertia = true;
  body.parameters = constant({{"mass", "kg"}});
  body.impossible = [](const model::Robot& robot, int joint) {
    return robot.elastic.joints[index_of(joint)].mass > 0 ? "" : "its link has no mass";
  };
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        model::ChainJoint& link = robot->elastic.joints[index_of(joint)];
        robot->link_inertia[index_of(joint)] *= 1 + values[0] / link.mass;
        link.mass += values[0];
      },
      &body);
  mounted.traits.is_in_family = true;
  mounted.form = "mounted";
  mounted.traits.linear_in = 4;
  mounted.parameters = constant({{"mass", "kg"}, {"mx", "kg·m"}, {"my", "kg·m"}, {"mz", "kg·m"}});
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        mount(values[0], {values[1], values[2], values[3]}, index_of(joint), robot);
      },
      &mounted);
  Law lump = mounted;
  lump.form = "lump";
  lump.joints = all_but_the_last;  // whose lump is a payload
  lump.traits.is_in_family = false;
  lump.traits.is_curved = true;
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        mount_lump(values[0], {values[1], values[2], values[3]}, size_of(*robot).reach,
                   index_of(joint), robot);
      },
      &lump);
  return {{body, mounted, lump},
          {},
          {{"body", " mass ",
            [](const Subject& of) {
              return Range{-kLostMass * of.joint().mass, kAddedMass * of.joint().mass};
            },
            "models' masses are estimates to a half (Gaz et al. 2019); none is off fivefold"},
           {"mounted", " mass ", mounted_mass, kWhatIsMounted},
           {"lump", " mass ", mounted_mass, kWhatIsMounted},
           {"mounted", " mx my mz ", mounted_moment, kWhereItIs},
           {"lump", " mx my mz ", mounted_moment, kWhereItIs}}};
}

}  // namespace flexcomp::effects
