// Every message through LCM's encoding and back.
#include <cmath>
#include <utility>
#include <vector>

#include "messages/lcm_codec.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

template <typename Kind>
Kind through(const Kind& message) {
  const LcmEvent event = encode_lcm(message, 7, 123456789012345);
  const LcmMessage back = decode_lcm(event.channel, event.data.data(), event.data.size());
  TEST_ASSERT_EQUAL(Message(message).index(), back.message.index());
  TEST_ASSERT_EQUAL_INT64(7, back.sequence);
  TEST_ASSERT_EQUAL_INT64(123456789012345, back.timestamp);
  return std::get<Kind>(back.message);
}

void setpoints_and_wrenches_keep_every_bit() {
  const JointAngles q = {1.0 / 3, -M_PI, 6.2, 1e-300, -0.0, 5};
  const auto setpoint = through(SetpointMessage{kNoTime, q});
  TEST_ASSERT_TRUE(setpoint.q == q);
  TEST_ASSERT_EQUAL_INT64(123456789012345, setpoint.timestamp);
  const auto wrench = through(WrenchMessage{kNoTime, q, true});
  TEST_ASSERT_TRUE(wrench.wrench == q);
  TEST_ASSERT_TRUE(wrench.saturated);
  TEST_ASSERT_TRUE(through(MeasuredJointsMessage{q}).q == q);
  TEST_ASSERT_TRUE(
      (through(MeasuredPositionMessage{{1, 2, 3}}).position == std::array<double, 3>{1, 2, 3}));
}

void answers_keep_every_bit() {
  const JointAngles q = {1, 2, 3, 4, 5, 6};
  const JointAngles p = {6, 5, 4, 3, 2, 1};
  const auto corrected = through(CorrectedMessage{99, q, p, 0xFFFFFFFF, 0xFFFF, 5});
  TEST_ASSERT_TRUE(corrected.corrected == q);
  TEST_ASSERT_TRUE(corrected.uncorrected == p);
  TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, corrected.status);
  TEST_ASSERT_EQUAL_HEX16(0xFFFF, corrected.node_status);
  TEST_ASSERT_EQUAL(5, corrected.state);
  TEST_ASSERT_EQUAL(99, corrected.timestamp);
  const auto beat = through(HeartbeatMessage{1, 2, 3, 200, 5, 0x8001, ~std::uint64_t{0}, 0.125});
  TEST_ASSERT_EQUAL(200, beat.table_result);
  TEST_ASSERT_EQUAL_HEX16(0x8001, beat.node_latched_faults);
  TEST_ASSERT_EQUAL_HEX64(~std::uint64_t{0}, beat.table_model_hash);
  TEST_ASSERT_EQUAL_DOUBLE(0.125, beat.largest_gain);
  const auto fault = through(FaultMessage{0x7105, true, 0xFFFFFFFF});
  TEST_ASSERT_EQUAL_HEX16(0x7105, fault.code);
  TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, fault.detail);
  TEST_ASSERT_EQUAL(200, through(CommandReplyMessage{Command::arm, 200, 1}).reply);
  TEST_ASSERT_EQUAL(200, through(TransferReplyMessage{TransferStage::end, 200, 9}).result);
  TEST_ASSERT_EQUAL(9, through(TransferReplyMessage{TransferStage::end, 200, 9}).words);
  TEST_ASSERT_EQUAL(12345678, through(StatisticMessage{64, 12345678}).value);
}

void commands_and_tables_keep_every_bit() {
  TEST_ASSERT_EQUAL(Command::reset, through(CommandMessage{Command::reset}).command);
  const auto identity = through(IdentityMessage{0xFEDCBA9876543210, WrenchFrame::tool});
  TEST_ASSERT_EQUAL_HEX64(0xFEDCBA9876543210, identity.model_hash);
  TEST_ASSERT_EQUAL(WrenchFrame::tool, identity.wrench_frame);
  TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, through(TransferBeginMessage{12, 0xFFFFFFFF}).crc);
  TEST_ASSERT_EQUAL_HEX32(0x80000001, through(TransferEndMessage{0x80000001}).crc);
  TransferDataMessage data{70000, 14, {}};
  for (std::uint32_t i = 0; i < 14; ++i) {
    data.words[i] = 0xF0000000 + i;
  }
  const auto back = through(data);
  TEST_ASSERT_EQUAL(70000, back.word_index);
  TEST_ASSERT_EQUAL(14, back.count);
  TEST_ASSERT_EQUAL_HEX32_ARRAY(data.words.data(), back.words.data(), 14);
}

void each_message_goes_on_the_channel_of_its_type() {
  const std::vector<std::pair<Message, const char*>> channels = {
      {SetpointMessage{}, "FLEXCOMP_JOINT_SETPOINT"},
      {WrenchMessage{}, "FLEXCOMP_WRENCH"},
      {CommandMessage{}, "FLEXCOMP_COMMAND"},
      {IdentityMessage{}, "FLEXCOMP_IDENTITY"},
      {TransferBeginMessage{}, "FLEXCOMP_TABLE_BEGIN"},
      {TransferDataMessage{}, "FLEXCOMP_TABLE_DATA"},
      {TransferEndMessage{}, "FLEXCOMP_TABLE_END"},
      {MeasuredJointsMessage{}, "FLEXCOMP_MEASURED_JOINTS"},
      {MeasuredPositionMessage{}, "FLEXCOMP_MEASURED_POSITION"},
      {CorrectedMessage{}, "FLEXCOMP_CORRECTED_SETPOINT"},
      {HeartbeatMessage{}, "FLEXCOMP_HEARTBEAT"},
      {FaultMessage{}, "FLEXCOMP_FAULT"},
      {StatisticMessage{}, "FLEXCOMP_STATISTIC"},
      {TransferReplyMessage{}, "FLEXCOMP_TABLE_REPLY"},
      {CommandReplyMessage{}, "FLEXCOMP_COMMAND_REPLY"}};
  TEST_ASSERT_EQUAL(std::variant_size_v<Message> - 1, channels.size());
  for (const auto& [message, channel] : channels) {
    TEST_ASSERT_EQUAL_STRING(channel, encode_lcm(message, 0, 0).channel.c_str());
  }
  TEST_ASSERT_EQUAL_STRING("", encode_lcm(Message(), 0, 0).channel.c_str());
}

void a_truncated_event_or_a_foreign_channel_is_no_message() {
  const LcmEvent event = encode_lcm(SetpointMessage{kNoTime, {}}, 0, 0);
  for (std::size_t size = 0; size < event.data.size(); ++size) {
    TEST_ASSERT_EQUAL(0, decode_lcm(event.channel, event.data.data(), size).message.index());
  }
  TEST_ASSERT_EQUAL(0, decode_lcm("OTHER", event.data.data(), event.data.size()).message.index());
  TEST_ASSERT_EQUAL(
      0, decode_lcm("FLEXCOMP_WRENCH", event.data.data(), event.data.size()).message.index());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(setpoints_and_wrenches_keep_every_bit);
  RUN_TEST(answers_keep_every_bit);
  RUN_TEST(commands_and_tables_keep_every_bit);
  RUN_TEST(each_message_goes_on_the_channel_of_its_type);
  RUN_TEST(a_truncated_event_or_a_foreign_channel_is_no_message);
  return UNITY_END();
}
