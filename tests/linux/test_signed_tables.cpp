// Tables that a node with a key takes, and those it starts with after an end in between.
#include <cstring>

#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "host/scratch_folder.hpp"
#include "linux/slot_files.hpp"
#include "node/table_admission.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::ScratchFolder;

namespace {

using Bytes = std::vector<char>;

constexpr AuthenticationKey kKey = {1, 2, 3};
constexpr std::size_t kMost = 1 << 20;

const Bytes& table() {
  static const Bytes kTable = [] {
    const JointVector<float, 6> program[2] = {test::loop_angles<float>(0),
                                              test::loop_angles<float>(0.1)};
    std::vector<std::uint32_t> words(1 << 14);
    std::size_t size = 0;
    TEST_ASSERT_EQUAL(Result::ok, (build_path_table<float, 6>(
                                      test::kr270<float>(), program, 2, {2000, 50, 5e-6F, 5e-6F, 0},
                                      words.data(), 4 * words.size(), &size)));
    Bytes bytes(size);
    std::memcpy(bytes.data(), words.data(), size);
    return bytes;
  }();
  return kTable;
}

Bytes version(std::uint32_t counter, const AuthenticationKey& key = kKey) {
  const TableTrailer trailer = sign_table(key, table().data(), table().size(), counter).value();
  const auto* begin = reinterpret_cast<const char*>(&trailer);
  Bytes bytes = table();
  bytes.insert(bytes.end(), begin, begin + sizeof trailer);
  return bytes;
}

Reply judge(const TableAdmission& admission, const Bytes& bytes) {
  std::uint32_t counter = 0;
  return admission.judge(bytes.data(), bytes.size(), &counter);
}

void only_signed_tables_no_older_than_what_has_run_are_taken() {
  TableAdmission admission(kKey, 5);
  TEST_ASSERT_TRUE(judge(admission, table()) == Reply::table_not_signed);
  TEST_ASSERT_TRUE(judge(admission, version(7, {9})) == Reply::table_forged);
  TEST_ASSERT_TRUE(judge(admission, version(4)) == Reply::table_older);
  TEST_ASSERT_TRUE(judge(admission, version(5)) == Reply::ok);
  TEST_ASSERT_TRUE(judge(admission, version(7)) == Reply::ok);
  TEST_ASSERT_TRUE(judge(admission, version(5)) == Reply::ok);  // 7 was taken, but has not run
  admission.has_run(7);
  TEST_ASSERT_TRUE(judge(admission, version(6)) == Reply::table_older);
  TEST_ASSERT_TRUE(judge(admission, version(7)) == Reply::ok);
  admission.has_run(3);
  TEST_ASSERT_EQUAL(7, admission.highest());
}

/// Each step as a process of its own: what one has not written, the next does not know.
void a_table_that_has_not_run_is_not_started_with() {
  const ScratchFolder folder;
  const std::string name = (folder / "").string();
  const auto stage = [&](std::uint32_t counter, bool runs) {
    SlotFiles files(name);
    const Bytes bytes = version(counter);
    files.stage(bytes.data(), bytes.size());
    if (runs) {
      TEST_ASSERT_TRUE(files.confirm());
      files.raise_counter(counter);
    }
  };
  stage(5, false);
  TEST_ASSERT_FALSE(SlotFiles(name).confirmed(kMost).has_value());
  TEST_ASSERT_EQUAL(0, SlotFiles(name).counter());
  stage(6, true);
  TEST_ASSERT_TRUE(SlotFiles(name).confirmed(kMost) == version(6));
  TEST_ASSERT_EQUAL(6, SlotFiles(name).counter());
  for (const std::uint32_t counter : {7U, 8U}) {  // the second is written over the first
    stage(counter, false);
    TEST_ASSERT_TRUE(SlotFiles(name).confirmed(kMost) == version(6));
    TEST_ASSERT_EQUAL(6, SlotFiles(name).counter());
  }
  stage(9, true);
  TEST_ASSERT_TRUE(SlotFiles(name).confirmed(kMost) == version(9));
  TEST_ASSERT_EQUAL(9, SlotFiles(name).counter());
}

void nothing_is_confirmed_that_was_not_staged() {
  const ScratchFolder folder;
  SlotFiles files((folder / "").string());
  TEST_ASSERT_FALSE(files.confirm());
  const Bytes bytes = version(1);
  files.stage(bytes.data(), bytes.size());
  TEST_ASSERT_TRUE(files.confirm());
  TEST_ASSERT_FALSE(files.confirm());
}

void a_counter_never_goes_back() {
  const ScratchFolder folder;
  SlotFiles files((folder / "").string());
  for (const std::uint32_t counter : {5U, 4U, 0U}) {
    files.raise_counter(counter);
    TEST_ASSERT_EQUAL(5, files.counter());
  }
  files.raise_counter(0xFFFFFFFF);
  TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, files.counter());
}

void a_counter_that_cannot_be_read_is_not_taken_for_none() {
  const ScratchFolder folder;
  for (const char* text : {"", "\n", "five\n", "5", "5 \n", "-5\n", "4294967296\n", "5\n\n"}) {
    test::put(folder / "counter", text);
    try {
      static_cast<void>(SlotFiles((folder / "").string()).counter());
      TEST_FAIL_MESSAGE(text);
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(only_signed_tables_no_older_than_what_has_run_are_taken);
  RUN_TEST(a_table_that_has_not_run_is_not_started_with);
  RUN_TEST(nothing_is_confirmed_that_was_not_staged);
  RUN_TEST(a_counter_never_goes_back);
  RUN_TEST(a_counter_that_cannot_be_read_is_not_taken_for_none);
  return UNITY_END();
}
