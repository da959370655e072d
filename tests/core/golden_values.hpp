#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/test_robots.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/table_builder.hpp"

namespace flexcomp::test {

/// Numbers that belong together: their differences are judged by the largest of them.
template <typename Scalar>
struct GoldenGroup {
  std::string name;
  std::vector<Scalar> values;
};

/// Results of the core for inputs that are the same to the bit everywhere: chain, compliance,
/// look-up in a table, and a sequence of ticks with faults in it.
template <typename Scalar>
class GoldenValues {
  using Angles = JointVector<Scalar, 6>;

 public:
  GoldenValues() {
    add_chain();
    add_compliance();
    add_table();
    add_ticks();
  }

  const std::vector<GoldenGroup<Scalar>>& groups() const { return groups_; }

 private:
  template <typename Derived>
  void add(const std::string& name, const Eigen::MatrixBase<Derived>& values) {
    GoldenGroup<Scalar> group{name, {}};
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      group.values.push_back(values.derived().coeff(i % values.rows(), i / values.rows()));
    }
    groups_.push_back(group);
  }

  /// Multiples of 2⁻¹⁰: exact in both precisions, without a library function.
  static Angles posture(int number) {
    Angles q;
    for (int joint = 0; joint < 6; ++joint) {
      const int steps = (number * 389 + joint * 727 + number * joint * 53) % 1024 - 512;
      q[joint] = static_cast<Scalar>(steps) / Scalar(1024);
    }
    q[2] += 1;
    q[4] += Scalar(0.75);
    return q;
  }

  static Wrench<Scalar> wrench(int number) {
    Wrench<Scalar> w;
    w << static_cast<Scalar>(400 + number), static_cast<Scalar>(1300 - 8 * number), Scalar(635),
        Scalar(0.5), static_cast<Scalar>(number) / Scalar(8), Scalar(-10.5);
    return w;
  }

  void add_chain() {
    for (int i = 0; i < 8; ++i) {
      const auto kinematics = forward_kinematics(model_, posture(i));
      add("position " + std::to_string(i), kinematics.tcp.position);
      add("rotation " + std::to_string(i), kinematics.tcp.rotation);
      const Jacobian<Scalar, 6> jacobian = geometric_jacobian<Scalar, 6>(kinematics);
      add("jacobian " + std::to_string(i), jacobian);
    }
  }

  void add_compliance() {
    for (int i = 0; i < 6; ++i) {
      const auto result = deflection<Scalar, 6>(model_, posture(i), wrench(i));
      const Vector3<Scalar> shift = result.tcp.template head<3>();
      const Vector3<Scalar> turn = result.tcp.template tail<3>();
      add("shift " + std::to_string(i), shift);
      add("turn " + std::to_string(i), turn);
    }
  }

  /// Straight pieces between postures a little apart.
  static Angles program_at(int step) {
    const int piece = step / 16 % 8;
    Angles q = posture(3);
    for (int joint = 0; joint < 6; ++joint) {
      const int from = (piece * (joint + 3)) % 8;
      const int to = ((piece + 1) * (joint + 3)) % 8;
      q[joint] += static_cast<Scalar>(16 * from + (to - from) * (step % 16)) / Scalar(4096);
    }
    return q;
  }

  void make_table() {
    std::vector<Angles> program;
    for (int piece = 0; piece <= 8; ++piece) {
      program.push_back(program_at(16 * piece));
    }
    program.back() = program.front();
    std::size_t size = 0;
    words_.resize(1 << 14);
    const TableRequirements<Scalar> wanted = {Scalar(2000), Scalar(50), Scalar(2e-5), Scalar(2e-5),
                                              Scalar(0)};
    result_ = build_path_table<Scalar, 6>(model_, program.data(), program.size(), wanted,
                                          words_.data(), 4 * words_.size(), &size);
    if (result_ == Result::ok) {
      result_ = Table::open(words_.data(), size, &table_);
    }
  }

  void add_table() {
    make_table();
    GoldenGroup<Scalar> built{"table", {static_cast<Scalar>(result_ == Result::ok)}};
    groups_.push_back(built);
    if (result_ != Result::ok) {
      return;
    }
    TableCursor cursor;
    for (int step = 0; step < 128; step += 5) {
      Scalar outside = 0;
      const auto response = look_up_response<Scalar, 6>(table_, program_at(step), wrench(step % 7),
                                                        &cursor, &outside);
      const Vector3<Scalar> shift = response.deflection.template head<3>();
      add("shift by table " + std::to_string(step), shift);
      add("correction by table " + std::to_string(step), response.correction);
    }
  }

  CompensatorConfig<Scalar, 6> config() const {
    CompensatorConfig<Scalar, 6> config;
    config.period = Scalar(1) / Scalar(256);
    config.model_hash = model_hash(model_);
    config.filter_cutoff = 20;
    config.force_range = 6000;
    config.moment_range = 600;
    config.setpoint_age_limit = Scalar(0.03125);
    config.wrench_age_limit = Scalar(0.03125);
    config.joint_speed.setConstant(Scalar(2));
    config.limits.fill({Scalar(0.015625), Scalar(0.125), Scalar(8)});
    config.deflection_limit = Scalar(0.0078125);
    config.chart_margin = Scalar(0.0625);
    config.hold_time = Scalar(0.0625);
    config.fade_time = Scalar(0.25);
    return config;
  }

  /// Arming, the program, a wrench that is not finite, a stale setpoint for longer than the hold
  /// time, reset and arming again.
  void add_ticks() {
    Compensator<Scalar, 6> core;
    core.configure(config());
    core.set_table(table_);
    for (int i = 0; i < 640; ++i) {
      CompensatorInput<Scalar, 6> input{program_at(i / 4), Scalar(0), wrench(i / 4 % 7), Scalar(0)};
      if (i >= 200 && i < 208) {
        input.wrench[2] = std::numeric_limits<Scalar>::quiet_NaN();
      }
      if (i >= 300 && i < 400) {
        input.setpoint_age = 1;
      }
      if (i == 20 || i == 440) {
        core.reset();
        core.arm();
      }
      const auto output = core.tick(input);
      if (i % 20 == 7) {
        add("correction " + std::to_string(i), output.correction);
        GoldenGroup<Scalar> state{
            "state " + std::to_string(i),
            {static_cast<Scalar>(output.status & 0xFFFFU), static_cast<Scalar>(output.state)}};
        groups_.push_back(state);
      }
    }
  }

  RobotModel<Scalar, 6> model_ = kr270<Scalar>();
  std::vector<GoldenGroup<Scalar>> groups_;
  std::vector<std::uint32_t> words_;
  Table table_;
  Result result_ = Result::no_table;
};

}  // namespace flexcomp::test
