#include "planning/program_follower.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "flexcomp/compliance.hpp"

namespace flexcomp::planning {
namespace {

/// Joints that turn by more than this (rad) from one point to the next have changed their branch.
constexpr double kLargestJump = 0.35;
constexpr std::size_t kMostLooked = 200;
constexpr int kSpins = 24;
/// A radian from the limits is as good as this many times the least singular value.
constexpr double kSingularWeight = 3;

/// How far a posture is from what is to be kept away from.
struct Distance {
  double joint_margin = std::numeric_limits<double>::infinity();
  double singular_value = std::numeric_limits<double>::infinity();

  double worst() const { return std::min(joint_margin, kSingularWeight * singular_value); }
  void include(const Distance& other) {
    joint_margin = std::min(joint_margin, other.joint_margin);
    singular_value = std::min(singular_value, other.singular_value);
  }
};

Distance distance_of(const RobotModel<double, 6>& model, const Angles& q) {
  Distance distance;
  for (std::size_t i = 0; i < 6; ++i) {
    const double angle = q[static_cast<Eigen::Index>(i)];
    distance.joint_margin = std::min(
        {distance.joint_margin, angle - model.joints[i].lower, model.joints[i].upper - angle});
  }
  const Jacobian<double, 6> jacobian =
      geometric_jacobian<double, 6>(forward_kinematics<double, 6>(model, q));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> squares(
      jacobian * jacobian.transpose(), Eigen::EigenvaluesOnly);
  distance.singular_value = std::sqrt(std::max(squares.eigenvalues()[0], 0.0));
  return distance;
}

bool keeps_limits(const RobotModel<double, 6>& model, const Angles& q) {
  for (std::size_t i = 0; i < 6; ++i) {
    const double angle = q[static_cast<Eigen::Index>(i)];
    if (!(angle >= model.joints[i].lower && angle <= model.joints[i].upper)) {
      return false;
    }
  }
  return true;
}

/// Newton's method from close by, which takes two or three steps; where it does not get there, the
/// solver for all cases.
std::optional<Angles> next_angles(const RobotModel<double, 6>& model, const Pose<double>& target,
                                  const Angles& seed) {
  constexpr int kMostSteps = 6;
  Angles q = seed;
  for (int step = 0; step < kMostSteps; ++step) {
    const Kinematics<double, 6> at = forward_kinematics<double, 6>(model, q);
    const Twist<double> off = pose_difference(at.tcp, target);
    if (off.cwiseAbs().maxCoeff() <= 1e-11) {
      return keeps_limits(model, q) ? std::optional<Angles>(q) : std::nullopt;
    }
    const Jacobian<double, 6> jacobian = geometric_jacobian<double, 6>(at);
    const Angles change = jacobian.partialPivLu().solve(off);
    if (!(change.cwiseAbs().maxCoeff() < 1)) {
      break;
    }
    q += change;
  }
  return solve_near(model, target, seed);
}

/// A way to follow the program, and how good it looked.
struct Candidate {
  Pose<double> frame;
  double spin = 0;
  Angles start;
  double quality = 0;
};

class Follower {
 public:
  Follower(const RobotModel<double, 6>& model, const programs::Program& program,
           const std::vector<PathPoint>& points)
      : model_(model), program_(program), points_(points) {
    const std::size_t stride = (points.size() + kMostLooked - 1) / kMostLooked;
    for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(stride, 1)) {
      looked_at_.push_back(i);
    }
  }

  /// Ways to follow the program in a frame, the best first.
  std::vector<Candidate> candidates(const Pose<double>& frame, int spins) {
    std::vector<Candidate> found;
    for (int i = 0; i < (program_.has_free_spin ? spins : 1); ++i) {
      const double spin = 2 * M_PI * i / spins;
      for (const Angles& start : solve_all(model_, target(0, frame, spin))) {
        const double quality = look_along(frame, spin, start);
        if (quality > 0) {
          found.push_back({frame, spin, start, quality});
        }
      }
    }
    std::sort(found.begin(), found.end(),
              [](const Candidate& a, const Candidate& b) { return a.quality > b.quality; });
    return found;
  }

  /// The first of the candidates that gets all the way.
  FollowedPath first_of(const std::vector<Candidate>& candidates,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
    constexpr std::size_t kMostTried = 12;
    for (std::size_t i = 0; i < std::min(candidates.size(), kMostTried); ++i) {
      FollowedPath path;
      if (follow(candidates[i], progress, &path)) {
        return path;
      }
    }
    const std::size_t line = program_.motions[points_[farthest_].motion].line;
    throw InputError(fmt::format(
        "{}:{}: cannot be reached: no posture gets past here within the joint limits and without a "
        "jump; another --frame may help",
        program_.file, line));
  }

  /// Where the program's middle is in the middle of a place.
  Pose<double> frame_around(const Vector3<double>& place) const {
    Eigen::AlignedBox3d box;
    for (const PathPoint& point : points_) {
      box.extend(point.pose.position);
    }
    return {Matrix3<double>::Identity(), place - box.center()};
  }

 private:
  Pose<double> target(std::size_t point, const Pose<double>& frame, double spin) const {
    Pose<double> pose = frame * points_[point].pose;
    if (spin != 0) {
      pose.rotation = pose.rotation * axis_rotation<double>(Vector3<double>::UnitZ(), spin);
    }
    return pose;
  }

  /// The least distance along the points that are looked at; zero where they cannot be followed.
  double look_along(const Pose<double>& frame, double spin, const Angles& start) {
    Angles q = start;
    Distance least;
    for (const std::size_t point : looked_at_) {
      const std::optional<Angles> next = next_angles(model_, target(point, frame, spin), q);
      if (!next || (*next - q).cwiseAbs().maxCoeff() > 1) {
        return 0;
      }
      q = *next;
      farthest_ = std::max(farthest_, point);
      least.include(distance_of(model_, q));
    }
    return least.worst();
  }

  bool follow(const Candidate& candidate,
              const std::function<void(std::size_t, std::size_t)>& progress, FollowedPath* path) {
    path->frame = candidate.frame;
    path->spin = candidate.spin;
    path->q.resize(static_cast<Eigen::Index>(points_.size()), 6);
    Angles q = candidate.start;
    Distance least;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::optional<Angles> next =
          next_angles(model_, target(i, candidate.frame, candidate.spin), q);
      if (!next || (*next - q).cwiseAbs().maxCoeff() > kLargestJump) {
        farthest_ = std::max(farthest_, i);
        return false;
      }
      q = *next;
      path->q.row(static_cast<Eigen::Index>(i)) = q.transpose();
      progress(i + 1, points_.size());
    }
    for (const std::size_t point : looked_at_) {
      least.include(distance_of(model_, path->q.row(static_cast<Eigen::Index>(point)).transpose()));
    }
    path->joint_margin = least.joint_margin;
    path->singular_value = least.singular_value;
    return true;
  }

  const RobotModel<double, 6>& model_;
  const programs::Program& program_;
  const std::vector<PathPoint>& points_;
  std::vector<std::size_t> looked_at_;
  std::size_t farthest_ = 0;
};

/// How far the robot reaches, m: all that lies between its axes.
double reach_of(const RobotModel<double, 6>& model) {
  double reach = model.tool.position.norm();
  for (std::size_t i = 1; i < 6; ++i) {
    reach += model.joints[i].origin.position.norm();
  }
  return reach;
}

/// Places in front of the robot, near ones, where it is stiffer, first.
std::vector<Vector3<double>> places_in_front(const RobotModel<double, 6>& model) {
  const double reach = reach_of(model);
  const double shoulder = model.joints[0].origin.position.z() + model.joints[1].origin.position.z();
  std::vector<Vector3<double>> places;
  for (const double out : {0.4, 0.5, 0.6}) {
    for (const double down : {0.1, 0.25, 0.4, 0.0}) {
      places.emplace_back(out * reach, 0, shoulder - down * reach);
    }
  }
  return places;
}

/// Candidates turned to joint angles by whole turns, those that begin nearest to them first.
std::vector<Candidate> nearest_first(std::vector<Candidate> candidates, const Angles& near) {
  for (Candidate& each : candidates) {
    each.start += 2 * M_PI * ((near - each.start) / (2 * M_PI)).array().round().matrix();
  }
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    return (a.start - near).norm() < (b.start - near).norm();
  });
  return candidates;
}

}  // namespace

FollowedPath follow(const RobotModel<double, 6>& model, const programs::Program& program,
                    const std::vector<PathPoint>& points, const std::optional<Pose<double>>& frame,
                    const std::optional<Angles>& near,
                    const std::function<void(std::size_t, std::size_t)>& progress) {
  Follower follower(model, program, points);
  if (frame && near) {
    return follower.first_of(nearest_first(follower.candidates(*frame, kSpins), *near), progress);
  }
  if (frame) {
    return follower.first_of(follower.candidates(*frame, kSpins), progress);
  }
  constexpr int kFewSpins = 6;
  constexpr double kGoodEnough = 0.5;
  std::vector<Candidate> best;
  for (const Vector3<double>& place : places_in_front(model)) {
    const std::vector<Candidate> here =
        follower.candidates(follower.frame_around(place), kFewSpins);
    if (!here.empty() && (best.empty() || here.front().quality > best.front().quality)) {
      best = here;
    }
    if (!best.empty() && best.front().quality >= kGoodEnough) {
      break;
    }
  }
  if (best.empty()) {
    return follower.first_of({}, progress);
  }
  return follower.first_of(follower.candidates(best.front().frame, kSpins), progress);
}

}  // namespace flexcomp::planning
