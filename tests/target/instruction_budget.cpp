/// Counts the instructions of a tick and of its parts on the target; prints a line for each:
/// `name ordinary worst`, the median over ordinary machining and the most over hostile inputs.
#include <algorithm>
#include <cstdio>
#include <new>
#include <random>
#include <string>

#include "core/arc_arms.hpp"
#include "core/long_program.hpp"
#include "flexcomp/path_index.hpp"
#include "node/node_on_a_bus.hpp"
#include "node/slcan_node.hpp"
#include "target/instruction_counter.hpp"

using namespace flexcomp;
using flexcomp::test::InstructionCounter;
using flexcomp::test::kTurn;
using flexcomp::test::NodeOnABus;

namespace {

constexpr int kTicks = 1000;
constexpr int kHostileTicks = 3000;

class Counts {
 public:
  void add_ordinary(std::uint32_t count) {
    ordinary_.push_back(count);
    add_hostile(count);
  }
  void add_hostile(std::uint32_t count) { worst_ = std::max(worst_, count); }

  void print(const char* name) {
    std::nth_element(ordinary_.begin(), ordinary_.begin() + kTicks / 2, ordinary_.end());
    std::printf("%s %lu %lu\n", name, static_cast<unsigned long>(ordinary_[kTicks / 2]),
                static_cast<unsigned long>(worst_));
  }

 private:
  std::vector<std::uint32_t> ordinary_;
  std::uint32_t worst_ = 0;
};

/// On the straight pieces that a table of `loop_angles` is made for.
JointVector<float, 6> on_program(double share) {
  constexpr int kPieces = 120;
  const double place = kPieces * share;
  const double piece = std::floor(place);
  const auto a = test::loop_angles<float>(kTurn * piece / kPieces);
  const auto b = test::loop_angles<float>(kTurn * (piece + 1) / kPieces);
  return a + static_cast<float>(place - piece) * (b - a);
}

Wrench<float> ordinary_wrench() {
  Wrench<float> wrench;
  wrench << 440, 1370, 635, 0, 3, 10.5F;
  return wrench;
}

std::vector<std::uint32_t> grid_table() {
  std::vector<std::uint32_t> words(1 << 18);
  std::size_t size = 0;
  const GridRange<float> ranges[4] = {{-1.3F, -1.1F}, {1.2F, 1.4F}, {0.15F, 0.45F}, {0.7F, 0.9F}};
  TEST_ASSERT_EQUAL(Result::ok, (build_grid_table<float, 6>(
                                    test::kr270<float>(), ranges, {2000, 50, 1e-3F, 1e-3F, 0},
                                    words.data(), 4 * words.size(), &size)));
  words.resize(size / 4);
  return words;
}

void count_table(const InstructionCounter& counter, const char* name,
                 const std::vector<std::uint32_t>& words) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  const Wrench<float> wrench = ordinary_wrench();
  std::mt19937 random(1);
  std::uniform_real_distribution<float> off(-0.05F, 0.05F);
  TableCursor cursor;
  Counts counts;
  const auto count = [&](const JointVector<float, 6>& q) {
    float outside = 0;
    TableResponse<float, 6> response;
    return counter.count(
        [&] { response = look_up_response<float, 6>(table, q, wrench, &cursor, &outside); });
  };
  for (int i = 0; i < kTicks; ++i) {
    counts.add_ordinary(count(on_program(static_cast<double>(i) / kTicks)));
  }
  for (int i = 0; i < kHostileTicks; ++i) {
    JointVector<float, 6> q = on_program(static_cast<double>(random() % kTicks) / kTicks);
    if (i % 2 == 0) {
      q[static_cast<Eigen::Index>(random() % 6)] += off(random);
    }
    counts.add_hostile(count(q));
  }
  counts.print(name);
}

/// A program of 20,000 nodes: a look-up on it, one that has lost it by a jump, and arming after
/// that.
void count_long_program(const InstructionCounter& counter) {
  constexpr int kJumps = 1000;
  const test::Raster raster = {1000, 20};
  const std::vector<std::uint32_t> words = test::raster_table(raster);
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::reopen(words.data(), 4 * words.size(), &table));
  std::vector<std::uint32_t> index(path_index_size(table) / 4);
  TEST_ASSERT_EQUAL(Result::ok, index_path(index.data(), 4 * index.size(), &table));
  const Wrench<float> wrench = ordinary_wrench();
  std::mt19937 random(5);
  const auto anywhere = [&] {
    const auto node = static_cast<int>(random() % static_cast<unsigned>(raster.nodes() - 1));
    return raster.between(node, static_cast<float>(random() % 100) / 100.0F);
  };
  TableCursor cursor;
  float outside = 0;
  TableResponse<float, 6> response;
  const auto look_up = [&](const JointVector<float, 6>& q) {
    return counter.count(
        [&] { response = look_up_response<float, 6>(table, q, wrench, &cursor, &outside); });
  };
  Counts jumps;
  Counts arming;
  for (int i = 0; i < kJumps; ++i) {
    const JointVector<float, 6> q = anywhere();
    TableCursor armed = cursor;
    arming.add_ordinary(counter.count([&] { locate<float, 6>(table, q, &armed); }));
    jumps.add_ordinary(look_up(q));
    for (int more = 0; more < 10 && outside > 0; ++more) {
      jumps.add_hostile(look_up(q));
    }
    JointVector<float, 6> off = q;
    off[static_cast<Eigen::Index>(random() % 6)] += 0.01F;
    arming.add_hostile(counter.count([&] { locate<float, 6>(table, off, &armed); }));
  }
  jumps.print("long_program_jump");
  arming.print("long_program_arming");
}

void count_direct_evaluation(const InstructionCounter& counter) {
  const RobotModel<float, 6> model = test::kr270<float>();
  const Wrench<float> wrench = ordinary_wrench();
  Counts counts;
  for (int i = 0; i < kTicks; ++i) {
    const JointVector<float, 6> q = on_program(static_cast<double>(i) / kTicks);
    Deflection<float, 6> result;
    counts.add_ordinary(counter.count([&] { result = deflection<float, 6>(model, q, wrench); }));
  }
  counts.print("direct_deflection");
}

void count_limits(const InstructionCounter& counter) {
  std::array<Guard<float>, 6> guards;
  for (Guard<float>& guard : guards) {
    guard.configure({0.01F, 0.1F, 5.0F}, 0.004F);
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-0.02F, 0.02F);
  Counts counts;
  const auto count = [&](float target) {
    return counter.count([&] {
      for (Guard<float>& guard : guards) {
        guard.advance(target);
      }
    });
  };
  for (int i = 0; i < kTicks; ++i) {
    counts.add_ordinary(count(0.001F * std::sin(0.01F * static_cast<float>(i))));
  }
  for (int i = 0; i < kHostileTicks; ++i) {
    counts.add_hostile(count(anywhere(random)));
  }
  counts.print("limits_six_joints");
}

void count_compensator(const InstructionCounter& counter, const char* name,
                       const std::vector<std::uint32_t>& words) {
  Compensator<float, 6> core;
  core.configure(test::usual_config().compensator);
  Table table;
  Table::open(words.data(), 4 * words.size(), &table);
  core.set_table(table);
  CompensatorInput<float, 6> input{on_program(0), 0.001F, ordinary_wrench(), 0.001F};
  for (int i = 0; i < 100; ++i) {
    core.tick(input);
    core.arm();
  }
  TEST_ASSERT_EQUAL(State::active, core.state());
  Counts counts;
  const auto count = [&] {
    CompensatorOutput<float, 6> output;
    return counter.count([&] { output = core.tick(input); });
  };
  for (int i = 0; i < kTicks; ++i) {
    input.setpoint = on_program(static_cast<double>(i) / kTicks);
    counts.add_ordinary(count());
  }
  std::mt19937 random(2);
  std::uniform_real_distribution<float> share(-1, 1);
  for (int i = 0; i < kHostileTicks; ++i) {
    input.setpoint = on_program(static_cast<double>(i % kTicks) / kTicks);
    input.wrench = ordinary_wrench() * share(random);
    const auto joint = static_cast<Eigen::Index>(random() % 6);
    switch (random() % 12) {
      case 0:
        input.setpoint[joint] = std::numeric_limits<float>::quiet_NaN();
        break;
      case 1:
        input.setpoint[joint] += 0.02F * share(random);
        break;
      case 2:
        input.wrench[joint] = 1e30F * share(random);
        break;
      case 3:
        input.setpoint_age = 10 * std::abs(share(random));
        break;
      default:
        input.setpoint_age = 0.001F;
        break;
    }
    core.reset();
    core.arm();
    counts.add_hostile(count());
  }
  counts.print(name);
}

/// The controller of flexible joints, six of them, that tracks what the compensator asks for.
void count_adaptive_robust_control(const InstructionCounter& counter) {
  const test::Arm<float, 6> arm = test::skew_arm<float>();
  AdaptiveRobustController<float, 6> controller;
  TEST_ASSERT_EQUAL(Result::ok,
                    controller.configure(arm.model, arm.inertia, test::plain_gains<6>()));
  ArcInput<float, 6> input;
  Counts counts;
  const auto count = [&] {
    ArcOutput<float, 6> output;
    return counter.count([&] { output = controller.tick(input); });
  };
  std::mt19937 random(4);
  std::uniform_real_distribution<float> share(-1, 1);
  for (int i = 0; i < kTicks + kHostileTicks; ++i) {
    const bool hostile = i >= kTicks;
    const float size = hostile && random() % 4 == 0 ? 100.0F : 0.01F;
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      input.link[joint] = size * share(random);
      input.link_velocity[joint] = size * share(random);
      input.motor[joint] = input.link[joint] + 0.01F * size * share(random);
      input.motor_velocity[joint] = size * share(random);
    }
    if (hostile && random() % 8 == 0) {
      input.link[2] = std::numeric_limits<float>::quiet_NaN();
    }
    if (hostile) {
      counts.add_hostile(count());
    } else {
      counts.add_ordinary(count());
    }
  }
  counts.print("adaptive_robust_control");
}

/// The node with its frames: decode, tick, encode, and the whole.
class WholeTick {
 public:
  WholeTick(const InstructionCounter& counter, bool fd) : counter_(counter), encoder_(fd) {
    bus_.use_fd(fd);
    bus_.bring_up();
  }

  void count_ordinary() {
    for (int i = 0; i < kTicks; ++i) {
      const Parts parts = tick();
      decode_.add_ordinary(parts.decode);
      tick_.add_ordinary(parts.tick);
      encode_.add_ordinary(parts.encode);
      whole_.add_ordinary(parts.decode + parts.tick + parts.encode);
    }
  }

  void count_hostile() {
    for (int i = 0; i < kHostileTicks; ++i) {
      attack_ = static_cast<int>(random_() % 16);
      const Parts parts = tick();
      decode_.add_hostile(parts.decode);
      tick_.add_hostile(parts.tick);
      encode_.add_hostile(parts.encode);
      whole_.add_hostile(parts.decode + parts.tick + parts.encode);
    }
  }

  void print(const std::string& kind) {
    decode_.print((kind + "decode").c_str());
    tick_.print((kind + "node_tick").c_str());
    encode_.print((kind + "encode").c_str());
    whole_.print((kind + "whole_tick").c_str());
  }

 private:
  struct Parts {
    std::uint32_t decode;
    std::uint32_t tick;
    std::uint32_t encode;
  };

  Parts tick() {
    FrameList wrench = bus_.encode(spoilt(bus_.next_wrench()));
    FrameList setpoint = bus_.encode(spoilt(bus_.next_setpoint()));
    spoil(&setpoint);
    spoil(&wrench);
    bus_.now += 4'000'000;
    Parts parts{};
    parts.decode = counter_.count([&] {
      bus_.put(wrench);
      bus_.put(setpoint);
    });
    // As the firmware has it: no copy.
    alignas(CorrectedMessage) std::array<unsigned char, sizeof(CorrectedMessage)> room;
    const CorrectedMessage* corrected = nullptr;
    parts.tick = counter_.count([&] {
      bus_.link.report(bus_.node.link_state());
      corrected = new (room.data()) CorrectedMessage(bus_.node.tick(bus_.now));
    });
    parts.encode = counter_.count([&] {
      encoder_.encode(*corrected);
      for (int i = 0; i < 2; ++i) {
        if (const Message* const message = bus_.node.next_message()) {
          encoder_.encode(*message);
        }
      }
    });
    return parts;
  }

  SetpointMessage spoilt(SetpointMessage message) {
    double* q = &message.q[random_() % 6];
    *q = attack_ == 1 ? std::numeric_limits<double>::quiet_NaN() : *q + (attack_ == 2 ? 0.03 : 0);
    return message;
  }

  WrenchMessage spoilt(WrenchMessage message) {
    message.saturated = attack_ == 3;
    message.wrench[random_() % 6] *= attack_ == 4 ? 3 : 1;
    return message;
  }

  void spoil(FrameList* list) {
    CanFrame& frame = list->frames[random_() % list->count];
    if (attack_ == 5) {
      frame.data[3] ^= 0x10U;
    } else if (attack_ == 6) {
      list->count = 1;
    } else if (attack_ == 7) {
      frame = bus_.encode(CommandMessage{Command::reset}).frames[0];
    } else if (attack_ == 8) {
      frame = bus_.encode(CommandMessage{Command::arm}).frames[0];
    }
  }

  const InstructionCounter& counter_;
  NodeOnABus bus_;
  CanEncoder encoder_;
  std::mt19937 random_{3};
  int attack_ = 0;
  Counts decode_;
  Counts tick_;
  Counts encode_;
  Counts whole_;
};

/// A whole step of the firmware: the text of five frames in, a tick, the text of seven out.
void count_serial_step(const InstructionCounter& counter) {
  static SlcanNode::Bytes received;
  static SlcanNode::Bytes to_send;
  NodeSettings settings;
  settings.node = test::usual_config();
  static SlcanNode node(settings, &received, &to_send, {}, {});
  Table table;
  Table::open(test::usual_table().data(), 4 * test::usual_table().size(), &table);
  node.node()->start_with(TableStore::kFixed, table);
  NodeOnABus sender;
  Counts counts;
  std::int64_t now = 0;
  const auto type = [&](const Message& message) {
    const FrameList frames = sender.encode(message);
    for (std::size_t i = 0; i < frames.count; ++i) {
      const SlcanLine line = to_slcan(frames.frames[i]);
      for (std::size_t k = 0; k < line.size; ++k) {
        received.push(static_cast<std::uint8_t>(line.text[k]));
      }
    }
  };
  type(IdentityMessage{settings.node.compensator.model_hash, WrenchFrame::base});
  for (int i = 0; i < kTicks + 100; ++i) {
    type(sender.next_wrench());
    type(sender.next_setpoint());
    if (i == 50) {
      type(CommandMessage{Command::arm});
    }
    now += 4'000'000;
    const std::uint32_t count = counter.count([&] { node.step(now); });
    std::uint8_t byte = 0;
    while (to_send.pop(&byte)) {
    }
    if (i >= 100) {
      counts.add_ordinary(count);
    }
  }
  TEST_ASSERT_EQUAL(State::active, node.node()->state());
  counts.print("serial_step");
}

}  // namespace

int main() {
  const InstructionCounter counter;
  const std::vector<std::uint32_t> grid = grid_table();
  count_table(counter, "path_lookup_and_deflection", test::usual_table());
  count_table(counter, "grid_lookup_and_deflection", grid);
  count_long_program(counter);
  count_direct_evaluation(counter);
  count_limits(counter);
  count_compensator(counter, "compensator_path_table", test::usual_table());
  count_compensator(counter, "compensator_grid_table", grid);
  for (const bool fd : {false, true}) {
    WholeTick whole(counter, fd);
    whole.count_ordinary();
    whole.count_hostile();
    whole.print(fd ? "fd_" : "");
  }
  count_serial_step(counter);
  count_adaptive_robust_control(counter);
  return 0;
}
