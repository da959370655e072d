#include "node/table_trial.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

CorrectedMessage tick_in(State state, std::uint32_t status = 0, std::uint16_t node_status = 0) {
  CorrectedMessage tick;
  tick.state = static_cast<std::uint8_t>(state);
  tick.status = status;
  tick.node_status = node_status;
  return tick;
}

void run(TableTrial* trial, std::uint32_t ticks, const CorrectedMessage& tick) {
  for (std::uint32_t i = 0; i < ticks; ++i) {
    trial->observe(tick);
  }
}

void a_table_has_run_after_so_many_active_ticks_in_a_row() {
  TableTrial trial;
  run(&trial, TableTrial::kTicks - 1, tick_in(State::active, kRateLimited, kSomeLost));
  TEST_ASSERT_FALSE(trial.has_run());
  run(&trial, 1, tick_in(State::active));
  TEST_ASSERT_TRUE(trial.has_run());
  run(&trial, 1, tick_in(State::latched, kNotComputable));
  TEST_ASSERT_TRUE(trial.has_run());
  trial.begin();
  TEST_ASSERT_FALSE(trial.has_run());
}

void no_other_state_and_no_fault_counts() {
  const CorrectedMessage others[] = {tick_in(State::off),
                                     tick_in(State::fading_in),
                                     tick_in(State::holding),
                                     tick_in(State::fading_out),
                                     tick_in(State::latched),
                                     tick_in(State::active, kOutsideChart),
                                     tick_in(State::active, 0, kTableDamaged)};
  for (const CorrectedMessage& other : others) {
    TableTrial trial;
    run(&trial, 2 * TableTrial::kTicks, other);
    TEST_ASSERT_FALSE(trial.has_run());
    run(&trial, TableTrial::kTicks - 1, tick_in(State::active));
    trial.observe(other);
    run(&trial, TableTrial::kTicks - 1, tick_in(State::active));
    TEST_ASSERT_FALSE(trial.has_run());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_table_has_run_after_so_many_active_ticks_in_a_row);
  RUN_TEST(no_other_state_and_no_fault_counts);
  return UNITY_END();
}
