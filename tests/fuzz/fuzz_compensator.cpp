// Any sequence of ticks, commands, tables and configurations: whatever comes in, what goes out is
// finite and within its limits, and a lasting fault ends at zero.
//
// Input: one instruction a byte (see `run`), its operands behind it.
#include <cmath>

#include "byte_source.hpp"
#include "correction_watch.hpp"
#include "small_tables.hpp"

using namespace flexcomp;
using flexcomp::fuzz::ByteSource;
using flexcomp::fuzz::CorrectionWatch;
using flexcomp::fuzz::expect;

namespace {

using Core = Compensator<float, 6>;
using flexcomp::fuzz::Words;

constexpr int kMostTicks = 1'000;  // an input

Core::Config usual_config() {
  Core::Config config = test::compensator_config();
  config.hold_time = 0.01F;
  config.fade_time = 0.02F;
  config.ready_ticks = 3;
  return config;
}

Table opened(const Words& words) {
  Table table;
  Table::open(words.data(), 4 * words.size(), &table);
  return table;
}

const std::array<Words, 3>& tables() {
  static const std::array<Words, 3> kTables = {
      fuzz::path_table(test::kr270<float>()), fuzz::grid_table(test::kr270<float>()),
      fuzz::path_table(test::kr270_with_everything<float>())};
  return kTables;
}

class Run {
 public:
  explicit Run(ByteSource bytes) : bytes_(bytes), watch_(config_) {
    expect(core_.configure(config_) == Result::ok, "the usual configuration is accepted");
    expect(core_.set_table(opened(tables()[0])) == Result::ok, "the usual table is accepted");
    input_.setpoint = test::loop_angles<float>(0);
    input_.setpoint_age = 1e-3F;
    input_.wrench << 440, 1370, 635, 0, 3, 10.5F;
    input_.wrench_age = 1e-3F;
  }

  void run() {
    while (!bytes_.is_empty() && ticks_ < kMostTicks) {
      const auto instruction = bytes_.take<std::uint8_t>();
      switch (instruction % 16) {
        case 0:  // along the program
          advance(bytes_.take<std::uint8_t>());
          break;
        case 1:  // standing still
          stand(1 + instruction / 16 * 8);
          break;
        case 2:  // a number of the input, and back
          spoil_for_a_while(bytes_.take<std::uint8_t>());
          break;
        case 3:  // a number of the input, to stay
          input_number(bytes_.take<std::uint8_t>()) = bytes_.take<float>();
          break;
        case 4:
          static_cast<void>(core_.arm());
          break;
        case 5:
          core_.disarm();
          break;
        case 6:
          static_cast<void>(core_.reset());
          break;
        case 7:
          static_cast<void>(core_.set_table(opened(tables()[instruction / 16 % tables().size()])));
          break;
        case 8:
          input_.external_fault = !input_.external_fault;
          break;
        case 9:
          reconfigure(bytes_.take<std::uint8_t>());
          break;
        default:
          stand(1);
      }
    }
  }

  /// A lasting fault brings it to zero within hold time, fade time and the way back.
  void end() {
    const CorrectionLimits<float>& limits = config_.limits[0];
    const double move = static_cast<double>(limits.value / limits.rate) +
                        2 * static_cast<double>(limits.rate / limits.acceleration);
    const double time = static_cast<double>(config_.hold_time + config_.fade_time) + move;
    const double periods = 1.05 * time / static_cast<double>(config_.period) + 20;
    if (has_own_limits_ || periods > kMostTicks) {
      return;
    }
    input_.external_fault = true;
    stand(static_cast<int>(periods));
    expect(last_.correction.isZero(0), "a lasting fault ends at zero");
  }

 private:
  void tick() {
    last_ = core_.tick(input_);
    watch_.check(last_);
    ++ticks_;
  }

  void stand(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      tick();
    }
  }

  void advance(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      phase_ = std::fmod(phase_ + 1e-3, 0.35);
      input_.setpoint = test::loop_angles<float>(phase_);
      tick();
    }
  }

  float& input_number(unsigned place) {
    place %= 14;
    if (place < 6) {
      return input_.setpoint[static_cast<Eigen::Index>(place)];
    }
    if (place < 12) {
      return input_.wrench[static_cast<Eigen::Index>(place - 6)];
    }
    return place == 12 ? input_.setpoint_age : input_.wrench_age;
  }

  void spoil_for_a_while(unsigned place) {
    const Core::Input good = input_;
    input_number(place) = bytes_.take<float>();
    stand(1 + static_cast<int>(place / 14));
    input_ = good;
  }

  /// One number of the configuration becomes any other.
  void reconfigure(unsigned place) {
    Core::Config config = config_;
    const auto value = bytes_.take<float>();
    const std::array<float*, 13> scalars = {&config.period,           &config.gain,
                                            &config.filter_cutoff,    &config.force_range,
                                            &config.moment_range,     &config.setpoint_age_limit,
                                            &config.wrench_age_limit, &config.deflection_limit,
                                            &config.chart_margin,     &config.hold_time,
                                            &config.fade_time,        config.joint_speed.data(),
                                            &config.joint_speed[5]};
    const std::size_t joint = place / 16 % 6;
    if (place % 16 < scalars.size()) {
      *scalars[place % 16] = value;
    } else {
      CorrectionLimits<float>& limits = config.limits[joint];
      float* const numbers[] = {&limits.value, &limits.rate, &limits.acceleration};
      *numbers[place % 16 - scalars.size()] = value;
      has_own_limits_ = true;
    }
    if (core_.configure(config) == Result::ok) {
      config_ = config;
      watch_ = CorrectionWatch(config);
      static_cast<void>(core_.set_table(opened(tables()[0])));
    }
  }

  ByteSource bytes_;
  Core core_;
  Core::Config config_ = usual_config();
  CorrectionWatch watch_;
  Core::Input input_{};
  Core::Output last_{};
  double phase_ = 0;
  int ticks_ = 0;
  bool has_own_limits_ = false;  ///< of one joint, so that the others do not tell how long it takes
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Run run(ByteSource(data, size));
  run.run();
  run.end();
  return 0;
}
