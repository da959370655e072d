#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "core/crc32.hpp"
#include "messages/table_signature.hpp"
#include "node/node_on_a_bus.hpp"
#include "node/slcan_node.hpp"

using namespace flexcomp;
using flexcomp::test::kTurn;
using flexcomp::test::usual_config;
using flexcomp::test::usual_table;

namespace {

constexpr std::int64_t kStep = 1'000'000;  // ns

NodeSettings settings(Trigger trigger) {
  NodeSettings settings;
  settings.node = usual_config();
  settings.trigger = trigger;
  settings.node.use_timestamps = trigger != Trigger::lockstep;
  return settings;
}

/// A node on a serial line, the other end of the line, and a clock of milliseconds.
class SerialBench {
 public:
  explicit SerialBench(const NodeSettings& settings)
      : slots(1 << 14),
        indices(1 << 11),
        node(settings, &received, &to_send, {slots.data(), slots.size() / 2, half_of_indices(0)},
             {slots.data() + slots.size() / 2, slots.size() / 2, half_of_indices(1)}) {
    Table table;
    TEST_ASSERT_EQUAL(Result::ok,
                      Table::open(usual_table().data(), 4 * usual_table().size(), &table));
    node.node()->start_with(TableStore::kFixed, table);
  }

  void type(const std::string& text) {
    for (const char c : text) {
      TEST_ASSERT_TRUE(received.push(static_cast<std::uint8_t>(c)));
    }
  }

  void send(const Message& message) {
    const FrameList list = encoder.encode(message);
    for (std::size_t i = 0; i < list.count; ++i) {
      const SlcanLine line = to_slcan(list.frames[i]);
      type(std::string(line.text.data(), line.size));
    }
  }

  void send_setpoint() {
    phase += kTurn / 3000;
    const JointVector<double, 6> q = test::loop_angles<double>(phase);
    SetpointMessage setpoint;
    std::copy_n(q.data(), 6, setpoint.q.begin());
    const double noise = 3 * std::sin(1000 * phase);
    send(WrenchMessage{kNoTime, {440 + noise, 1370 - noise, 635, 0, 3, 10.5}, false});
    send(setpoint);
  }

  void step(int steps = 1) {
    for (int i = 0; i < steps; ++i) {
      now += kStep;
      node.step(now);
      take_answers();
    }
  }

  /// Setpoints every 4 ms.
  void machine(int periods) {
    for (int i = 0; i < periods; ++i) {
      send_setpoint();
      step(4);
    }
  }

  void bring_up() {
    send(IdentityMessage{usual_config().compensator.model_hash, WrenchFrame::base});
    machine(20);
    send(CommandMessage{Command::arm});
    machine(60);
    TEST_ASSERT_EQUAL(State::active, node.node()->state());
  }

  Node* inner() { return node.node(); }
  IndexMemory half_of_indices(std::size_t half) {
    return {indices.data() + half * indices.size() / 2, indices.size() / 2};
  }

  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> indices;
  SlcanNode::Bytes received;
  SlcanNode::Bytes to_send;
  SlcanNode node;
  CanEncoder encoder;
  std::int64_t now = 0;
  double phase = 0;
  bool listening = true;
  int corrected = 0;  ///< how many came
  CorrectedMessage last;
  TransferReplyMessage transfer_reply;
  HeartbeatMessage heartbeat;
  std::vector<FaultMessage> faults;
  std::string other;  ///< text that is no frame

 private:
  void take_answers() {
    std::uint8_t byte = 0;
    while (listening && to_send.pop(&byte)) {
      const SlcanReader::Event event = reader.take(byte);
      if (event == SlcanReader::Event::frame) {
        take(decoder.decode(reader.frame(), now));
      } else if (byte == '\a') {
        other += static_cast<char>(byte);
      }
    }
  }

  void take(const Message& message) {
    if (const auto* answer = std::get_if<CorrectedMessage>(&message)) {
      ++corrected;
      last = *answer;
    } else if (const auto* reply = std::get_if<TransferReplyMessage>(&message)) {
      transfer_reply = *reply;
    } else if (const auto* beat = std::get_if<HeartbeatMessage>(&message)) {
      heartbeat = *beat;
    } else if (const auto* fault = std::get_if<FaultMessage>(&message)) {
      faults.push_back(*fault);
    }
  }

  SlcanReader reader;
  CanDecoder decoder;
};

void it_corrects_what_comes_over_the_line() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.bring_up();
  TEST_ASSERT_TRUE(bench.last.corrected != bench.last.uncorrected);
  TEST_ASSERT_EQUAL(State::active, bench.last.state);
  TEST_ASSERT_EQUAL_MESSAGE(3, bench.heartbeat.slot, "the table is in fixed memory");
}

void every_setpoint_is_answered_in_its_step_and_makes_one_tick() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.machine(10);
  const int before = bench.corrected;
  for (int i = 0; i < 100; ++i) {
    bench.send_setpoint();
    bench.step(1);
    TEST_ASSERT_EQUAL(before + i + 1, bench.corrected);
    bench.step(3);
  }
  TEST_ASSERT_EQUAL(before + 100, bench.corrected);
  TEST_ASSERT_EQUAL(0, bench.inner()->late_ticks());
}

void by_the_clock_it_ticks_every_period_whatever_comes() {
  SerialBench bench(settings(Trigger::clock));
  bench.step(400);
  TEST_ASSERT_EQUAL(100, bench.inner()->ticks());
  bench.machine(100);
  TEST_ASSERT_EQUAL(200, bench.inner()->ticks());
  TEST_ASSERT_EQUAL(0, bench.inner()->late_ticks());
}

void a_period_that_is_no_whole_number_of_steps_is_kept_on_average() {
  for (const float period : {0.008F, 0.0025F, 0.016F}) {
    NodeSettings odd = settings(Trigger::clock);
    odd.node.compensator.period = period;
    SerialBench bench(odd);
    bench.step(2000);
    TEST_ASSERT_UINT64_WITHIN(1, static_cast<std::uint64_t>(2.0F / period + 0.5F),
                              bench.inner()->ticks());
    TEST_ASSERT_EQUAL(0, bench.inner()->late_ticks());
  }
}

void without_setpoints_it_ticks_every_period_too() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.machine(10);
  const std::uint64_t before = bench.inner()->ticks();
  bench.step(1000);
  TEST_ASSERT_UINT64_WITHIN(1, before + 250, bench.inner()->ticks());
  TEST_ASSERT_EQUAL(0, bench.inner()->late_ticks());
}

void in_lockstep_it_ticks_for_every_setpoint_however_fast() {
  SerialBench bench(settings(Trigger::lockstep));
  bench.step(1000);
  TEST_ASSERT_EQUAL(0, bench.inner()->ticks());
  for (int i = 0; i < 50; ++i) {
    bench.send_setpoint();
    bench.send_setpoint();
    bench.step(1);
  }
  TEST_ASSERT_EQUAL(100, bench.inner()->ticks());
  TEST_ASSERT_EQUAL(0, bench.inner()->late_ticks());
}

void a_silent_line_makes_it_fade_out_and_latch() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.bring_up();
  bench.step(1000);
  TEST_ASSERT_EQUAL(State::latched, bench.last.state);
  TEST_ASSERT_TRUE(bench.last.corrected == bench.last.uncorrected);
}

void spoilt_text_counts_and_makes_it_fade_out_and_latch() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.bring_up();
  for (int i = 0; i < 1000; ++i) {
    bench.type("t1008zz\r\x80\xFF#garbage\r");
    bench.step(1);
  }
  TEST_ASSERT_EQUAL(State::latched, bench.last.state);
  bool exists = false;
  TEST_ASSERT_TRUE(bench.inner()->statistic(
                       static_cast<std::uint8_t>(StatisticName::foreign_frames), &exists) > 1900);
}

void a_line_that_takes_nothing_is_a_bus_fault_that_ends() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.bring_up();
  bench.listening = false;
  bench.machine(200);
  bool exists = false;
  TEST_ASSERT_TRUE(bench.inner()->statistic(
                       static_cast<std::uint8_t>(StatisticName::dropped_frames), &exists) > 0);
  TEST_ASSERT_EQUAL(State::latched, bench.inner()->state());
  bench.listening = true;
  bench.machine(50);
  TEST_ASSERT_EQUAL_HEX(0, bench.last.node_status & kNodeFaultBits);
  bench.send(CommandMessage{Command::reset});
  bench.machine(20);
  bench.send(CommandMessage{Command::arm});
  bench.machine(60);
  TEST_ASSERT_EQUAL(State::active, bench.inner()->state());
}

using Words = std::vector<std::uint32_t>;

/// The answer at the end of a transfer, and once the main program has looked.
std::uint8_t transfer(SerialBench* bench, const Words& table) {
  const std::uint32_t crc = crc32(table.data(), 4 * table.size());
  bench->send(TransferBeginMessage{static_cast<std::uint32_t>(4 * table.size()), crc});
  bench->step(1);
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    bench->send(TransferDataMessage{i, 1, {table[i]}});
    bench->step(1);
  }
  bench->send(TransferEndMessage{crc});
  bench->step(2);
  TEST_ASSERT_EQUAL(TransferStage::begin, bench->transfer_reply.stage);
  bench->node.check_table();
  bench->machine(60);
  TEST_ASSERT_EQUAL(TransferStage::end, bench->transfer_reply.stage);
  return bench->transfer_reply.result;
}

void a_table_that_comes_over_the_line_is_checked_by_the_main_program_and_used() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.machine(20);
  TEST_ASSERT_EQUAL(0, transfer(&bench, test::loop_table(test::kr270<float>())));
  TEST_ASSERT_EQUAL(1, bench.heartbeat.slot);
}

bool is_used(const IndexMemory& memory) {
  return std::any_of(memory.words, memory.words + memory.capacity,
                     [](std::uint32_t word) { return word != 0; });
}

void tables_get_an_index_in_the_memory_of_their_slot() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.machine(20);
  for (const std::size_t slot : {0U, 1U}) {
    TEST_ASSERT_FALSE(is_used(bench.half_of_indices(slot)));
    TEST_ASSERT_EQUAL(0, transfer(&bench, test::loop_table(test::kr270<float>())));
    TEST_ASSERT_EQUAL(slot + 1, bench.heartbeat.slot);
    TEST_ASSERT_TRUE(is_used(bench.half_of_indices(slot)));
  }
}

void the_table_in_flash_gets_one_too_and_none_does_without() {
  SlcanNode::Bytes received;
  SlcanNode::Bytes to_send;
  Words index(1 << 10);
  const IndexMemory memory = {index.data(), index.size()};
  SlcanNode node(settings(Trigger::setpoint), &received, &to_send, {}, {});
  const Words table = test::loop_table(test::kr270<float>());
  node.start_with(table.data(), 4 * table.size(), {index.data(), 1});
  TEST_ASSERT_FALSE(is_used(memory));
  node.start_with(table.data(), 4 * table.size(), memory);
  TEST_ASSERT_TRUE(is_used(memory));
}

constexpr AuthenticationKey kKey = {1, 2, 3};

NodeSettings settings_with_key() {
  NodeSettings result = settings(Trigger::setpoint);
  result.table_key = kKey;
  return result;
}

Words signed_table(std::uint32_t version, const AuthenticationKey& key = kKey) {
  Words table = test::loop_table(test::kr270<float>());
  const TableTrailer trailer = sign_table(key, table.data(), 4 * table.size(), version).value();
  Words words(sizeof trailer / 4);
  std::memcpy(words.data(), &trailer, sizeof trailer);
  table.insert(table.end(), words.begin(), words.end());
  return table;
}

std::uint8_t number(Reply reply) { return static_cast<std::uint8_t>(reply); }

void with_a_key_only_signed_tables_are_taken() {
  SerialBench bench(settings_with_key());
  bench.machine(20);
  TEST_ASSERT_EQUAL(number(Reply::table_not_signed),
                    transfer(&bench, test::loop_table(test::kr270<float>())));
  TEST_ASSERT_EQUAL(number(Reply::table_forged), transfer(&bench, signed_table(7, {9})));
  TEST_ASSERT_EQUAL(TableStore::kFixed + 1, bench.heartbeat.slot);
  TEST_ASSERT_EQUAL(0, transfer(&bench, signed_table(7)));
  TEST_ASSERT_EQUAL(1, bench.heartbeat.slot);
}

void with_a_key_no_table_is_taken_that_is_older_than_one_that_has_run() {
  SerialBench bench(settings_with_key());
  bench.machine(20);
  TEST_ASSERT_EQUAL(0, transfer(&bench, signed_table(7)));
  TEST_ASSERT_EQUAL(0, transfer(&bench, signed_table(5)));
  bench.bring_up();
  bench.machine(TableTrial::kTicks + 10);
  TEST_ASSERT_EQUAL(number(Reply::table_older), transfer(&bench, signed_table(4)));
  TEST_ASSERT_EQUAL(0, transfer(&bench, signed_table(5)));
}

struct Start {
  std::uint32_t refused = 0;  ///< as announced; 0 if nothing was
  std::size_t slot = 0;       ///< of the first heartbeat; 0 without a table
};

Start start_with(const NodeSettings& settings, Words memory) {
  SlcanNode::Bytes received;
  SlcanNode::Bytes to_send;
  SlcanNode node(settings, &received, &to_send, {}, {});
  memory.resize(memory.size() + 20, 0xFFFFFFFF);  // flash is larger
  node.start_with(memory.data(), 4 * memory.size());
  node.node()->tick(0);
  Start start;
  Message message;
  while (node.node()->next_message(&message)) {
    const auto* fault = std::get_if<FaultMessage>(&message);
    if (fault != nullptr && fault->code == kTableRefusedCode) {
      start.refused = fault->detail;
    } else if (const auto* beat = std::get_if<HeartbeatMessage>(&message)) {
      start.slot = beat->slot;
    }
  }
  return start;
}

void expect_refused(std::uint32_t reason, const Start& start) {
  TEST_ASSERT_EQUAL(reason, start.refused);
  TEST_ASSERT_EQUAL(0, start.slot);
}

void expect_taken(const Start& start) {
  TEST_ASSERT_EQUAL(0, start.refused);
  TEST_ASSERT_EQUAL(TableStore::kFixed + 1, start.slot);
}

void the_table_in_flash_is_judged_like_any_other() {
  const Words plain = test::loop_table(test::kr270<float>());
  const NodeSettings without = settings(Trigger::setpoint);
  expect_taken(start_with(without, plain));
  expect_taken(start_with(without, signed_table(3)));
  expect_taken(start_with(settings_with_key(), signed_table(3)));
  expect_refused(number(Reply::table_not_signed), start_with(settings_with_key(), plain));
  expect_refused(number(Reply::table_forged),
                 start_with(settings_with_key(), signed_table(3, {9})));
}

void a_table_larger_than_the_flash_is_refused_and_an_empty_flash_holds_none() {
  const NodeSettings without = settings(Trigger::setpoint);
  Words endless = test::loop_table(test::kr270<float>());
  endless[2] = 0xFFFFFFF0;  // its size
  expect_refused(static_cast<std::uint32_t>(Result::table_truncated), start_with(without, endless));
  expect_refused(0, start_with(without, Words(200, 0xFFFFFFFF)));
}

void commands_to_an_adapter_are_answered() {
  SerialBench bench(settings(Trigger::setpoint));
  bench.type("C\rS6\rO\r");
  bench.type("nonsense\r");
  bench.listening = false;
  bench.step(1);
  std::string answers;
  std::uint8_t byte = 0;
  while (bench.to_send.pop(&byte)) {
    answers += static_cast<char>(byte);
  }
  TEST_ASSERT_EQUAL_STRING("\r\r\r\a", answers.substr(0, 4).c_str());
}

void without_usable_settings_it_says_so_and_cannot_be_armed() {
  NodeSettings broken = settings(Trigger::setpoint);
  broken.node.compensator.period = std::nanf("");
  SerialBench bench(broken);
  bench.send(IdentityMessage{usual_config().compensator.model_hash, WrenchFrame::base});
  bench.machine(20);
  bench.send(CommandMessage{Command::arm});
  bench.machine(20);
  TEST_ASSERT_EQUAL(State::off, bench.inner()->state());
  TEST_ASSERT_EQUAL_HEX(kConfigRefusedCode, bench.faults.at(0).code);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(it_corrects_what_comes_over_the_line);
  RUN_TEST(every_setpoint_is_answered_in_its_step_and_makes_one_tick);
  RUN_TEST(by_the_clock_it_ticks_every_period_whatever_comes);
  RUN_TEST(a_period_that_is_no_whole_number_of_steps_is_kept_on_average);
  RUN_TEST(without_setpoints_it_ticks_every_period_too);
  RUN_TEST(in_lockstep_it_ticks_for_every_setpoint_however_fast);
  RUN_TEST(a_silent_line_makes_it_fade_out_and_latch);
  RUN_TEST(spoilt_text_counts_and_makes_it_fade_out_and_latch);
  RUN_TEST(a_line_that_takes_nothing_is_a_bus_fault_that_ends);
  RUN_TEST(a_table_that_comes_over_the_line_is_checked_by_the_main_program_and_used);
  RUN_TEST(tables_get_an_index_in_the_memory_of_their_slot);
  RUN_TEST(the_table_in_flash_gets_one_too_and_none_does_without);
  RUN_TEST(with_a_key_only_signed_tables_are_taken);
  RUN_TEST(with_a_key_no_table_is_taken_that_is_older_than_one_that_has_run);
  RUN_TEST(the_table_in_flash_is_judged_like_any_other);
  RUN_TEST(a_table_larger_than_the_flash_is_refused_and_an_empty_flash_holds_none);
  RUN_TEST(commands_to_an_adapter_are_answered);
  RUN_TEST(without_usable_settings_it_says_so_and_cannot_be_armed);
  return UNITY_END();
}
