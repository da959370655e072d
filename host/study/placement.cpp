#include "study/placement.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "planning/inverse_kinematics.hpp"

namespace flexcomp::study {
namespace {

constexpr unsigned kUnknowns = 5;
constexpr double kOutOfReach = 1e3;   // m: worse than any displacement
constexpr double kLargestStep = 0.5;  // rad between neighbours of all points: no change of branch

using Angles = JointVector<double, 6>;

/// A job as poses of the TCP and wrenches, and its middle.
struct Job {
  recording::Recording recording;
  std::vector<Pose<double>> poses;
  Vector3<double> middle = Vector3<double>::Zero();

  Job(const RobotModel<double, 6>& model, const recording::Recording& given) : recording(given) {
    const recording::Samples& q = recording::require(given, given.q_cmd, "q_cmd_1..6");
    recording::require(given, given.wrench, "fx,fy,fz,mx,my,mz");
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      poses.push_back(forward_kinematics<double, 6>(model, q.row(i).transpose()).tcp);
      middle += poses.back().position / static_cast<double>(q.rows());
    }
  }

  Angles angles(Eigen::Index row) const { return recording.q_cmd->row(row).transpose(); }
};

Matrix3<double> about_z(double angle) {
  return Eigen::AngleAxisd(angle, Vector3<double>::UnitZ()).toRotationMatrix();
}

Pose<double> moved(const Job& job, Eigen::Index row, const Placement& placement) {
  const Pose<double>& pose = job.poses[static_cast<std::size_t>(row)];
  const Matrix3<double> turn = about_z(placement.turn);
  return {turn * pose.rotation * about_z(placement.spin),
          job.middle + placement.shift + turn * (pose.position - job.middle)};
}

Wrench<double> turned_wrench(const Job& job, Eigen::Index row, const Placement& placement) {
  const Matrix3<double> turn = about_z(placement.turn);
  const Wrench<double> wrench = job.recording.wrench->row(row).transpose();
  Wrench<double> turned;
  turned << turn * wrench.head<3>(), turn * wrench.tail<3>();
  return turned;
}

/// Searches, with NLopt, for where a job is displaced least.
class Search {
 public:
  Search(const RobotModel<double, 6>& model, const Job& job, const PlacementRequest& request,
         const std::function<void(int)>& progress)
      : model_(model), job_(job), request_(request), progress_(progress) {
    for (Joint<double>& joint : inner_.joints) {
      joint.lower += request.joint_margin;
      joint.upper -= request.joint_margin;
    }
    const auto rows = static_cast<Eigen::Index>(job.poses.size());
    const Eigen::Index count = std::min<Eigen::Index>(rows, request.points);
    for (Eigen::Index i = 0; i < count; ++i) {
      looked_at_.push_back(count > 1 ? i * (rows - 1) / (count - 1) : 0);
    }
  }

  Placement best() {
    minimize(NLOPT_GN_DIRECT_L, request_.evaluations * 2 / 3);
    minimize(NLOPT_LN_SBPLX, request_.evaluations / 3);
    if (!(least_ < kOutOfReach)) {
      throw InputError(fmt::format(
          "{}: no place that was looked at is within the joint limits and away from singularities",
          job_.recording.file));
    }
    return best_;
  }

  /// The job's joint angles in a place, all rows; nothing where it is out of reach.
  std::optional<recording::Samples> follow(const Placement& placement) {
    std::vector<Eigen::Index> rows(job_.poses.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i] = static_cast<Eigen::Index>(i);
    }
    recording::Samples q(static_cast<Eigen::Index>(rows.size()), 6);
    for (const Angles& start : starts()) {
      std::size_t reached = 0;
      Angles at = start;
      while (reached < rows.size() && step(rows[reached], placement, &at)) {
        q.row(rows[reached++]) = at.transpose();
      }
      if (reached == rows.size()) {
        return q;
      }
    }
    return std::nullopt;
  }

 private:
  std::array<double, kUnknowns> bounds() const {
    return {request_.most_shift.x(), request_.most_shift.y(), request_.most_shift.z(),
            request_.most_turn, request_.most_spin};
  }

  static Placement placement_of(const double* x) { return {{x[0], x[1], x[2]}, x[3], x[4]}; }

  void minimize(nlopt_algorithm algorithm, int evaluations) {
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimizer(
        nlopt_create(algorithm, kUnknowns), nlopt_destroy);
    std::array<double, kUnknowns> lower = bounds();
    std::array<double, kUnknowns> upper = bounds();
    std::array<double, kUnknowns> x = {best_.shift.x(), best_.shift.y(), best_.shift.z(),
                                       best_.turn, best_.spin};
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      // NLopt divides by the widths: what is fixed keeps a width that does nothing.
      upper[i] = std::max(upper[i], 1e-9);
      lower[i] = -upper[i];
      x[i] = std::clamp(x[i], lower[i], upper[i]);
    }
    nlopt_set_lower_bounds(optimizer.get(), lower.data());
    nlopt_set_upper_bounds(optimizer.get(), upper.data());
    nlopt_set_maxeval(optimizer.get(), std::max(evaluations, 1));
    nlopt_set_xtol_rel(optimizer.get(), 1e-4);
    nlopt_set_min_objective(
        optimizer.get(),
        [](unsigned, const double* at, double*, void* self) {
          return static_cast<Search*>(self)->evaluate(placement_of(at));
        },
        this);
    double least = 0;
    nlopt_optimize(optimizer.get(), x.data(), &least);
  }

  /// The largest displacement (m); beyond all of them where the job is out of reach, less so the
  /// farther it gets.
  double evaluate(const Placement& placement) {
    progress_(++evaluated_);
    double worst = kOutOfReach + 1;
    Angles first;
    for (const Angles& start : starts()) {
      double largest = 0;
      std::size_t reached = 0;
      Angles at = start;
      while (reached < looked_at_.size() && step(looked_at_[reached], placement, &at)) {
        first = reached == 0 ? at : first;
        largest = std::max(largest, displacement(looked_at_[reached], placement, at));
        ++reached;
      }
      const double missing =
          1 - static_cast<double>(reached) / static_cast<double>(looked_at_.size());
      worst = std::min(worst, missing > 0 ? kOutOfReach + missing : largest);
      if (missing == 0) {
        break;
      }
    }
    if (worst < least_) {
      least_ = worst;
      best_ = placement;
      best_start_ = first;
    }
    return worst;
  }

  std::vector<Angles> starts() const {
    std::vector<Angles> all = {job_.angles(0)};
    if (least_ < kOutOfReach) {
      all.push_back(best_start_);
    }
    return all;
  }

  /// To the angles at a row from those before; false where there are none that may be.
  bool step(Eigen::Index row, const Placement& placement, Angles* at) const {
    const std::optional<Angles> q = planning::solve_near(inner_, moved(job_, row, placement), *at);
    const bool is_first = row == looked_at_.front();
    if (!q || (!is_first && (*q - *at).cwiseAbs().maxCoeff() > step_limit())) {
      return false;
    }
    *at = *q;
    const auto there = forward_kinematics<double, 6>(model_, *q);
    const Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(geometric_jacobian(there));
    return svd.singularValues()[5] >= request_.least_singular_value;
  }

  /// Points that are looked at lie far apart; the fewer, the more.
  double step_limit() const {
    return std::max(kLargestStep, 8.0 / static_cast<double>(looked_at_.size()));
  }

  double displacement(Eigen::Index row, const Placement& placement, const Angles& q) const {
    return deflection<double, 6>(model_, q, turned_wrench(job_, row, placement))
        .tcp.template head<3>()
        .norm();
  }

  const RobotModel<double, 6>& model_;
  RobotModel<double, 6> inner_ = model_;  ///< with its limits drawn in
  const Job& job_;
  const PlacementRequest& request_;
  std::function<void(int)> progress_;
  std::vector<Eigen::Index> looked_at_;
  int evaluated_ = 0;
  Placement best_;
  Angles best_start_ = Angles::Zero();
  double least_ = kOutOfReach;
};

void check(const PlacementRequest& request) {
  if (!(request.most_shift.minCoeff() >= 0) || !request.most_shift.allFinite() ||
      !(request.most_turn >= 0 && request.most_turn <= 2 * M_PI) ||
      !(request.most_spin >= 0 && request.most_spin <= 2 * M_PI) || request.points < 2 ||
      request.evaluations < 1 || !(request.joint_margin >= 0) ||
      !(request.least_singular_value >= 0)) {
    throw InputError(
        "shifts and margins must not be below zero, turn and spin at most a whole turn, and there "
        "must be something to evaluate");
  }
}

/// The displacements along a path that is in its place.
PlacedJob judged(const RobotModel<double, 6>& model, recording::Recording path,
                 const Placement& placement) {
  PlacedJob job;
  job.placement = placement;
  for (Eigen::Index i = 0; i < path.size(); ++i) {
    const Vector3<double> off = deflection<double, 6>(model, path.q_cmd->row(i).transpose(),
                                                      path.wrench->row(i).transpose())
                                    .tcp.template head<3>();
    job.largest = std::max(job.largest, off.norm());
    job.mean_square += off.squaredNorm();
  }
  job.mean_square = std::sqrt(job.mean_square / static_cast<double>(path.size()));
  job.path = std::move(path);
  return job;
}

/// The job in a place, at those joint angles.
recording::Recording moved_job(const Job& job, const Placement& placement,
                               const recording::Samples& q) {
  recording::Recording path;
  path.file = job.recording.file;
  path.lines = job.recording.lines;
  path.time = job.recording.time;
  path.program_line = job.recording.program_line;
  path.q_cmd = q;
  path.wrench = recording::Samples(path.size(), 6);
  for (Eigen::Index i = 0; i < path.size(); ++i) {
    path.wrench->row(i) = turned_wrench(job, i, placement).transpose();
  }
  return path;
}

}  // namespace

PlacedJob as_placed(const RobotModel<double, 6>& model, const recording::Recording& job) {
  return judged(model, Job(model, job).recording, {});
}

PlacedJob best_placement(const RobotModel<double, 6>& model, const recording::Recording& job,
                         const PlacementRequest& request,
                         const std::function<void(int)>& progress) {
  check(request);
  const Job given(model, job);
  // Between points that lie far apart the job may leave its branch: then look at more of them.
  PlacementRequest dense = request;
  int done = 0;
  while (true) {
    Search search(model, given, dense, [&](int evaluated) { progress(done + evaluated); });
    const Placement placement = search.best();
    const std::optional<recording::Samples> q = search.follow(placement);
    if (q) {
      return judged(model, moved_job(given, placement, *q), placement);
    }
    if (static_cast<std::size_t>(dense.points) >= given.poses.size()) {
      throw InputError(fmt::format(
          "{}: the place that was found cannot be followed at every row without a jump of more "
          "than {} rad: rows closer together",
          job.file, kLargestStep));
    }
    dense.points *= 2;
    done += request.evaluations;
  }
}

}  // namespace flexcomp::study
