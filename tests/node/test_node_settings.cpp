#include <cstring>
#include <limits>
#include <vector>

#include "node/default_config.hpp"
#include "node/node_settings.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

NodeSettings some_settings() {
  NodeSettings settings;
  settings.node = default_node_config();
  settings.node.compensator.model_hash = 0x123456789ABCDEF0;
  settings.node.compensator.gain = 0.75F;
  settings.node.compensator.ready_ticks = 17;
  settings.node.compensator.joint_speed << 1, 2, 3, 4, 5, 6;
  settings.node.compensator.limits[3] = {0.02F, 0.2F, 6.0F};
  settings.node.late_ticks = 23;
  settings.node.require_identity = false;
  settings.node.heartbeat_period = 0.25;
  settings.trigger = Trigger::lockstep;
  settings.tolerated_losses = 2;
  settings.table_key = AuthenticationKey{1, 2, 3};
  return settings;
}

void what_is_written_is_read() {
  const SettingsRecord record = to_record(some_settings());
  NodeSettings read;
  TEST_ASSERT_EQUAL(Result::ok, read_record(&record, sizeof record, &read));
  const auto& core = read.node.compensator;
  TEST_ASSERT_EQUAL_HEX64(0x123456789ABCDEF0, core.model_hash);
  TEST_ASSERT_EQUAL_FLOAT(0.75F, core.gain);
  TEST_ASSERT_EQUAL(17, core.ready_ticks);
  TEST_ASSERT_EQUAL_FLOAT(4, core.joint_speed[3]);
  TEST_ASSERT_EQUAL_FLOAT(0.2F, core.limits[3].rate);
  TEST_ASSERT_EQUAL(23, read.node.late_ticks);
  TEST_ASSERT_FALSE(read.node.require_identity);
  TEST_ASSERT_TRUE(read.node.use_timestamps);
  TEST_ASSERT_EQUAL_DOUBLE(0.25, read.node.heartbeat_period);
  TEST_ASSERT_EQUAL(Trigger::lockstep, read.trigger);
  TEST_ASSERT_EQUAL(2, read.tolerated_losses);
  TEST_ASSERT_TRUE(read.table_key == (AuthenticationKey{1, 2, 3}));
  const SettingsRecord again = to_record(read);
  TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&record, &again, sizeof record, "no field is left out");
}

void any_byte_that_is_wrong_is_noticed() {
  const SettingsRecord record = to_record(some_settings());
  for (std::size_t i = 0; i < sizeof record; ++i) {
    std::vector<unsigned char> bytes(sizeof record);
    std::memcpy(bytes.data(), &record, sizeof record);
    bytes[i] ^= 0x40U;
    NodeSettings read;
    TEST_ASSERT_EQUAL(Result::bad_config, read_record(bytes.data(), bytes.size(), &read));
  }
}

void an_empty_flash_and_too_few_bytes_are_no_record() {
  const std::vector<unsigned char> empty(4096, 0xFF);
  NodeSettings read;
  TEST_ASSERT_EQUAL(Result::bad_config, read_record(empty.data(), empty.size(), &read));
  const SettingsRecord record = to_record(some_settings());
  TEST_ASSERT_EQUAL(Result::bad_config, read_record(&record, sizeof record - 1, &read));
  TEST_ASSERT_EQUAL(Result::bad_config, read_record(nullptr, sizeof record, &read));
}

void numbers_that_no_node_takes_are_refused() {
  for (const float wrong : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    NodeSettings settings = some_settings();
    settings.node.compensator.period = wrong;
    const SettingsRecord record = to_record(settings);
    NodeSettings read;
    TEST_ASSERT_EQUAL(Result::bad_config, read_record(&record, sizeof record, &read));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_is_written_is_read);
  RUN_TEST(any_byte_that_is_wrong_is_noticed);
  RUN_TEST(an_empty_flash_and_too_few_bytes_are_no_record);
  RUN_TEST(numbers_that_no_node_takes_are_refused);
  return UNITY_END();
}
