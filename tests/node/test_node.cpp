// The rules around the core: who may arm it, tables over the bus, what it tells.
#include "core/crc32.hpp"
#include "node/node_on_a_bus.hpp"
#include "node/reply.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::loop_table;
using flexcomp::test::NodeOnABus;
using flexcomp::test::usual_config;
using flexcomp::test::usual_table;

namespace {

std::uint8_t number(Result result) { return static_cast<std::uint8_t>(result); }

std::uint8_t number(Reply reply) { return static_cast<std::uint8_t>(reply); }

/// Sends a table word by word, and lets whoever checks tables do so.
std::uint8_t transfer(NodeOnABus* bus, const std::vector<std::uint32_t>& words,
                      std::optional<std::uint32_t> announced_crc = std::nullopt) {
  const auto size = static_cast<std::uint32_t>(4 * words.size());
  const std::uint32_t crc = announced_crc.value_or(crc32(words.data(), size));
  bus->send(TransferBeginMessage{size, crc});
  for (std::uint32_t i = 0; i < words.size(); ++i) {
    TransferDataMessage data{i, 1, {}};
    data.words[0] = words[i];
    bus->send(data);
    if (i % 16 == 0) {
      bus->machine();
    }
  }
  bus->send(TransferEndMessage{crc});
  bus->machine();
  std::size_t received = 0;
  if (const void* data = bus->node.received_table(&received)) {
    Table table;
    const Result opened = Table::open(data, received, &table);
    bus->node.conclude_transfer(opened, table);
    bus->machine();
  }
  TEST_ASSERT_EQUAL(TransferStage::end, bus->transfer_reply.stage);
  return bus->transfer_reply.result;
}

void it_corrects_only_once_it_is_armed() {
  NodeOnABus bus;
  bus.announce();
  CorrectedMessage message = bus.machine(100);
  TEST_ASSERT_TRUE(message.corrected == message.uncorrected);
  TEST_ASSERT_EQUAL(0, bus.command(Command::arm));
  message = bus.machine(100);
  TEST_ASSERT_FALSE(message.corrected == message.uncorrected);
  TEST_ASSERT_EQUAL(State::active, bus.node.state());
  TEST_ASSERT_EQUAL(0, message.status);
  TEST_ASSERT_EQUAL(0, message.node_status);
}

void it_does_not_arm_for_a_sender_that_has_not_said_who_it_is() {
  NodeOnABus bus;
  bus.machine(50);
  TEST_ASSERT_EQUAL(number(Reply::robot_unknown), bus.command(Command::arm));
  NodeConfig config = usual_config();
  config.require_identity = false;
  NodeOnABus trusting(config);
  trusting.machine(50);
  TEST_ASSERT_EQUAL(0, trusting.command(Command::arm));
}

void it_does_not_arm_without_a_table_or_too_early() {
  NodeOnABus early;
  early.announce();
  TEST_ASSERT_EQUAL(number(Result::not_ready), early.command(Command::arm));
  Node empty;
  TEST_ASSERT_EQUAL(Result::ok, empty.configure(usual_config()));
  const std::uint64_t robot = usual_config().compensator.model_hash;
  empty.receive(IdentityMessage{robot, WrenchFrame::base}, Source::can_classic, 0);
  empty.receive(CommandMessage{Command::arm}, Source::can_classic, 0);
  Message message;
  TEST_ASSERT_TRUE(empty.next_message(&message));
  TEST_ASSERT_EQUAL(number(Result::no_table), std::get<CommandReplyMessage>(message).reply);
}

void a_gain_above_the_largest_safe_one_is_refused_with_that_gain() {
  NodeOnABus bus(usual_config(), loop_table(kr270<float>(), 0.25F));
  TEST_ASSERT_EQUAL(Result::gain_too_high, bus.started_with);
  bus.announce();
  bus.machine(50);
  TEST_ASSERT_EQUAL(number(Result::gain_too_high), bus.command(Command::arm));
  TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.25, bus.command_reply.largest_gain);
  NodeConfig gentle = usual_config();
  gentle.compensator.gain = 0.25F;
  NodeOnABus other(gentle, loop_table(kr270<float>(), 0.25F));
  other.bring_up();
}

void a_new_table_over_the_bus_is_swapped_in_while_correcting() {
  NodeOnABus bus;
  bus.bring_up();
  TEST_ASSERT_EQUAL(0, transfer(&bus, loop_table(kr270<float>(), 1)));
  TEST_ASSERT_EQUAL(1, bus.node.active_slot());
  for (int i = 0; i < 200; ++i) {
    const CorrectedMessage message = bus.machine();
    TEST_ASSERT_EQUAL(0, message.status & kFaultBits);
    TEST_ASSERT_EQUAL(0, message.node_status);
  }
  TEST_ASSERT_EQUAL(2, bus.heartbeat.slot);
  TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1, bus.heartbeat.largest_gain);
  TEST_ASSERT_TRUE(bus.has_announced(kTableInUseCode, true));
}

void a_table_that_is_damaged_foreign_or_old_is_refused_and_the_one_in_use_stays() {
  NodeOnABus bus;
  bus.bring_up();
  std::vector<std::uint32_t> words = usual_table();
  words[100] ^= 4;
  TEST_ASSERT_EQUAL(number(Result::table_corrupt), transfer(&bus, words));
  TEST_ASSERT_EQUAL(number(Reply::transfer_crc), transfer(&bus, usual_table(), 0x1234));
  words = usual_table();
  words[1] = kTableVersion + 1;
  TEST_ASSERT_EQUAL(number(Result::table_version), transfer(&bus, words));
  RobotModel<float, 6> other = kr270<float>();
  other.payload_mass = 50;
  other.tool.position.x() += 0.1F;
  TEST_ASSERT_EQUAL(number(Result::table_other_model), transfer(&bus, loop_table(other)));
  TEST_ASSERT_EQUAL(number(Result::gain_too_high),
                    transfer(&bus, loop_table(kr270<float>(), 0.5F)));
  TEST_ASSERT_EQUAL(0, bus.node.active_slot());
  TEST_ASSERT_EQUAL(0, bus.machine(10).status & kFaultBits);
  TEST_ASSERT_EQUAL(State::active, bus.node.state());
  TEST_ASSERT_TRUE(bus.has_announced(kTableRefusedCode, true));
}

void a_transfer_with_a_word_missing_too_large_or_unannounced_is_refused_at_once() {
  NodeOnABus bus;
  bus.send(TransferDataMessage{0, 1, {}});
  bus.machine();
  TEST_ASSERT_EQUAL(number(Reply::transfer_out_of_order), bus.transfer_reply.result);
  bus.send(TransferBeginMessage{1 << 19, 0});
  bus.machine();
  TEST_ASSERT_EQUAL(number(Reply::transfer_refused), bus.transfer_reply.result);
  bus.send(TransferBeginMessage{400, 0});
  bus.send(TransferDataMessage{0, 1, {}});
  bus.send(TransferDataMessage{2, 1, {}});
  bus.machine();
  TEST_ASSERT_EQUAL(TransferStage::data, bus.transfer_reply.stage);
  TEST_ASSERT_EQUAL(number(Reply::transfer_out_of_order), bus.transfer_reply.result);
  TEST_ASSERT_EQUAL(1, bus.transfer_reply.words);
  bus.send(TransferEndMessage{0});
  bus.machine();
  TEST_ASSERT_EQUAL(number(Reply::transfer_out_of_order), bus.transfer_reply.result);
}

void a_configuration_is_taken_whole_when_off_and_refused_while_correcting() {
  NodeOnABus bus;
  NodeConfig config = usual_config();
  config.compensator.gain = 0.5F;
  TEST_ASSERT_EQUAL(Result::ok, bus.node.configure(config));
  bus.bring_up();
  TEST_ASSERT_EQUAL(Result::not_ready, bus.node.configure(usual_config()));
  TEST_ASSERT_EQUAL(0, bus.command(Command::disarm));
  bus.machine(100);
  NodeConfig bad = usual_config();
  bad.compensator.period = -1;
  TEST_ASSERT_EQUAL(Result::bad_config, bus.node.configure(bad));
  bad = usual_config();
  bad.deflection_error = 0;
  TEST_ASSERT_EQUAL(Result::bad_config, bus.node.configure(bad));
  TEST_ASSERT_EQUAL(Result::ok, bus.node.configure(usual_config()));
  bus.bring_up();
}

void refused_messages_are_counted_only_where_there_is_a_key() {
  Node node;
  LinkState link;
  const auto first = static_cast<std::uint8_t>(StatisticName::forged_messages);
  for (const bool has_key : {false, true}) {
    link.authentication = {has_key, 10, 11, 12};
    node.set_link(link);
    for (std::uint8_t i = 0; i < 3; ++i) {
      bool exists = !has_key;
      TEST_ASSERT_EQUAL(10 + i, node.statistic(static_cast<std::uint8_t>(first + i), &exists));
      TEST_ASSERT_EQUAL(has_key, exists);
    }
  }
}

void a_report_gives_every_statistic() {
  NodeOnABus bus;
  bus.bring_up();
  bus.command(Command::report);
  bus.machine(60);
  TEST_ASSERT_EQUAL(9 + 8 + 8 + LatencyHistogram::kBins, bus.statistics.size());
  for (const StatisticMessage& statistic : bus.statistics) {
    if (statistic.name == static_cast<std::uint8_t>(StatisticName::setpoint_lost)) {
      TEST_ASSERT_EQUAL(0, statistic.value);
    }
    if (statistic.name == static_cast<std::uint8_t>(StatisticName::setpoint_received)) {
      TEST_ASSERT_GREATER_THAN(80, statistic.value);
    }
  }
}

void before_the_first_setpoint_it_gives_no_angles() {
  NodeOnABus bus;
  const CorrectedMessage message = bus.tick();
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_TRUE(std::isnan(message.corrected[i]));
  }
  TEST_ASSERT_TRUE((message.status & kNoSetpoint) != 0);
}

void messages_that_nobody_takes_do_not_pile_up() {
  NodeOnABus bus;
  for (int i = 0; i < 1000; ++i) {
    bus.send(CommandMessage{Command::none});
  }
  Message message;
  int count = 0;
  while (bus.node.next_message(&message)) {
    ++count;
  }
  TEST_ASSERT_EQUAL(8, count);
}

void every_reply_and_bit_has_a_name() {
  for (int reply = 0; reply <= static_cast<int>(Reply::transfer_crc); ++reply) {
    const bool exists = reply <= static_cast<int>(Result::no_table) ||
                        reply >= static_cast<int>(Reply::robot_unknown);
    const std::string name = describe_reply(static_cast<std::uint8_t>(reply));
    TEST_ASSERT_EQUAL(exists, name != "unknown result");
  }
  for (unsigned bit = 0; bit < 16; ++bit) {
    const std::string name = describe(static_cast<NodeBit>(1U << bit));
    const bool exists = bit <= 8 || bit >= 12;
    TEST_ASSERT_EQUAL(exists, name != "unknown bit");
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(it_corrects_only_once_it_is_armed);
  RUN_TEST(it_does_not_arm_for_a_sender_that_has_not_said_who_it_is);
  RUN_TEST(it_does_not_arm_without_a_table_or_too_early);
  RUN_TEST(a_gain_above_the_largest_safe_one_is_refused_with_that_gain);
  RUN_TEST(a_new_table_over_the_bus_is_swapped_in_while_correcting);
  RUN_TEST(a_table_that_is_damaged_foreign_or_old_is_refused_and_the_one_in_use_stays);
  RUN_TEST(a_transfer_with_a_word_missing_too_large_or_unannounced_is_refused_at_once);
  RUN_TEST(a_configuration_is_taken_whole_when_off_and_refused_while_correcting);
  RUN_TEST(refused_messages_are_counted_only_where_there_is_a_key);
  RUN_TEST(a_report_gives_every_statistic);
  RUN_TEST(before_the_first_setpoint_it_gives_no_angles);
  RUN_TEST(messages_that_nobody_takes_do_not_pile_up);
  RUN_TEST(every_reply_and_bit_has_a_name);
  return UNITY_END();
}
