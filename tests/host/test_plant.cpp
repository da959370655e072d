// How the plant has a compensator armed, against one that answers by a script.
#include <deque>

#include "flexcomp/compensator.hpp"
#include "host/milled_loop.hpp"
#include "simulation/plant.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::simulation;
using flexcomp::test::kr270;
using flexcomp::test::loop_path;

namespace {

/// Where it is commanded to be, without a force.
class StiffRobot : public RobotInCut {
 public:
  State stand(const JointVector<double, 6>& /*q_motor*/, const Contour::Point& point,
              double /*load*/) override {
    return {point.position, Wrench<double>::Zero(), 1};
  }
};

/// Answers every setpoint with itself, and requests to be armed with what is set, in turn; then
/// with yes, and is active 100 setpoints later.
class ScriptedCompensator : public PlantBus {
 public:
  explicit ScriptedCompensator(State before, std::deque<Result> refusals)
      : state_(before), refusals_(std::move(refusals)) {}

  void send(const Message& message) override {
    if (const auto* setpoint = std::get_if<SetpointMessage>(&message)) {
      if (state_ == State::fading_in && setpoints_ >= asked_after.back() + 100) {
        state_ = State::active;
      }
      CorrectedMessage corrected;
      corrected.timestamp = setpoint->timestamp;
      corrected.corrected = setpoint->q;
      corrected.uncorrected = setpoint->q;
      corrected.state = static_cast<std::uint8_t>(state_);
      answers_.emplace_back(corrected);
      ++setpoints_;
    } else if (const auto* command = std::get_if<CommandMessage>(&message)) {
      answer(command->command);
    }
  }

  bool receive(Message* message, std::int64_t /*patience*/) override {
    if (answers_.empty()) {
      return false;
    }
    *message = answers_.front();
    answers_.pop_front();
    return true;
  }

  /// Setpoints that had come by each request to be armed.
  std::deque<int> asked_after;

 private:
  void answer(Command command) {
    if (command != Command::arm) {
      return;
    }
    asked_after.push_back(setpoints_);
    Result result = Result::ok;
    if (refusals_.empty()) {
      state_ = State::fading_in;
    } else {
      result = refusals_.front();
      refusals_.pop_front();
    }
    answers_.emplace_back(CommandReplyMessage{command, static_cast<std::uint8_t>(result), 1});
  }

  State state_;
  std::deque<Result> refusals_;
  std::deque<Message> answers_;
  int setpoints_ = 0;
};

PlantRun run(ScriptedCompensator* compensator) {
  const RobotModel<double, 6> model = kr270<double>();
  PlantOptions options;
  options.lockstep = true;
  options.period = 0.01;
  Plant plant(std::make_unique<StiffRobot>(), Contour(model, loop_path(), MaterialSide::outside),
              options, compensator);
  return plant.run([](double) {});
}

void a_compensator_that_is_not_ready_is_asked_again_after_more_good_setpoints() {
  ScriptedCompensator compensator(State::off, {Result::not_ready, Result::not_ready});
  TEST_ASSERT_TRUE(run(&compensator).armed);
  TEST_ASSERT_EQUAL(3, compensator.asked_after.size());
  TEST_ASSERT_EQUAL(30, compensator.asked_after[0]);  // 0.3 s
  TEST_ASSERT_EQUAL(60, compensator.asked_after[1]);
  TEST_ASSERT_EQUAL(90, compensator.asked_after[2]);
}

void one_that_never_becomes_ready_is_given_up() {
  ScriptedCompensator compensator(State::off, std::deque<Result>(1000, Result::not_ready));
  const PlantRun result = run(&compensator);
  TEST_ASSERT_FALSE(result.armed);
  TEST_ASSERT_EQUAL(static_cast<std::uint8_t>(Result::not_ready), result.arm_reply);
  TEST_ASSERT_EQUAL(530, result.ticks);  // 0.3 s before, and 5 s
}

void one_that_becomes_ready_late_has_its_time_to_fade_in() {
  ScriptedCompensator compensator(State::off, std::deque<Result>(16, Result::not_ready));
  TEST_ASSERT_TRUE(run(&compensator).armed);
  TEST_ASSERT_EQUAL(510, compensator.asked_after.back());  // a second is longer than what is left
}

void any_other_refusal_is_final() {
  ScriptedCompensator without_table(State::off, {Result::no_table});
  TEST_ASSERT_FALSE(run(&without_table).armed);
  TEST_ASSERT_EQUAL(1, without_table.asked_after.size());
  ScriptedCompensator latched(State::latched, {Result::not_ready});
  TEST_ASSERT_FALSE(run(&latched).armed);
  TEST_ASSERT_EQUAL(1, latched.asked_after.size());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_compensator_that_is_not_ready_is_asked_again_after_more_good_setpoints);
  RUN_TEST(one_that_never_becomes_ready_is_given_up);
  RUN_TEST(one_that_becomes_ready_late_has_its_time_to_fade_in);
  RUN_TEST(any_other_refusal_is_final);
  return UNITY_END();
}
