#include "study/milled_circle.hpp"

#include <cmath>
#include <limits>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "geometry/circularity.hpp"
#include "study/planar_path.hpp"

namespace flexcomp::study {
namespace {

/// Around a circle of radius one, from x to z.
PlanarPath unit_circle(int points) {
  const Values angle = Values::LinSpaced(points + 1, 0, 2 * M_PI).head(points);
  return {angle.cos(), angle.sin()};
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

void check(const MilledCircle& circle) {
  if (!(circle.radius > 0) || !std::isfinite(circle.radius) || circle.points < 8 ||
      circle.points > 1000000) {
    throw InputError("the circle's radius must be above zero, its points from 8 to 1000000");
  }
  if (!circle.force.allFinite() || !circle.moment.allFinite()) {
    throw InputError("force and moment must be finite");
  }
}

}  // namespace

class CircleStudy::Implementation {
 public:
  Implementation(const RobotModel<double, 6>& model, const MilledCircle& circle)
      : arm(planar_arm(model, circle.point, circle.has_limits)),
        model_(ending_at(model, circle.point)),
        circle_(circle),
        is_planar_(has_joint_springs_alone(model)),
        directions_(unit_circle(circle.points)),
        offsets_(scaled(directions_, circle.radius)) {
    PlanarPath turning = directions_;
    if (circle.sense == WrenchSense::against_path) {
      turning.z = -turning.z;
    }
    force_ = turning.turned({circle.force[0], circle.force[1]});
  }

  double circularity(Planar center) const {
    const PlanarPath path = offsets_.shifted(center);
    Levers levers;
    const PlanarPath where =
        circle_.is_first_order ? PlanarPath::constant(center, path.x.size()) : path;
    if (!place(where, 1, &levers) && !place(where, -1, &levers)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return form_error(offsets_ +
                      (is_planar_ ? planar_deflection(levers) : full_deflection(where, levers)));
  }

  PlanarArm arm;

 private:
  /// The levers with the elbow on the left (1) or right (−1); false where that is out of reach.
  bool place(const PlanarPath& tool, double side, Levers* levers) const {
    const double upper = std::norm(arm.upper_arm);
    const double fore = std::norm(arm.forearm);
    levers->shoulder = tool.shifted(-arm.shoulder);
    const PlanarPath& v = levers->shoulder;
    const Values square = v.x.square() + v.z.square();
    const Values along = (upper - fore + square) / (2 * square);
    const Values height = upper / square - along.square();
    if (!(height >= 0).all()) {
      return false;
    }
    const Values across = side * height.sqrt();
    const PlanarPath elbow = {along * v.x - across * v.z, along * v.z + across * v.x};
    levers->elbow = v - elbow;
    const PlanarPath first = elbow.turned(std::conj(arm.upper_arm));
    const PlanarPath second = levers->elbow.turned(std::conj(arm.forearm));
    const PlanarPath third = relative(second, first);
    if (!arm.range_2.holds(first.x, first.z, upper) ||
        !arm.range_3.holds(third.x, third.z, upper * fore)) {
      return false;
    }
    levers->wrist = second.turned(arm.wrist_to_tool / fore);
    return true;
  }

  PlanarPath planar_deflection(const Levers& levers) const {
    PlanarPath sum = scaled(directions_, 0);
    const auto add = [&](const PlanarPath& lever, double compliance) {
      const Values turn =
          compliance * (lever.x * force_.z - lever.z * force_.x + circle_.moment[2]);
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

  /// By the core, with every spring and weight.
  PlanarPath full_deflection(const PlanarPath& where, const Levers& levers) const {
    PlanarPath sum = scaled(directions_, 0);
    for (Eigen::Index i = 0; i < sum.x.size(); ++i) {
      const JointVector<double, 6> q = arm.angles(where[i] - levers.elbow[i], where[i]);
      const Planar radial = directions_[i];
      const Planar turning = circle_.sense == WrenchSense::with_path ? radial : std::conj(radial);
      const Planar moment = turning * Planar(circle_.moment[0], circle_.moment[1]);
      Wrench<double> wrench;
      wrench << force_.x[i], -circle_.force[2], force_.z[i], moment.real(), -circle_.moment[2],
          moment.imag();
      const Twist<double> twist = deflection(model_, q, wrench).tcp;
      sum.x[i] = twist[0];
      sum.z[i] = twist[2];
    }
    return sum;
  }

  static double form_error(const PlanarPath& path) {
    geometry::Points points(static_cast<std::size_t>(path.x.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      points[i] = {path.x[at], path.z[at]};
    }
    return geometry::least_squares_circularity(points).value();
  }

  RobotModel<double, 6> model_;
  MilledCircle circle_;
  bool is_planar_;
  PlanarPath directions_;
  PlanarPath offsets_;  ///< of the path from its centre
  PlanarPath force_;
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
