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

void what_only_the_start_reads_is_refused_by_name() {
  const std::map<std::string, std::vector<const char*>> changes = {
      {"can", {"--can", "can1"}},
      {"fd", {"--can", "can0", "--fd"}},
      {"lcm", {"--can", "can0", "--lcm", "udpm://"}},
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
  TEST_ASSERT_EQUAL(changes.size(), running.fixed.size());
  for (const FixedOption& option : running.fixed) {
    TEST_ASSERT_EQUAL_STRING(
        (option.name + " cannot change while running; restart flexcompd").c_str(),
        refused_changes(running, read(changes.at(option.name))).c_str());
  }
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
  RUN_TEST(all_that_are_refused_are_named);
  RUN_TEST(the_same_value_in_other_words_is_no_change);
  RUN_TEST(the_rest_may_change);
  return UNITY_END();
}
