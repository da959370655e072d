#include <cstdio>
#include <flexcomp/compensator.hpp>
#include <flexcomp/status.hpp>
#include <fstream>
#include <iterator>
#include <vector>

using Compensator = flexcomp::Compensator<float, 6>;

// Stands at the first posture of a table for a second, under a constant wrench.
// Usage: controller_loop TABLE
int main(int count, char** arguments) {
  if (count != 2) {
    return 2;
  }
  std::ifstream file(arguments[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};  // must outlive its use
  flexcomp::Table table;
  flexcomp::Result result = flexcomp::Table::open(bytes.data(), bytes.size(), &table);
  if (result != flexcomp::Result::ok) {
    std::printf("%s\n", flexcomp::describe(result));
    return 1;
  }

  Compensator::Config config;
  config.period = 4e-3F;
  config.model_hash = table.model_hash();  // on a robot: the number in node.toml
  config.filter_cutoff = 20;
  config.force_range = 6000;
  config.moment_range = 600;
  config.setpoint_age_limit = 20e-3F;
  config.wrench_age_limit = 20e-3F;
  config.joint_speed.setConstant(2);
  config.limits.fill({0.01F, 0.1F, 5});  // value, rate, acceleration
  config.deflection_limit = 5e-3F;
  config.chart_margin = 0.02F;
  config.hold_time = 0.05F;
  config.fade_time = 0.5F;
  Compensator compensator;
  result = compensator.configure(config);
  if (result == flexcomp::Result::ok) {
    result = compensator.set_table(table);
  }
  if (result != flexcomp::Result::ok) {
    std::printf("%s\n", flexcomp::describe(result));
    return 1;
  }

  Compensator::Input input{};  // both ages are zero: setpoint and wrench are of now
  for (int joint = 0; joint < 6; ++joint) {
    input.setpoint[joint] = table.record(0)[joint];
  }
  input.wrench << 440, 1370, 635, 0, 3, 10.5F;
  Compensator::Output output{};
  for (int tick = 0; tick < 250; ++tick) {  // once every 4 ms
    output = compensator.tick(input);
    if (tick == 20) {
      compensator.arm();
    }
    // send output.setpoint to the drives; log output.status
  }
  std::printf("%s: joint 2 corrected by %.1f urad\n", flexcomp::describe(output.state),
              1e6 * static_cast<double>(output.correction[1]));
  return output.state == flexcomp::State::active ? 0 : 1;
}
