// The memory of a table changes while it is in use, as a bit that turns over in RAM does.
#include <memory>
#include <random>
#include <vector>

#include "cases.hpp"
#include "core/test_robots.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/flexcomp.h"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::loop_angles;

namespace {

using Core = Compensator<float, 6>;
using Words = std::vector<std::uint32_t>;  // no more than the table: a sanitizer sees its end

constexpr double kTurn = 6.28318530717958647692;
constexpr std::size_t kHeaderBits = 8 * sizeof(TableHeader);
constexpr std::size_t kRecordBits = test::cases(1500);      // a sample
constexpr std::size_t kOneIn = FLEXCOMP_FEW_CASES ? 3 : 1;  // bits of the header
constexpr int kTicks = 12;
constexpr float kTolerance = FLEXCOMP_FEW_CASES ? 1e-4F : 2e-5F;  // m, rad: 256 or 1296 nodes
const TableRequirements<float> kWanted = {2000, 50, kTolerance, kTolerance, 0};

Words of_size(const Words& words, std::size_t size) {
  return {words.begin(), words.begin() + static_cast<std::ptrdiff_t>(size / 4)};
}

Words path_table() {
  std::vector<JointVector<float, 6>> program;
  for (int i = 0; i <= 60; ++i) {
    program.push_back(loop_angles<float>(kTurn * (i % 60) / 60));
  }
  Words words(1 << 15);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_path_table<float, 6>(kr270<float>(), program.data(), program.size(),
                                                kWanted, words.data(), 4 * words.size(), &size)));
  return of_size(words, size);
}

Words grid_table() {
  const GridRange<float> ranges[4] = {{-1.3F, -1.1F}, {1.2F, 1.4F}, {0.2F, 0.4F}, {0.7F, 0.9F}};
  Words words(1 << 16);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_grid_table<float, 6>(kr270<float>(), ranges, kWanted, words.data(),
                                                4 * words.size(), &size)));
  return of_size(words, size);
}

Table open(const Words& words) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  return table;
}

Core::Input input_at(int tick) {
  Core::Input input;
  input.setpoint = loop_angles<float>(kTurn * tick / 20000);
  input.setpoint_age = 0.001F;
  input.wrench << 440, 1370, 635, 0, 3, 10.5F;
  input.wrench_age = 0.002F;
  return input;
}

/// Ticks, and sees to it that all outputs are finite and within the limits.
class Watched {
 public:
  explicit Watched(const Core& core, int now) : core_(core), now_(now) { before_ = last_ = tick(); }

  void run() {
    const auto& config = flexcomp::test::compensator_config();
    const float step = config.limits[0].rate * config.period * (1 + 1e-5F);
    const float change = config.limits[0].acceleration * config.period * config.period * 1.0001F;
    for (int i = 0; i < kTicks; ++i) {
      const JointVector<float, 6> next = tick();
      TEST_ASSERT_TRUE(next.cwiseAbs().maxCoeff() <= config.limits[0].value);
      TEST_ASSERT_TRUE((next - last_).cwiseAbs().maxCoeff() <= step);
      TEST_ASSERT_TRUE(i == 0 || (next - 2 * last_ + before_).cwiseAbs().maxCoeff() <= change);
      before_ = last_;
      last_ = next;
    }
  }

  Core* core() { return &core_; }

 private:
  JointVector<float, 6> tick() {
    const Core::Output output = core_.tick(input_at(now_++));
    TEST_ASSERT_TRUE(output.setpoint.allFinite() && output.correction.allFinite() &&
                     output.deflection.allFinite());
    return output.correction;
  }

  Core core_;
  int now_;
  JointVector<float, 6> last_;
  JointVector<float, 6> before_;
};

/// Turns over the bits of the header, all or one in three, and a sample of those after it, one at a
/// time.
template <typename Check>
void with_bits_turned_over(Words* words, Check check) {
  std::mt19937 random(5);
  for (std::size_t i = 0; i < kHeaderBits + kRecordBits; i += i < kHeaderBits ? kOneIn : 1) {
    const std::size_t bit = i < kHeaderBits ? i : random() % (32 * words->size());
    (*words)[bit / 32] ^= 1U << (bit % 32);
    check();
    (*words)[bit / 32] ^= 1U << (bit % 32);
  }
}

void check(Words words) {
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(flexcomp::test::compensator_config()));
  const Table table = open(words);
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(table));
  int now = 0;
  for (; now < 20; ++now) {
    core.tick(input_at(now));
  }
  TEST_ASSERT_EQUAL(Result::ok, core.arm());
  for (; now < 400; ++now) {
    core.tick(input_at(now));
  }
  TEST_ASSERT_TRUE(core.state() == State::active);
  with_bits_turned_over(&words, [&] {
    Watched correcting(core, now);
    correcting.run();
    static_cast<void>(correcting.core()->set_table(table));  // looks at every node
    correcting.run();
  });
}

void a_bit_of_a_path_table_in_use_that_turns_over_breaks_no_limit() { check(path_table()); }

void a_bit_of_a_grid_table_in_use_that_turns_over_breaks_no_limit() { check(grid_table()); }

/// As the C interface has it: between opening and using it a table may have changed.
void a_table_that_changed_since_it_was_opened_is_refused_or_harmless() {
  Words words = path_table();
  flexcomp_table_t view;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(words.data(), 4 * words.size(), &view));
  int refused = 0;
  with_bits_turned_over(&words, [&] {
    flexcomp_table_info_t info;
    const flexcomp_result_t described = flexcomp_table_describe(&view, &info);
    TEST_ASSERT_TRUE(described == FLEXCOMP_OK || described == FLEXCOMP_TABLE_CORRUPT);
    refused += described == FLEXCOMP_OK ? 0 : 1;
    auto core = std::make_unique<Core>();
    TEST_ASSERT_EQUAL(Result::ok, core->configure(flexcomp::test::compensator_config()));
    Table table;
    const Result opened = Table::reopen(words.data(), 4 * words.size(), &table);
    TEST_ASSERT_EQUAL(static_cast<int>(described), static_cast<int>(opened));
    if (opened == Result::ok) {
      static_cast<void>(core->set_table(table));
      Watched(*core, 0).run();
    }
  });
  TEST_ASSERT_GREATER_THAN(100 / static_cast<int>(kOneIn),
                           refused);  // sizes, counts, and what they follow from
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_bit_of_a_path_table_in_use_that_turns_over_breaks_no_limit);
  RUN_TEST(a_bit_of_a_grid_table_in_use_that_turns_over_breaks_no_limit);
  RUN_TEST(a_table_that_changed_since_it_was_opened_is_refused_or_harmless);
  return UNITY_END();
}
