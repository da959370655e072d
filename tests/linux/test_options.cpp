// Options that SIGHUP may change, and those that only the start reads.
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "linux/options.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

/// The options as read from a command line.
Options read(std::vector<const char*> more) {
  std::vector<const char*> all = {"flexcompd", "--model-hash", "0123456789abcdef"};
  all.insert(all.end(), more.begin(), more.end());
  int exit_code = 0;
  const std::optional<Options> options =
      read_options(static_cast<int>(all.size()), all.data(), &exit_code);
  TEST_ASSERT_TRUE(options.has_value());
  return *options;
}

Options usual() { return read({"--can", "can0"}); }

constexpr const char* kJoint = "0,0,0.1,0,0,0,0,0,1";
/// Beside a bus, the geometry of an arm with a sensor.
const std::vector<const char*> kArm = {"--can",
                                       "can0",
                                       "--sensor-joint-1",
                                       kJoint,
                                       "--sensor-joint-2",
                                       kJoint,
                                       "--sensor-joint-3",
                                       kJoint,
                                       "--sensor-joint-4",
                                       kJoint,
                                       "--sensor-joint-5",
                                       kJoint,
                                       "--sensor-joint-6",
                                       kJoint,
                                       "--sensor-tcp",
                                       "0,0,0"};

std::vector<const char*> with_sensor(std::vector<const char*> more = {}) {
  more.insert(more.begin(), {"--sensor", "udp://127.0.0.1:49152"});
  more.insert(more.begin(), kArm.begin(), kArm.end());
  return more;
}

void what_only_the_start_reads_is_refused_by_name() {
  const std::map<std::string, std::vector<const char*>> changes = {
      {"can", {"--can", "can1"}},
      {"fd", {"--can", "can0", "--fd"}},
      {"lcm", {"--can", "can0", "--lcm", "udpm://"}},
      {"rsi", {"--can", "can0", "--rsi", "udp://127.0.0.1:49152"}},
      {"rsi-mode", {"--can", "can0", "--rsi-mode", "relative"}},
      {"rsi-type", {"--can", "can0", "--rsi-type", "a"}},
      {"rsi-correction", {"--can", "can0", "--rsi-correction", "a"}},
      {"rsi-wrench", {"--can", "can0", "--rsi-wrench", "a"}},
      {"rsi-arm", {"--can", "can0", "--rsi-arm", "a"}},
      {"rsi-applied", {"--can", "can0", "--rsi-applied", "a"}},
      {"rsi-state", {"--can", "can0", "--rsi-state", "a"}},
      {"rsi-limit", {"--can", "can0", "--rsi-limit", "0.5"}},
      {"rsi-step", {"--can", "can0", "--rsi-step", "0.01"}},
      {"rsi-sign", {"--can", "can0", "--rsi-sign", "-1,1,1,1,1,1"}},
      {"rsi-zero", {"--can", "can0", "--rsi-zero", "0,-90,90,0,0,0"}},
      {"sensor-counts", {"--can", "can0", "--sensor-counts", "1000,2000"}},
      {"sensor-zero", {"--can", "can0", "--sensor-zero", "1,2,3,4,5,6"}},
      {"sensor-mass", {"--can", "can0", "--sensor-mass", "12"}},
      {"sensor-center-of-mass", {"--can", "can0", "--sensor-center-of-mass", "0,0,0.1"}},
      {"sensor-frame", {"--can", "can0", "--sensor-frame", "0,0,0.1,0,0,0"}},
      {"sensor-tcp", {"--can", "can0", "--sensor-tcp", "0,0,0.1"}},
      {"sensor-gravity", {"--can", "can0", "--sensor-gravity", "0,0,9.81"}},
      {"sensor-joint-1", {"--can", "can0", "--sensor-joint-1", kJoint}},
      {"sensor-joint-2", {"--can", "can0", "--sensor-joint-2", kJoint}},
      {"sensor-joint-3", {"--can", "can0", "--sensor-joint-3", kJoint}},
      {"sensor-joint-4", {"--can", "can0", "--sensor-joint-4", kJoint}},
      {"sensor-joint-5", {"--can", "can0", "--sensor-joint-5", kJoint}},
      {"sensor-joint-6", {"--can", "can0", "--sensor-joint-6", kJoint}},
      {"key", {"--can", "can0", "--key", "a"}},
      {"trigger", {"--can", "can0", "--trigger", "clock"}},
      {"tolerated-losses", {"--can", "can0", "--tolerated-losses", "2"}},
      {"table", {"--can", "can0", "--table", "a"}},
      {"state-directory", {"--can", "can0", "--state-directory", "a"}},
      {"period", {"--can", "can0", "--period", "0.0078"}},
      {"priority", {"--can", "can0", "--priority", "3"}},
      {"user", {"--can", "can0", "--user", "a"}},
      {"statistics", {"--can", "can0", "--statistics", "a"}},
      {"settings-out", {"--can", "can0", "--settings-out", "a"}}};
  const Options running = usual();
  TEST_ASSERT_EQUAL(changes.size() + 1, running.fixed.size());
  TEST_ASSERT_EQUAL_STRING("sensor cannot change while running; restart flexcompd",
                           refused_changes(read(kArm), read(with_sensor())).c_str());
  for (const FixedOption& option : running.fixed) {
    if (option.name == "sensor") {
      continue;  // which is nothing without the arm
    }
    TEST_ASSERT_EQUAL_STRING(
        (option.name + " cannot change while running; restart flexcompd").c_str(),
        refused_changes(running, read(changes.at(option.name))).c_str());
  }
}

int exit_code_of(std::vector<const char*> more) {
  std::vector<const char*> all = {"flexcompd", "--model-hash", "0123456789abcdef"};
  all.insert(all.end(), more.begin(), more.end());
  int exit_code = 0;
  return read_options(static_cast<int>(all.size()), all.data(), &exit_code) ? 0 : exit_code;
}

void over_rsi_alone_the_telegrams_must_bring_all_that_is_needed() {
  const char* address = "udp://127.0.0.1:49152";
  TEST_ASSERT_EQUAL(0, exit_code_of({"--rsi", address, "--rsi-wrench", "FT", "--rsi-arm", "Arm",
                                     "--without-identity"}));
  TEST_ASSERT_EQUAL(2, exit_code_of({"--rsi", address, "--rsi-arm", "Arm", "--without-identity"}));
  TEST_ASSERT_EQUAL(2,
                    exit_code_of({"--rsi", address, "--rsi-wrench", "FT", "--without-identity"}));
  TEST_ASSERT_EQUAL(2, exit_code_of({"--rsi", address, "--rsi-wrench", "FT", "--rsi-arm", "Arm"}));
  TEST_ASSERT_EQUAL(0, exit_code_of({"--rsi", address, "--can", "can0"}));
}

void a_sensor_needs_the_arm_and_no_other_wrench_beside_it() {
  TEST_ASSERT_EQUAL(0, exit_code_of(with_sensor()));
  for (std::size_t i = 2; i < kArm.size(); i += 2) {
    std::vector<const char*> incomplete = with_sensor();
    incomplete.erase(incomplete.begin() + static_cast<std::ptrdiff_t>(i),
                     incomplete.begin() + static_cast<std::ptrdiff_t>(i + 2));
    TEST_ASSERT_EQUAL(2, exit_code_of(incomplete));
    if (i + 2 < kArm.size()) {
      std::vector<const char*> impossible = with_sensor();
      impossible[i + 1] = "0,0,0.1,0,0,0,0,0,0.9";
      TEST_ASSERT_EQUAL(2, exit_code_of(impossible));
    }
  }
  TEST_ASSERT_EQUAL(2, exit_code_of(with_sensor({"--rsi-wrench", "FT"})));
  TEST_ASSERT_EQUAL(0, exit_code_of(with_sensor({"--rsi", "udp://127.0.0.1:49153"})));
}

void names_that_xml_would_have_to_quote_are_refused() {
  for (const char* name :
       {"a\"b", "<a>", "1a", "a b", "", "a&b", "a23456789012345678901234567890123"}) {
    TEST_ASSERT_EQUAL(2, exit_code_of({"--can", "can0", "--rsi-type", name}));
    TEST_ASSERT_EQUAL(2, exit_code_of({"--can", "can0", "--rsi-arm", name}));
  }
}

void signs_and_zeros_of_the_axes_are_six_each() {
  TEST_ASSERT_EQUAL(2, exit_code_of({"--can", "can0", "--rsi-sign", "-1,1,1"}));
  TEST_ASSERT_EQUAL(2, exit_code_of({"--can", "can0", "--rsi-sign", "-1,1,1,1,1,0.5"}));
  TEST_ASSERT_EQUAL(2, exit_code_of({"--can", "can0", "--rsi-zero", "0,0,0,0,0,400"}));
  const Options options = read({"--can", "can0", "--rsi-sign", "-1,1,1,1,1,1", "--rsi-zero",
                                "0,-90,90,0,0,0", "--rsi-mode", "relative"});
  const RsiConfig config = to_config(options.rsi, 3);
  TEST_ASSERT_EQUAL_DOUBLE(-1, config.axes.sign[0]);
  TEST_ASSERT_EQUAL_DOUBLE(-90, config.axes.zero[1]);
  TEST_ASSERT_TRUE(config.mode == RsiMode::relative && config.schema.needs_late);
}

void all_that_are_refused_are_named() {
  TEST_ASSERT_EQUAL_STRING(
      "trigger, period cannot change while running; restart flexcompd",
      refused_changes(usual(), read({"--can", "can0", "--period", "0.01", "--trigger", "clock"}))
          .c_str());
}

void the_same_value_in_other_words_is_no_change() {
  TEST_ASSERT_EQUAL_STRING(
      "", refused_changes(usual(), read({"--can", "can0", "--period", "4.0e-3", "--trigger",
                                         "SETPOINT", "--priority", "+80"}))
              .c_str());
}

void the_rest_may_change() {
  const Options wanted =
      read({"--can", "can0", "--gain", "0.5", "--heartbeat", "0.3", "--correction-limit", "0.001",
            "--ready-ticks", "7", "--without-identity", "--late-ticks", "3"});
  TEST_ASSERT_EQUAL_STRING("", refused_changes(usual(), wanted).c_str());
  TEST_ASSERT_EQUAL_FLOAT(0.5F, wanted.settings.node.compensator.gain);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_only_the_start_reads_is_refused_by_name);
  RUN_TEST(over_rsi_alone_the_telegrams_must_bring_all_that_is_needed);
  RUN_TEST(a_sensor_needs_the_arm_and_no_other_wrench_beside_it);
  RUN_TEST(names_that_xml_would_have_to_quote_are_refused);
  RUN_TEST(signs_and_zeros_of_the_axes_are_six_each);
  RUN_TEST(all_that_are_refused_are_named);
  RUN_TEST(the_same_value_in_other_words_is_no_change);
  RUN_TEST(the_rest_may_change);
  return UNITY_END();
}
