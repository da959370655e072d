// A million lock-step ticks, frames and all, with faults of every kind in random order, commands
// and table transfers between them: nothing breaks a limit (NodeOnABus holds every tick to them),
// nothing is leaked or written past (the sanitizers watch in the debug build).
//
// Usage: test_hil_lockstep_soak [TICKS [SEED]]; more than the usual million say how far they are.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "core/crc32.hpp"
#include "node/node_on_a_bus.hpp"

using namespace flexcomp;
using flexcomp::test::NodeOnABus;
using flexcomp::test::usual_table;

namespace {

std::int64_t ticks_to_do = 1'000'000;
unsigned seed_of_havoc = 20261121;

/// Does to frames what a bad wire and bad senders do, changing its mind now and then.
class Havoc {
 public:
  explicit Havoc(unsigned seed) : random_(seed) {}

  CorrectedMessage tick(NodeOnABus* bus) {
    if (left_-- <= 0) {
      kind_ = draw() % 16;
      left_ = static_cast<int>(draw() % 120);
    }
    bus->bus_fault = kind_ == 1;
    SetpointMessage setpoint = bus->next_setpoint();
    WrenchMessage wrench = bus->next_wrench();
    spoil(&setpoint, &wrench);
    put(bus, wrench);
    put(bus, setpoint);
    command(bus);
    transfer(bus);
    return bus->tick(kind_ == 2 ? static_cast<std::int64_t>(draw() % 20'000'000) - 2'000'000
                                : 4'000'000);
  }

 private:
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }
  double uniform() { return static_cast<double>(draw()) / 4294967295.0; }

  void spoil(SetpointMessage* setpoint, WrenchMessage* wrench) {
    if (kind_ == 3) {
      setpoint->q[draw() % 6] += 10 * (uniform() - 0.5);
    } else if (kind_ == 4) {
      wrench->wrench[draw() % 6] += 1e4 * (uniform() - 0.5);
    } else if (kind_ == 5) {
      setpoint->q[draw() % 6] = std::numeric_limits<double>::quiet_NaN();
    } else if (kind_ == 6) {
      wrench->saturated = true;
    } else if (kind_ == 7) {
      for (double& component : wrench->wrench) {
        component *= 1 + uniform();
      }
    } else if (kind_ == 8) {
      setpoint->q[1] += 0.05 * uniform();
    }
  }

  void put(NodeOnABus* bus, const Message& message) {
    FrameList frames = (draw() % 50 == 0 ? fd_ : classic_).encode(message);
    for (std::size_t i = 0; i < frames.count; ++i) {
      CanFrame& frame = frames.frames[i];
      if (kind_ == 9 && draw() % 3 == 0) {
        continue;
      }
      if (kind_ == 10 && draw() % 2 == 0) {
        frame.data[draw() % 8] ^= static_cast<std::uint8_t>(1U << draw() % 8);
      }
      if (kind_ == 11) {
        frame.id = draw() % 0x800;
        frame.size = static_cast<std::uint8_t>(draw() % 65);
        frame.fd = draw() % 2 == 0;
      }
      bus->put(frame);
      if (kind_ == 12) {
        bus->put(frame);
      }
      late_[draw() % late_.size()] = frame;
      if (kind_ == 13) {
        bus->put(late_[draw() % late_.size()]);
      }
    }
  }

  void command(NodeOnABus* bus) {
    const std::uint32_t choice = draw() % 200;
    if (choice < 8) {
      bus->send(CommandMessage{static_cast<Command>(choice % 5)});
    } else if (choice < 12) {
      bus->announce();
    } else if (choice == 12) {
      bus->send(IdentityMessage{draw(), static_cast<WrenchFrame>(draw() % 4)});
    }
  }

  /// Sends a table a word a tick, at times damaged, and checks what has arrived.
  void transfer(NodeOnABus* bus) {
    const auto size = static_cast<std::uint32_t>(usual_table().size());
    if (word_ == 0) {
      bus->send(TransferBeginMessage{4 * size, crc32(usual_table().data(), 4 * size)});
    } else if (word_ <= size) {
      TransferDataMessage data{word_ - 1, 1, {}};
      data.words[0] = usual_table()[word_ - 1] ^ (draw() % 20'000 == 0 ? 1U : 0U);
      bus->send(data);
    } else {
      bus->send(TransferEndMessage{crc32(usual_table().data(), 4 * size)});
    }
    word_ = word_ > size ? 0 : word_ + 1;
    std::size_t received = 0;
    if (const void* data = bus->node.received_table(&received)) {
      Table table;
      const Result opened = Table::open(data, received, &table);
      swaps += bus->node.conclude_transfer(opened, table) == Result::ok ? 1 : 0;
    }
  }

  std::mt19937 random_;
  std::uint32_t kind_ = 0;
  int left_ = 0;
  std::uint32_t word_ = 0;
  CanEncoder classic_;
  CanEncoder fd_{true};
  std::array<CanFrame, 64> late_{};

 public:
  int swaps = 0;
};

/// A line at every hundredth of a long run, for tools/soak.
void say_how_far(std::int64_t done) {
  const std::int64_t part = ticks_to_do / 100;
  if (ticks_to_do > 1'000'000 && done % part == 0) {
    std::printf("%lld of %lld ticks\n", static_cast<long long>(done),
                static_cast<long long>(ticks_to_do));
    std::fflush(stdout);
  }
}

void a_million_ticks_of_havoc_break_no_limit() {
  auto bus = std::make_unique<NodeOnABus>();
  Havoc havoc(seed_of_havoc);
  std::array<std::int64_t, 6> visited{};
  for (std::int64_t i = 1; i <= ticks_to_do; ++i) {
    say_how_far(i);
    havoc.tick(bus.get());
    bus->faults.clear();
    bus->statistics.clear();
    ++visited[static_cast<std::size_t>(bus->node.state())];
  }
  for (const std::int64_t ticks : visited) {
    TEST_ASSERT_TRUE_MESSAGE(ticks > ticks_to_do / 1000, "the havoc did not reach every state");
  }
  TEST_ASSERT_GREATER_THAN(10, havoc.swaps);
  TEST_ASSERT_TRUE(bus->limits.largest_correction() <= 0.0101);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    ticks_to_do = std::max(1'000'000LL, std::atoll(argv[1]));
  }
  if (argc > 2) {
    seed_of_havoc = static_cast<unsigned>(std::atoi(argv[2]));
  }
  UNITY_BEGIN();
  RUN_TEST(a_million_ticks_of_havoc_break_no_limit);
  return UNITY_END();
}
