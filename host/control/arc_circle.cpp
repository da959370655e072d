#include "control/arc_circle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "control/periodic_path.hpp"
#include "control/tracking.hpp"
#include "error.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/table_builder.hpp"
#include "geometry/circularity.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::control {
namespace {

using Six = JointVector<double, 6>;

constexpr double kRunUp = 2;        // s, to come up to speed and into the cut
constexpr int kTicksToCorrect = 4;  // of the controller, for one of the compensator
constexpr double kSmoothing = 2 * 3.14159265358979323846 * 5;  // rad/s

using simulation::without_joint_springs;

/// The core's compensator with a table of its own along the path.
class PathCompensator {
 public:
  PathCompensator(const RobotModel<double, 6>& model, const recording::Recording& path,
                  double period) {
    std::vector<Six> points;
    for (Eigen::Index row = 0; row < path.size(); ++row) {
      points.emplace_back(path.q_cmd->row(row).transpose());
    }
    const TableRequirements<double> wanted = {
        1.2 * path.wrench->leftCols<3>().rowwise().norm().maxCoeff() + 1,
        1.2 * path.wrench->rightCols<3>().rowwise().norm().maxCoeff() + 1, 1e-6, 1e-6, 0};
    words_.resize(std::size_t{1} << 22);
    std::size_t size = 0;
    Result result = build_path_table<double, 6>(model, points.data(), points.size(), wanted,
                                                words_.data(), 4 * words_.size(), &size);
    Table table;
    result = result == Result::ok ? Table::open(words_.data(), size, &table) : result;
    result = result == Result::ok ? core_.configure(configuration(model, period)) : result;
    result = result == Result::ok ? core_.set_table(table) : result;
    if (result != Result::ok) {
      throw InputError(fmt::format("no compensation of this circle: {}", describe(result)));
    }
  }

  Six correction(const Six& setpoint, const Wrench<double>& wrench) {
    const auto output = core_.tick({setpoint, 0, wrench, 0});
    if (core_.state() == State::off) {
      core_.arm();
    }
    return output.correction;
  }

 private:
  static CompensatorConfig<double, 6> configuration(const RobotModel<double, 6>& model,
                                                    double period) {
    CompensatorConfig<double, 6> config;
    config.period = period;
    config.model_hash = model_hash(model);
    config.filter_cutoff = 20;
    config.force_range = 1e4;
    config.moment_range = 1e3;
    config.setpoint_age_limit = config.wrench_age_limit = 0.02;
    config.joint_speed.setConstant(5);
    config.limits.fill({0.02, 0.2, 5});
    config.deflection_limit = 0.02;
    config.chart_margin = 0.02;
    config.hold_time = 0.05;
    config.fade_time = 0.5;
    return config;
  }

  std::vector<std::uint32_t> words_;
  Compensator<double, 6> core_;
};

/// Low-pass that turns steps of the correction into a motion with two derivatives.
struct Smoothed {
  Six value = Six::Zero();
  Six rate = Six::Zero();
  Six curvature = Six::Zero();

  void follow(const Six& target, double period) {
    curvature = kSmoothing * (kSmoothing * (target - value) - 2 * rate);
    rate += period * curvature;
    value += period * rate;
  }
};

/// One run over the circle and a little more.
class CircleMill {
 public:
  CircleMill(const CircleTrial& trial, const recording::Recording& path)
      : trial_(trial),
        path_(path),
        turn_(path.time[path.size() - 1] - path.time[0]),
        angles_(path.q_cmd->topRows(path.size() - 1)),
        wrenches_(path.wrench->topRows(path.size() - 1)),
        rigid_(model::chain_of(without_joint_springs(trial.arm.model))) {}

  CircleRun run(const std::string& name, bool adaptive, bool compensated) {
    CircleRun result;
    result.control = name;
    auto compensator = compensated ? std::make_unique<PathCompensator>(
                                         adaptive ? without_joint_springs(trial_.nominal.model)
                                                  : trial_.nominal.model,
                                         path_, kTicksToCorrect * trial_.gains.period)
                                   : nullptr;
    AdaptiveRobustController<double, 6> arc;
    if (arc.configure(trial_.nominal.model, trial_.nominal.inertia, trial_.gains) != Result::ok) {
      throw InputError("the core refuses the arm or its gains");
    }
    const Controller<6> servo =
        with_feed_forward<6>(trial_.nominal, pd_controller<6>(matching_pd<6>(trial_.gains)));
    Smoothed shift;
    Six target = Six::Zero();
    int tick = 0;
    TrackingJob<6> job;
    job.arm = trial_.arm;
    job.period = trial_.gains.period;
    job.reference = [this](double time) { return reference(time); };
    job.load = [this](double time, const Six& link) { return torque_of(wrench_at(time), link); };
    job.duration = kRunUp + 1.25 * turn_;
    job.settled = job.duration - turn_;
    double time = 0;
    const auto control = [&](ArcInput<double, 6> input) -> Six {
      time = tick * job.period;
      const Wrench<double> wrench = wrench_at(time);
      if (compensator && tick % kTicksToCorrect == 0) {
        target = compensator->correction(input.wanted, wrench);
      }
      ++tick;
      shift.follow(target, job.period);
      result.correction = std::max(result.correction, target.cwiseAbs().maxCoeff());
      input.wanted += shift.value;
      input.wanted_velocity += shift.rate;
      input.wanted_acceleration += shift.curvature;
      if (adaptive) {
        input.external_torque = torque_of(wrench, input.link);
        return arc.tick(input).torque;
      }
      return servo(input);
    };
    const auto observe = [&](double at, const ArcInput<double, 6>& input, const Six&) {
      if (at >= job.settled && tick % 20 == 0) {
        record(at, input.link, &result);
      }
    };
    track<6>(job, control, observe);
    result.circularity = geometry::least_squares_circularity(result.path).value();
    return result;
  }

 private:
  /// Turns of the circle: from rest with a constant jerk-free run-up (cubic), then evenly.
  struct Phase {
    double value, rate, curvature;
  };
  Phase phase(double time) const {
    if (time >= kRunUp) {
      return {(time - kRunUp / 2) / turn_, 1 / turn_, 0};
    }
    const double x = time / kRunUp;  // rate 3x² − 2x³, its integral x³ − x⁴/2
    return {kRunUp / turn_ * (x * x * x - x * x * x * x / 2), (3 * x * x - 2 * x * x * x) / turn_,
            (6 * x - 6 * x * x) / (kRunUp * turn_)};
  }

  Reference<6> reference(double time) const {
    const Phase at = phase(time);
    const PeriodicPath::Sample q = angles_.at(at.value);
    return {q.value, q.slope * at.rate, q.curvature * (at.rate * at.rate) + q.slope * at.curvature};
  }

  Wrench<double> wrench_at(double time) const {
    const double entered = std::clamp(time / kRunUp, 0.0, 1.0);
    return entered * entered * (3 - 2 * entered) * wrenches_.at(phase(time).value).value;
  }

  Six torque_of(const Wrench<double>& wrench, const Six& link) const {
    const auto kinematics = forward_kinematics<double, 6>(trial_.nominal.model, link);
    return geometric_jacobian<double, 6>(kinematics).transpose() * wrench;
  }

  /// Where the tool is, with what bends beyond the link encoders.
  void record(double time, const Six& link, CircleRun* result) const {
    const Vector3<double> tool = simulation::settle(rigid_, link, wrench_at(time)).tcp.position;
    const Vector3<double> wanted =
        forward_kinematics<double, 6>(trial_.nominal.model, reference(time).position).tcp.position;
    result->deviation = std::max(result->deviation, (tool - wanted).norm());
    const Vector3<double> off = tool - trial_.plan.center;
    result->path.emplace_back(off.dot(trial_.plan.first_axis), off.dot(trial_.plan.second_axis));
  }

  const CircleTrial& trial_;
  const recording::Recording& path_;
  double turn_;  ///< s
  PeriodicPath angles_;
  PeriodicPath wrenches_;
  model::Chain rigid_;
};

}  // namespace

std::vector<CircleRun> mill_circle(const CircleTrial& trial) {
  const recording::Recording path =
      planning::plan_circle(trial.nominal.model, trial.plan, [](int) {});
  CircleMill mill(trial, path);
  return {mill.run("servo", false, false), mill.run("servo + compensator", false, true),
          mill.run("adaptive robust", true, false),
          mill.run("adaptive robust + compensator", true, true)};
}

std::string circle_script(const std::vector<CircleRun>& runs, double radius,
                          const std::string& title) {
  constexpr double kMagnified = 50;
  constexpr const char* kColours[] = {"#d7191c", "#fdae61", "#1a9641", "#2c7bb6"};
  std::string text;
  std::string plots =
      fmt::format("{0}*cos(t), {0}*sin(t) with lines lw 1 dt 2 lc rgb '#888888' title 'programmed'",
                  1e3 * radius);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    text += fmt::format("$path{} << EOD\n", i);
    const Eigen::Vector2d center = geometry::least_squares_circularity(runs[i].path).center;
    for (const Eigen::Vector2d& point : runs[i].path) {
      const Eigen::Vector2d arm = point - center;
      const Eigen::Vector2d shown =
          arm.normalized() * (radius + kMagnified * (arm.norm() - radius));
      text += fmt::format("{:.6g} {:.6g}\n", 1e3 * shown.x(), 1e3 * shown.y());
    }
    text += "EOD\n";
    plots += fmt::format(", $path{} with lines lw 2 lc rgb '{}' title '{}: {:.3f} mm'", i,
                         kColours[i % 4], runs[i].control, 1e3 * runs[i].circularity);
  }
  return text + fmt::format(
                    "set title \"{}\" noenhanced\nset size ratio -1\nset parametric\n"
                    "set trange [0:2*pi]\nset samples 400\nset xlabel 'from the least-squares "
                    "centre, mm'\n"
                    "set ylabel 'mm (radial errors {:g} times as large)'\n"
                    "set key outside right top vertical\nset lmargin at screen 0.1\nset rmargin at "
                    "screen 0.5\nset grid lc rgb "
                    "'#dddddd'\nplot {}\n",
                    title, kMagnified, plots);
}

}  // namespace flexcomp::control
