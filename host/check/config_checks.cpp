#include "check/config_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "check/arm.hpp"
#include "control/path_gain.hpp"
#include "controller/kuka_axes.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::check {
namespace {

using Config = CompensatorConfig<float, 6>;

/// Joints whose plausible speed is below what the robot comes up to, or far above it: a jump of a
/// setpoint passes then.
Checks check_speeds(const std::string& file, const Config& config, const model::Robot& robot) {
  constexpr double kLoose = 3;  // times the limit
  std::string low;
  std::string high;
  for (Eigen::Index joint = 0; joint < joint_count(robot); ++joint) {
    const double limit = robot.dynamics[static_cast<std::size_t>(joint)].velocity;
    const auto speed = static_cast<double>(config.joint_speed[joint]);
    if (limit > 0 && (speed < limit || speed > kLoose * limit)) {
      std::string& list = speed < limit ? low : high;
      list += fmt::format("{}joint {} ({:.4g}, the robot {:.4g} rad/s)", list.empty() ? "" : ", ",
                          joint + 1, speed, limit);
    }
  }
  Checks checks;
  const auto warn = [&](const std::string& joints, const char* what) {
    if (!joints.empty()) {
      checks.push_back({Severity::warning, "config", "config.speed",
                        fmt::format("{}: joint-speed is {}: {}", file, what, joints),
                        "set it a little above the robot's limit; flexcomp configure does"});
    }
  };
  warn(low, "too low, so that the robot's own motion counts as implausible");
  warn(high, "so high that jumps of the setpoint pass");
  return checks;
}

Checks check_against_robot(const std::string& file, const Config& config,
                           const model::Robot& robot) {
  Checks checks;
  const std::uint64_t hash = model_hash(model::six_axis_model(robot));
  if (config.model_hash != hash) {
    checks.push_back(
        {Severity::error, "config", "config.model",
         fmt::format("{}: model-hash {:016x} is of another robot, tool or payload than "
                     "the model ({:016x})",
                     file, config.model_hash, hash),
         "make the configuration anew: flexcomp configure"});
  }
  add(check_speeds(file, config, robot), &checks);
  return checks;
}

/// Times of the node against its period: what a single message that is late or lost does.
Checks check_times(const std::string& file, const Config& config) {
  Checks checks;
  const auto warn = [&](const std::string& what, const std::string& fix) {
    checks.push_back(
        {Severity::warning, "config", "config.times", fmt::format("{}: {}", file, what), fix});
  };
  const float ms = 1000 * config.period;
  for (const auto& [name, limit] : {std::pair{"setpoint", config.setpoint_age_limit},
                                    std::pair{"wrench", config.wrench_age_limit}}) {
    if (limit < config.period) {
      warn(fmt::format("{}-age-limit is {:.4g} ms, less than the period of {:.4g} ms: a {} of the "
                       "period before counts as stale",
                       name, 1000 * limit, ms, name),
           "set it to a few periods");
    }
  }
  if (config.hold_time < config.period) {
    warn(fmt::format("hold-time is {:.4g} ms, less than the period of {:.4g} ms: a single bad tick "
                     "ends the correction",
                     1000 * config.hold_time, ms),
         "set it to as long as a fault may last");
  }
  if (config.filter_cutoff * config.period > 0.5F) {
    warn(fmt::format("filter-cutoff is {:.4g} Hz; what comes every {:.4g} ms has nothing above "
                     "{:.4g} Hz, so that it filters little",
                     config.filter_cutoff, ms, 0.5F / config.period),
         "lower it, or set it to 0 for no filter");
  }
  return checks;
}

Checks check_against_table(const std::string& file, const Config& config, const Table& table) {
  Checks checks;
  const TableHeader& header = table.header();
  const double largest = control::largest_gain_in(header, static_cast<double>(config.period),
                                                  static_cast<double>(config.filter_cutoff));
  if (largest > 0 && static_cast<double>(config.gain) > 1.0001 * largest) {
    const bool is_refused = config.gain > 1.0001F * header.largest_gain;
    checks.push_back(
        {Severity::error, "config", "config.gain",
         fmt::format("{}: gain {:.4g} is above the largest that is safe with the table's process, "
                     "{:.4g} every {:g} s through {:g} Hz{}",
                     file, config.gain, largest, config.period, config.filter_cutoff,
                     is_refused ? ": flexcompd will not take the table" : ""),
         "lower the gain; flexcomp configure --period writes the largest safe one"});
  }
  if (config.force_range < header.force_bound || config.moment_range < header.moment_bound) {
    checks.push_back(
        {Severity::warning, "config", "config.range",
         fmt::format("{}: forces above {:.4g} N and moments above {:.4g} N·m count as implausible, "
                     "but the table is for up to {:.4g} N and {:.4g} N·m",
                     file, config.force_range, config.moment_range, header.force_bound,
                     header.moment_bound),
         "set force-range and moment-range to the sensor's range, above the table's wrench"});
  }
  return checks;
}

/// How the node counts the axes of a KUKA on RSI, and whether the URDF's geometry says the same.
Checks check_axes(const std::string& file, const RsiOptions& rsi, const model::Robot& robot) {
  const AxisConvention told = to_config(rsi, 0).axes;
  const std::string how = fmt::format("signs {}, zeros {} degrees", controller::list_of(told.sign),
                                      controller::list_of(told.zero));
  const std::optional<AxisConvention> seen = controller::kuka_axes(model::six_axis_model(robot));
  if (!seen) {
    return {
        {Severity::warning, "config", "config.axes",
         fmt::format("{}: the axes of RSI are taken with {}; the URDF is not built as a KUKA, so "
                     "its geometry cannot say whether that is right",
                     file, how),
         "compare angles on the controller's panel with the URDF's at two postures"}};
  }
  constexpr double kAgree = 1e-3;  // degrees
  bool agrees = seen->sign == told.sign;
  for (std::size_t i = 0; i < told.zero.size(); ++i) {
    agrees = agrees && std::abs(seen->zero[i] - told.zero[i]) < kAgree;
  }
  if (agrees) {
    return {
        {Severity::note, "config", "config.axes",
         fmt::format("{}: the axes of RSI are taken with {}, as the URDF's geometry has them; the "
                     "zeros of A1, A4 and A6 it cannot say",
                     file, how),
         "compare angles on the controller's panel with the URDF's once"}};
  }
  return {{Severity::error, "config", "config.axes",
           fmt::format("{}: the axes of RSI are taken with {}; the URDF's geometry says signs {}, "
                       "zeros {} degrees",
                       file, how, controller::list_of(seen->sign), controller::list_of(seen->zero)),
           "set rsi-sign and rsi-zero; flexcomp configure --rsi does"}};
}

/// m, by which weight and wrench move the TCP; infinite where the robot does not come to rest.
double bend_at(const model::Robot& robot, const Eigen::RowVectorXd& q,
               const Eigen::RowVectorXd& wrench) {
  try {
    const Pose<double> bent =
        simulation::settle(robot.elastic, q.transpose(), wrench.transpose()).tcp;
    return (bent.position - tcp_at(robot, q).position).norm();
  } catch (const simulation::NoRest&) {
    return INFINITY;
  }
}

}  // namespace

Checks check_deflection(const std::string& file, const Options& options, const model::Robot& robot,
                        const recording::Recording& path) {
  if (!path.q_cmd || !path.wrench || !path.q_cmd->allFinite() || !path.wrench->allFinite() ||
      joint_count(robot) != 6) {
    return {};
  }
  Eigen::Index worst = 0;
  double most = 0;
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    const double bend = bend_at(robot, path.q_cmd->row(row), path.wrench->row(row));
    if (bend > most) {
      most = bend;
      worst = row;
    }
  }
  const auto said = [&](Severity severity, const char* option, double limit, const char* then) {
    return Check{
        severity, "config", "config.deflection",
        fmt::format("{}: {} is {:.4g} mm, but under its wrench the robot bends by {:.4g} mm "
                    "at {}: {}",
                    file, option, 1e3 * limit, 1e3 * most, path.place(worst), then),
        "raise deflection-limit, deflection-warning and deflection-error above that, if the "
        "model's springs are right; else take less force"};
  };
  const NodeConfig& node = options.settings.node;
  const auto error = static_cast<double>(node.deflection_error);
  const auto limit = static_cast<double>(node.compensator.deflection_limit);
  if (most > error) {
    return {said(Severity::error, "deflection-error", error,
                 "the correction fades out and is latched (predicted deflection too large)")};
  }
  if (static_cast<double>(node.compensator.gain) * most > limit) {
    return {
        said(Severity::warning, "deflection-limit", limit, "no more than the limit is corrected")};
  }
  return {};
}

Checks check_config(const std::string& file, const Options& options, const model::Robot* robot,
                    const Table* table) {
  const Config& config = options.settings.node.compensator;
  Checks checks = check_times(file, config);
  if (robot != nullptr && model::six_axis_model(robot->elastic)) {
    add(check_against_robot(file, config, *robot), &checks);
    if (!options.rsi.address.empty()) {
      add(check_axes(file, options.rsi, *robot), &checks);
    }
  }
  if (table != nullptr) {
    if (config.model_hash != table->model_hash()) {
      checks.push_back({Severity::error, "config", "config.model",
                        fmt::format("{}: model-hash {:016x} is not that of the table ({:016x})",
                                    file, config.model_hash, table->model_hash()),
                        "make configuration and table from the same model"});
    }
    add(check_against_table(file, config, *table), &checks);
  }
  return checks;
}

}  // namespace flexcomp::check
