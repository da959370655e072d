/// Prints how many instructions the parts of a tick take, over ordinary and hostile inputs: a line
/// for each part, `name median worst`.
#include <algorithm>
#include <cstdio>
#include <random>

#include "node/node_on_a_bus.hpp"
#include "target/instruction_counter.hpp"

using namespace flexcomp;
using flexcomp::test::InstructionCounter;
using flexcomp::test::kTurn;
using flexcomp::test::NodeOnABus;

namespace {

void print(const char* name, std::vector<std::uint32_t> counts) {
  std::sort(counts.begin(), counts.end());
  std::printf("%s %lu %lu\n", name, static_cast<unsigned long>(counts[counts.size() / 2]),
              static_cast<unsigned long>(counts.back()));
}

Wrench<float> some_wrench() {
  Wrench<float> w;
  w << 440, 1370, 635, 0, 3, 10.5F;
  return w;
}

void core_parts(const InstructionCounter& counter) {
  Table table;
  const auto& words = test::usual_table();
  Table::open(words.data(), 4 * words.size(), &table);
  TableCursor cursor;
  std::vector<std::uint32_t> look, response, both;
  for (int i = 0; i < 3000; ++i) {
    const auto q = test::loop_angles<float>(kTurn * i / 3000);
    TableEntry<float, 6> entry;
    TableCursor copy = cursor;
    look.push_back(counter.count([&] { entry = look_up<float, 6>(table, q, &cursor); }));
    TableResponse<float, 6> out;
    const auto w = some_wrench();
    response.push_back(counter.count([&] { out = respond<float, 6>(table, entry, w); }));
    both.push_back(counter.count(
        [&] { out = respond<float, 6>(table, look_up<float, 6>(table, q, &copy), w); }));
  }
  print("lookup", look);
  print("respond", response);
  print("lookup+respond", both);
  Guard<float> guard;
  guard.configure({0.01F, 0.1F, 5.0F}, 0.004F);
  std::vector<std::uint32_t> guards;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(-0.02F, 0.02F);
  for (int i = 0; i < 3000; ++i) {
    const float target = u(random);
    guards.push_back(counter.count([&] { guard.advance(target); }));
  }
  print("guard", guards);
}

void compensator_tick(const InstructionCounter& counter) {
  Compensator<float, 6> core;
  core.configure(test::usual_config().compensator);
  Table table;
  const auto& words = test::usual_table();
  Table::open(words.data(), 4 * words.size(), &table);
  core.set_table(table);
  std::vector<std::uint32_t> ticks;
  for (int i = 0; i < 3000; ++i) {
    CompensatorInput<float, 6> in{test::loop_angles<float>(kTurn * i / 3000), 0.001F, some_wrench(),
                                  0.001F};
    CompensatorOutput<float, 6> out;
    const auto n = counter.count([&] { out = core.tick(in); });
    if (i == 20) core.arm();
    if (i > 200) ticks.push_back(n);
  }
  print("core tick", ticks);
}

void node_tick(const InstructionCounter& counter) {
  NodeOnABus bus;
  bus.bring_up();
  CanEncoder encoder;
  std::vector<std::uint32_t> decode, tick, encode, all;
  for (int i = 0; i < 3000; ++i) {
    const FrameList wrench = bus.encode(bus.next_wrench());
    const FrameList setpoint = bus.encode(bus.next_setpoint());
    bus.now += 4'000'000;
    const auto d = counter.count([&] {
      bus.put(wrench);
      bus.put(setpoint);
    });
    CorrectedMessage corrected;
    const auto t = counter.count([&] {
      bus.node.set_link(bus.link.state());
      corrected = bus.node.tick(bus.now);
    });
    FrameList out;
    const auto e = counter.count([&] { out = encoder.encode(corrected); });
    Message m;
    while (bus.node.next_message(&m)) {
    }
    decode.push_back(d);
    tick.push_back(t);
    encode.push_back(e);
    all.push_back(d + t + e);
  }
  print("decode", decode);
  print("node tick", tick);
  print("encode", encode);
  print("all", all);
}

}  // namespace

int main() {
  const InstructionCounter counter;
  std::vector<std::uint32_t> nothing;
  for (int i = 0; i < 100; ++i) {
    nothing.push_back(counter.count([] {}));
  }
  print("nothing", nothing);
  core_parts(counter);
  compensator_tick(counter);
  node_tick(counter);
  return 0;
}
