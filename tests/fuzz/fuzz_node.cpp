// A whole node between hostile senders: CAN frames and LCM messages of any content, commands, table
// transfers and bad clocks. The correction stays within its limits, and a table comes into use only
// if it opens.
//
// Input: one instruction a byte (see `run`), its operands behind it.
#include <memory>

#include "byte_source.hpp"
#include "core/crc32.hpp"
#include "correction_watch.hpp"
#include "messages/e2e.hpp"
#include "messages/lcm_codec.hpp"
#include "node/can_link.hpp"
#include "node/default_config.hpp"
#include "small_tables.hpp"

using namespace flexcomp;
using flexcomp::fuzz::ByteSource;
using flexcomp::fuzz::CorrectionWatch;
using flexcomp::fuzz::expect;
using flexcomp::fuzz::Words;

namespace {

constexpr std::int64_t kPeriod = 4'000'000;  // ns
constexpr std::size_t kSlotWords = 1 << 12;
constexpr int kMostTicks = 1'000;  // an input

constexpr std::array<const char*, 15> kChannels = {
    "FLEXCOMP_JOINT_SETPOINT",   "FLEXCOMP_WRENCH",
    "FLEXCOMP_COMMAND",          "FLEXCOMP_IDENTITY",
    "FLEXCOMP_TABLE_BEGIN",      "FLEXCOMP_TABLE_DATA",
    "FLEXCOMP_TABLE_END",        "FLEXCOMP_CORRECTED_SETPOINT",
    "FLEXCOMP_HEARTBEAT",        "FLEXCOMP_FAULT",
    "FLEXCOMP_STATISTIC",        "FLEXCOMP_TABLE_REPLY",
    "FLEXCOMP_COMMAND_REPLY",    "FLEXCOMP_MEASURED_JOINTS",
    "FLEXCOMP_MEASURED_POSITION"};

const Words& usual_table() {
  static const Words kWords = fuzz::path_table(test::kr270<float>());
  return kWords;
}

NodeConfig usual_config() {
  NodeConfig config = default_node_config();
  config.compensator.model_hash = model_hash(test::kr270<float>());
  config.compensator.fade_time = 0.05F;
  config.compensator.ready_ticks = 3;
  return config;
}

/// Values, rates and accelerations as they go out on the bus, where angles are rounded to floats.
class BusWatch {
 public:
  void check(const CorrectedMessage& message) {
    constexpr double kRounding = 16 * 1.2e-7 * 6.3;
    const CorrectionLimits<float> limits = usual_config().compensator.limits[0];
    constexpr double kSeconds = 4e-3;
    for (std::size_t i = 0; i < message.corrected.size(); ++i) {
      const double correction = message.corrected[i] - message.uncorrected[i];
      if (std::isnan(correction)) {
        expect((message.status & kNoSetpoint) != 0, "no numbers only where there is no setpoint");
        continue;
      }
      const double step = correction - corrections_[i];
      expect(std::fabs(correction) <= static_cast<double>(limits.value) + kRounding, "the value");
      expect(std::fabs(step) <= static_cast<double>(limits.rate) * kSeconds + kRounding,
             "the rate");
      corrections_[i] = correction;
    }
  }

 private:
  JointAngles corrections_{};
};

class Run {
 public:
  explicit Run(ByteSource bytes) : bytes_(bytes), first_(kSlotWords), second_(kSlotWords) {
    node_.use_memory({first_.data(), first_.size()}, {second_.data(), second_.size()});
    expect(node_.configure(usual_config()) == Result::ok, "the usual configuration is accepted");
    std::copy(usual_table().begin(), usual_table().end(), first_.begin());
    Table table;
    Table::open(first_.data(), 4 * usual_table().size(), &table);
    expect(node_.start_with(0, table) == Result::ok, "the usual table is accepted");
  }

  void run() {
    while (!bytes_.is_empty() && ticks_ < kMostTicks) {
      const auto instruction = bytes_.take<std::uint8_t>();
      switch (instruction % 8) {
        case 0:
          machine(1 + instruction / 8);
          break;
        case 1:
          put_frame();
          break;
        case 2:
          put_event();
          break;
        case 3:
          send(CommandMessage{static_cast<Command>(instruction / 8 % 6)});
          break;
        case 4:
          send(IdentityMessage{usual_config().compensator.model_hash,
                               static_cast<WrenchFrame>(instruction / 8 % 4)});
          break;
        case 5:
          transfer_words(instruction / 8);
          break;
        case 6:
          tick(bytes_.take<std::int32_t>());
          break;
        default:
          bus_fault_ = !bus_fault_;
      }
    }
  }

 private:
  void send(const Message& message) {
    const FrameList frames = sender_.encode(message);
    for (std::size_t i = 0; i < frames.count; ++i) {
      link_.receive(frames.frames[i], &node_, now_);
    }
  }

  void tick(std::int64_t elapsed) {
    now_ += elapsed;
    if (node_.take_reset()) {
      link_.forget_conflicts();
    }
    LinkState state = link_.state();
    state.bus_fault = bus_fault_;
    node_.set_link(state);
    watch_.check(node_.tick(now_));
    Message message;
    while (node_.next_message(&message)) {
      expect(link_.encode(message).count > 0, "what a node says can be sent");
    }
    conclude_transfer();
    ++ticks_;
  }

  void machine(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      phase_ = std::fmod(phase_ + 1e-3, 0.35);
      SetpointMessage setpoint;
      const JointVector<double, 6> q = test::loop_angles<double>(phase_);
      std::copy_n(q.data(), 6, setpoint.q.begin());
      send(WrenchMessage{kNoTime, {440, 1370 + 100 * phase_, 635, 0, 3, 10.5}, false});
      send(setpoint);
      tick(kPeriod);
    }
  }

  void put_frame() {
    const auto flags = bytes_.take<std::uint8_t>();
    CanFrame frame;
    frame.fd = (flags & 1U) != 0;
    frame.id = bytes_.take<std::uint16_t>();
    frame.size = bytes_.take<std::uint8_t>();
    bytes_.take_into(frame.data.data(), std::min<std::size_t>(frame.size, frame.data.size()));
    if ((flags & 2U) != 0 && frame.size <= frame.data.size()) {
      protect(&frame);
    }
    link_.receive(frame, &node_, now_);
  }

  /// An event of LCM: real-time data is hostile, and so is the time in it.
  void put_event() {
    const auto channel = bytes_.take<std::uint8_t>();
    std::array<std::uint8_t, 160> data{};
    const std::size_t size = bytes_.take<std::uint8_t>() % data.size();
    bytes_.take_into(data.data(), size);
    node_.receive(decode_lcm(kChannels[channel % kChannels.size()], data.data(), size).message,
                  Source::lcm, now_);
  }

  /// Words of a table, some from the input; begun anew when it is complete.
  void transfer_words(int count) {
    const auto size = static_cast<std::uint32_t>(usual_table().size());
    const std::uint32_t crc = crc32(usual_table().data(), 4 * size);
    if (word_ == 0) {
      send(TransferBeginMessage{4 * size, crc});
    }
    for (int i = 0; i <= count && word_ < size; ++i, ++word_) {
      TransferDataMessage data{word_, 1, {}};
      data.words[0] = usual_table()[word_];
      send(data);
    }
    if (count == 31) {
      for (; word_ < size; ++word_) {
        TransferDataMessage data{word_, 1, {}};
        data.words[0] = usual_table()[word_];
        send(data);
      }
    }
    if (word_ == size) {
      send(TransferEndMessage{crc});
      word_ = 0;
    }
  }

  void conclude_transfer() {
    std::size_t size = 0;
    if (const void* received = node_.received_table(&size)) {
      Table table;
      const Result opened = Table::open(received, size, &table);
      const Result used = node_.conclude_transfer(opened, table);
      expect(opened == Result::ok || used == opened, "a table that does not open is not used");
    }
  }

  ByteSource bytes_;
  Words first_;
  Words second_;
  Node node_;
  CanLink link_{false, 3};
  CanEncoder sender_;
  BusWatch watch_;
  std::int64_t now_ = 1'000'000'000;
  double phase_ = 0;
  std::uint32_t word_ = 0;
  int ticks_ = 0;
  bool bus_fault_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::make_unique<Run>(ByteSource(data, size))->run();
  return 0;
}
