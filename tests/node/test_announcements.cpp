// Heartbeats and faults, which a node says by itself, come through whatever it is asked beside
// that.
#include <functional>

#include "node/node_on_a_bus.hpp"

using namespace flexcomp;
using flexcomp::test::NodeOnABus;
using flexcomp::test::usual_config;

namespace {

constexpr int kAtOnce = 12;        // questions a tick
constexpr int kMessagesATick = 2;  // as the microcontroller takes them; flexcompd takes more
constexpr int kSecond = 250;       // ticks

using Question = std::function<Message(int)>;

Message commands(int i) {
  constexpr std::array<Command, 3> kCommands = {Command::report, Command::arm, Command::none};
  return CommandMessage{kCommands[static_cast<std::size_t>(i) % kCommands.size()]};
}

Message words_of_no_transfer(int /*i*/) { return TransferDataMessage{77, 1, {}}; }

Message transfers_that_begin(int i) {
  return i % 2 == 0 ? Message(TransferBeginMessage{0, 0}) : Message(TransferEndMessage{1});
}

const std::array<Question, 3> kQuestions = {commands, words_of_no_transfer, transfers_that_begin};

/// A node that is asked too much, and whose messages are taken a few a tick.
class AskedTooMuch {
 public:
  explicit AskedTooMuch(Question question) : question_(std::move(question)) { bus_.bring_up(); }

  /// Messages that it sends in so many ticks, with the tick; `wrenches`: does the sensor go on?
  std::vector<std::pair<int, Message>> run(int ticks, bool wrenches) {
    std::vector<std::pair<int, Message>> said;
    for (int tick = 0; tick < ticks; ++tick) {
      for (int i = 0; i < kAtOnce; ++i) {
        bus_.node.receive(question_(i), Source::can_classic, bus_.now);
      }
      if (wrenches) {
        bus_.send(bus_.next_wrench());
      }
      bus_.send(bus_.next_setpoint());
      bus_.now += 4'000'000;
      bus_.node.set_link(bus_.link.state());
      bus_.limits.check(bus_.node.tick(bus_.now));
      Message message;
      for (int i = 0; i < kMessagesATick && bus_.node.next_message(&message); ++i) {
        said.emplace_back(tick, message);
      }
    }
    return said;
  }

 private:
  NodeOnABus bus_;
  Question question_;
};

void heartbeats_go_on_however_much_it_is_asked() {
  constexpr int kLatest = 25 + 10;  // ticks: a heartbeat's period, and what stands before it
  for (const Question& question : kQuestions) {
    int beats = 0;
    int last = 0;
    for (const auto& [tick, message] : AskedTooMuch(question).run(4 * kSecond, true)) {
      if (std::holds_alternative<HeartbeatMessage>(message)) {
        TEST_ASSERT_LESS_OR_EQUAL(kLatest, tick - last);
        last = tick;
        ++beats;
      }
    }
    TEST_ASSERT_INT_WITHIN(2, 4 * kSecond / 26, beats);
  }
}

void a_fault_is_told_however_much_it_is_asked() {
  for (const Question& question : kQuestions) {
    AskedTooMuch node(question);
    node.run(kSecond, true);
    int told = 0;
    for (const auto& [tick, message] : node.run(kSecond, false)) {
      const auto* fault = std::get_if<FaultMessage>(&message);
      const bool is_stale = fault != nullptr && fault->code == kCompensatorFaultCode + 5;
      if (is_stale && fault->active) {
        TEST_ASSERT_LESS_OR_EQUAL(20, tick);
        ++told;
      }
    }
    TEST_ASSERT_EQUAL(1, told);
  }
}

void it_still_answers_most_of_what_it_has_room_for() {
  int answers = 0;
  for (const auto& [tick, message] : AskedTooMuch(commands).run(kSecond, true)) {
    answers += std::holds_alternative<CommandReplyMessage>(message) ? 1 : 0;
  }
  TEST_ASSERT_GREATER_THAN(kSecond, answers);
}

/// How often a fault message of this code told that it began, and that it ended.
std::pair<int, int> told(const NodeOnABus& bus, std::uint16_t code) {
  std::pair<int, int> times;
  for (const FaultMessage& fault : bus.faults) {
    if (fault.code == code) {
      ++(fault.active ? times.first : times.second);
    }
  }
  return times;
}

void messages_refused_under_a_key_are_told_when_they_begin_and_end() {
  const std::array<std::uint32_t AuthenticationCounters::*, 3> counters = {
      &AuthenticationCounters::forged, &AuthenticationCounters::not_fresh,
      &AuthenticationCounters::unauthenticated};
  for (std::uint16_t i = 0; i < counters.size(); ++i) {
    const auto code = static_cast<std::uint16_t>(kForgedCode + i);
    NodeOnABus bus;
    bus.authentication.has_key = true;
    bus.bring_up();
    ++(bus.authentication.*counters[i]);
    bus.machine();
    TEST_ASSERT_TRUE(told(bus, code) == std::pair(1, 0));
    // However they come, at most one message between two heartbeats.
    for (int tick = 0; tick < 3 * kSecond; ++tick) {
      bus.authentication.*counters[i] += tick % 7 == 0 ? 1U : 0U;
      bus.machine();
    }
    TEST_ASSERT_TRUE(told(bus, code) == std::pair(1, 0));
    bus.machine(2 * kSecond);
    TEST_ASSERT_TRUE(told(bus, code) == std::pair(1, 1));
    bus.machine(2 * kSecond);
    TEST_ASSERT_TRUE(told(bus, code) == std::pair(1, 1));
    ++(bus.authentication.*counters[i]);
    bus.machine();
    TEST_ASSERT_TRUE(told(bus, code) == std::pair(2, 1));
    TEST_ASSERT_EQUAL(State::active, bus.node.state());  // refused, so no fault of the correction
    for (std::uint16_t other = 0; other < counters.size(); ++other) {
      const auto other_code = static_cast<std::uint16_t>(kForgedCode + other);
      TEST_ASSERT_TRUE(other == i || told(bus, other_code) == std::pair(0, 0));
    }
  }
}

void without_a_key_nothing_is_told_of_authentication() {
  NodeOnABus bus;
  bus.bring_up();
  bus.authentication = {false, 5, 5, 5};
  bus.machine(kSecond);
  TEST_ASSERT_EQUAL(0, bus.faults.size());
}

void the_period_cannot_change_once_it_ticks() {
  NodeConfig other = usual_config();
  other.compensator.period *= 2;
  Node node;
  TEST_ASSERT_EQUAL(Result::ok, node.configure(usual_config()));
  TEST_ASSERT_EQUAL(Result::ok, node.configure(other));
  TEST_ASSERT_EQUAL(Result::ok, node.configure(usual_config()));
  NodeOnABus bus;
  bus.machine(3);
  TEST_ASSERT_EQUAL(Result::bad_config, bus.node.configure(other));
  // And not a part of it: the whole of what was asked for is refused.
  other.require_identity = false;
  TEST_ASSERT_EQUAL(Result::bad_config, bus.node.configure(other));
  bus.machine(20);
  TEST_ASSERT_EQUAL(static_cast<int>(Reply::robot_unknown), bus.command(Command::arm));
}

void a_new_heartbeat_period_holds_at_once() {
  NodeConfig slow = usual_config();
  slow.heartbeat_period = 1000;
  NodeOnABus bus(slow);
  bus.machine(10);
  TEST_ASSERT_EQUAL(Result::ok, bus.node.configure(usual_config()));
  bus.heartbeat.uptime = 99;
  bus.machine(kSecond / 10 + 1);
  TEST_ASSERT_EQUAL(0, bus.heartbeat.uptime);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(heartbeats_go_on_however_much_it_is_asked);
  RUN_TEST(a_fault_is_told_however_much_it_is_asked);
  RUN_TEST(it_still_answers_most_of_what_it_has_room_for);
  RUN_TEST(messages_refused_under_a_key_are_told_when_they_begin_and_end);
  RUN_TEST(without_a_key_nothing_is_told_of_authentication);
  RUN_TEST(the_period_cannot_change_once_it_ticks);
  RUN_TEST(a_new_heartbeat_period_holds_at_once);
  return UNITY_END();
}
