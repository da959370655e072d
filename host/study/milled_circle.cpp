#include "study/milled_circle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "geometry/nearly_round.hpp"
#include "study/planar_path.hpp"

namespace flexcomp::study {
namespace {

/// The circle in stretches; the last one is filled up with its end.
std::vector<CircleStretch> stretches_of(const MilledCircle& circle) {
  std::vector<CircleStretch> stretches((static_cast<std::size_t>(circle.points) - 1) / kStretch +
                                       1);
  for (std::size_t i = 0; i < stretches.size() * kStretch; ++i) {
    const auto point =
        static_cast<double>(std::min<std::size_t>(i, static_cast<std::size_t>(circle.points) - 1));
    const Planar direction = std::polar(1.0, 2 * M_PI * point / circle.points);
    const Planar turning =
        circle.sense == WrenchSense::with_path ? direction : std::conj(direction);
    CircleStretch& stretch = stretches[i / kStretch];
    const auto lane = static_cast<Eigen::Index>(i % kStretch);
    stretch.tool.set(lane, circle.radius * direction);
    stretch.turning.set(lane, turning);
    stretch.force.set(lane, turning * Planar(circle.force[0], circle.force[1]));
  }
  return stretches;
}

/// The robot that ends at the tool point.
RobotModel<double, 6> ending_at(RobotModel<double, 6> model, ToolPoint point) {
  if (point == ToolPoint::wrist) {
    model.joints[5].origin.position.setZero();
    model.tool.position.setZero();
  }
  return model;
}

bool has_joint_springs_alone(const RobotModel<double, 6>& model) {
  for (const Joint<double>& joint : model.joints) {
    if (joint.cubic_compliance != 0) {
      return false;
    }
  }
  return !has_structure_springs(model) && !has_weight(model);
}

}  // namespace

void check(const MilledCircle& circle) {
  if (!(circle.radius > 0) || !std::isfinite(circle.radius) || circle.points < 8 ||
      circle.points > 1000000) {
    throw InputError("the circle's radius must be above zero, its points from 8 to 1000000");
  }
  if (!circle.force.allFinite() || !circle.moment.allFinite()) {
    throw InputError("force and moment must be finite");
  }
  if (circle.force.isZero(0) && circle.moment.isZero(0)) {
    throw InputError("without force and moment every circle is round: expected one of them");
  }
}

class CircleStudy::Implementation {
 public:
  Implementation(const RobotModel<double, 6>& model, const MilledCircle& circle)
      : arm(planar_arm(model, circle.point, circle.has_limits)),
        model_(ending_at(model, circle.point)),
        circle_(circle),
        is_planar_(has_joint_springs_alone(model)),
        stretches_(stretches_of(circle)) {}

  double circularity(Planar center) const {
    Eigen::ArrayXd x(static_cast<Eigen::Index>(stretches_.size()) * kStretch);
    Eigen::ArrayXd z(x.size());
    if (!mill(center, 1, &x, &z) && !(has_limits() && mill(center, -1, &x, &z))) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return geometry::nearly_round_circularity(x.head(circle_.points), z.head(circle_.points));
  }

  PlanarArm arm;

 private:
  /// Only they can leave the elbow one side and not the other.
  bool has_limits() const { return !arm.range_2.is_full() || !arm.range_3.is_full(); }

  /// The circle as it becomes, from where its centre should be, with the elbow on the left (1) or
  /// right (−1); false where that is out of reach.
  bool mill(Planar center, double side, Eigen::ArrayXd* x, Eigen::ArrayXd* z) const {
    Eigen::Index at = 0;
    for (const CircleStretch& stretch : stretches_) {
      const PlanarPath where =
          circle_.is_first_order ? PlanarPath::constant(center) : stretch.tool.shifted(center);
      Levers levers;
      if (!place(where, side, &levers)) {
        return false;
      }
      const PlanarPath milled =
          stretch.tool + (is_planar_ ? planar_deflection(stretch.force, levers)
                                     : full_deflection(stretch, where, levers));
      x->segment<kStretch>(at) = milled.x;
      z->segment<kStretch>(at) = milled.z;
      at += kStretch;
    }
    return true;
  }

  /// The levers with the elbow on that side; false where that is out of reach.
  bool place(const PlanarPath& tool, double side, Levers* levers) const {
    const double upper = std::norm(arm.upper_arm);
    const double fore = std::norm(arm.forearm);
    levers->shoulder = tool.shifted(-arm.shoulder);
    const PlanarPath& v = levers->shoulder;
    const Values inverse = (v.x.square() + v.z.square()).inverse();
    const Values along = 0.5 + 0.5 * (upper - fore) * inverse;
    const Values height = upper * inverse - along.square();
    if (!(height >= 0).all()) {
      return false;
    }
    const Values across = side * height.sqrt();
    const PlanarPath elbow = {along * v.x - across * v.z, along * v.z + across * v.x};
    levers->elbow = v - elbow;
    const PlanarPath second = levers->elbow.turned(std::conj(arm.forearm));
    if (arm.wrist_to_tool != Planar(0, 0)) {
      levers->wrist = second.turned(arm.wrist_to_tool / fore);
    }
    if (!has_limits()) {
      return true;
    }
    const PlanarPath first = elbow.turned(std::conj(arm.upper_arm));
    const PlanarPath third = relative(second, first);
    return arm.range_2.holds(first.x, first.z, upper) &&
           arm.range_3.holds(third.x, third.z, upper * fore);
  }

  PlanarPath planar_deflection(const PlanarPath& force, const Levers& levers) const {
    PlanarPath sum = PlanarPath::constant(0);
    const auto add = [&](const PlanarPath& lever, double compliance) {
      const Values turn = compliance * (lever.x * force.z - lever.z * force.x + circle_.moment[2]);
      sum.x -= turn * lever.z;
      sum.z += turn * lever.x;
    };
    add(levers.shoulder, arm.compliance[0]);
    add(levers.elbow, arm.compliance[1]);
    if (arm.wrist_to_tool != Planar(0, 0)) {
      add(levers.wrist, arm.compliance[2]);
    }
    return sum;
  }

  /// The deflection by the core, with every spring and weight.
  PlanarPath full_deflection(const CircleStretch& stretch, const PlanarPath& where,
                             const Levers& levers) const {
    const PlanarPath& force = stretch.force;
    const PlanarPath moment = stretch.turning.turned({circle_.moment[0], circle_.moment[1]});
    PlanarPath sum;
    for (Eigen::Index i = 0; i < kStretch; ++i) {
      const JointVector<double, 6> q = arm.angles(where[i] - levers.elbow[i], where[i]);
      Wrench<double> wrench;
      wrench << force.x[i], -circle_.force[2], force.z[i], moment.x[i], -circle_.moment[2],
          moment.z[i];
      const Twist<double> twist = deflection(model_, q, wrench).tcp;
      sum.set(i, {twist[0], twist[2]});
    }
    return sum;
  }

  RobotModel<double, 6> model_;
  MilledCircle circle_;
  bool is_planar_;
  std::vector<CircleStretch> stretches_;
};

CircleStudy::CircleStudy(const RobotModel<double, 6>& model, const MilledCircle& circle) {
  check(circle);
  implementation_ = std::make_unique<const Implementation>(model, circle);
}

CircleStudy::CircleStudy(CircleStudy&&) noexcept = default;
CircleStudy::~CircleStudy() = default;

double CircleStudy::circularity(Planar center) const {
  return implementation_->circularity(center);
}

const PlanarArm& CircleStudy::arm() const { return implementation_->arm; }

}  // namespace flexcomp::study
