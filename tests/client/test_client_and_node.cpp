#include <memory>

#include "flexcomp/client.h"
#include "node/node_on_a_bus.hpp"

/// The C client and a whole node on a bus in memory: on a host, and both on a Cortex-M7.
namespace {

using flexcomp::CanFrame;
using flexcomp::FrameList;
using flexcomp::Message;
using flexcomp::test::kTurn;
using flexcomp::test::usual_config;
using flexcomp::test::usual_table;
using Angles = std::array<double, 6>;

constexpr double kPeriod = 0.004;
constexpr double kHold = 0.05;
constexpr double kFade = 0.5;

/// A controller in C, its robot, and the node; a period at a time.
class Loop {
 public:
  explicit Loop(bool fd) : link_(fd, 3) {
    const flexcomp_client_config_t config = {
        fd, usual_config().compensator.model_hash, {kPeriod, kHold, kFade}};
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_client_init(&client, &config));
    start_node();
  }

  /// Begins anew with a table, as after a power failure.
  void start_node() {
    node_ = std::make_unique<flexcomp::Node>();
    first_.assign(1 << 14, 0);
    second_.assign(1 << 14, 0);
    node_->use_memory({first_.data(), first_.size()}, {second_.data(), second_.size()});
    TEST_ASSERT_EQUAL(flexcomp::Result::ok, node_->configure(usual_config()));
    std::copy(usual_table().begin(), usual_table().end(), first_.begin());
    flexcomp::Table table;
    TEST_ASSERT_EQUAL(flexcomp::Result::ok,
                      flexcomp::Table::open(first_.data(), 4 * usual_table().size(), &table));
    TEST_ASSERT_EQUAL(flexcomp::Result::ok, node_->start_with(0, table));
  }

  /// One period. `hears`: the node's frames reach the controller.
  void period(bool hears = true) {
    now_ += static_cast<std::int64_t>(1e9 * kPeriod);
    if (periods_++ % 50 == 0) {
      flexcomp_client_identity(&client, &frames_);
      to_node();
    }
    const double noise = 3 * std::sin(1000 * phase_);  // the sensor's, without chance
    const Angles wrench = {440 + noise, 1370 - noise, 635, 0, 3, 10.5};
    flexcomp_client_wrench(&client, wrench.data(), false, now_, &frames_);
    to_node();
    phase_ += kTurn / 3000;
    Eigen::Map<flexcomp::JointVector<double, 6>>(setpoint_.data()) =
        flexcomp::test::loop_angles<double>(phase_);
    flexcomp_client_setpoint(&client, setpoint_.data(), now_, &frames_);
    to_node();
    node_->set_link(link_.state());
    to_client(node_->tick(now_), hears);
    Message message;
    while (node_->next_message(&message)) {
      to_client(message, hears);
    }
    Angles drives{};
    TEST_ASSERT_EQUAL(FLEXCOMP_OK,
                      flexcomp_client_end_period(&client, setpoint_.data(), drives.data()));
    follow(drives);
  }

  void run(int periods, bool hears = true) {
    for (int i = 0; i < periods; ++i) {
      period(hears);
    }
  }

  /// The reply to a command, which comes within the next period.
  std::uint8_t command(flexcomp_command_t wanted) {
    flexcomp_client_command(&client, wanted, &frames_);
    to_node();
    period();
    flexcomp_command_reply_t reply;
    flexcomp_client_reply(&client, &reply);
    TEST_ASSERT_EQUAL(wanted, reply.command);
    return reply.reply;
  }

  void bring_up() {
    run(20);
    TEST_ASSERT_EQUAL(0, command(FLEXCOMP_COMMAND_ARM));
    run(60);
    flexcomp_answer_t answer;
    flexcomp_client_answer(&client, &answer);
    TEST_ASSERT_EQUAL(FLEXCOMP_STATE_ACTIVE, answer.state);
    TEST_ASSERT_TRUE(largest() > 1e-4);
  }

  double largest() const {
    double most = 0;
    for (const double value : moved_) {
      most = std::max(most, std::fabs(value));
    }
    return most;
  }

  flexcomp_client_t client;

 private:
  void to_node() {
    for (std::size_t i = 0; i < frames_.count; ++i) {
      const flexcomp_can_frame_t& from = frames_.frame[i];
      CanFrame frame{from.id, from.size, from.fd, {}};
      std::copy_n(from.data, from.size, frame.data.begin());
      link_.receive(frame, node_.get(), now_);
    }
  }

  void to_client(const Message& message, bool hears) {
    const FrameList list = link_.encode(message);
    for (std::size_t i = 0; hears && i < list.count; ++i) {
      const CanFrame& from = list.frames[i];
      flexcomp_can_frame_t frame = {from.id, from.size, from.fd, {}};
      std::copy(from.data.begin(), from.data.end(), frame.data);
      flexcomp_client_receive(&client, &frame, now_);
    }
  }

  /// The robot: what it is moved by never jumps by more than the node's limit or the fade.
  void follow(const Angles& drives) {
    const double rate = static_cast<double>(usual_config().compensator.limits[0].rate);
    const double largest_step = kPeriod * std::max(rate, 0.01 / kFade) + 1e-6;
    for (std::size_t i = 0; i < 6; ++i) {
      const double moved = drives[i] - setpoint_[i];
      TEST_ASSERT_DOUBLE_WITHIN(largest_step, moved_[i], moved);
      moved_[i] = moved;
    }
  }

  std::unique_ptr<flexcomp::Node> node_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> second_;
  flexcomp::CanLink link_;
  flexcomp_frames_t frames_{};
  std::int64_t now_ = 1'000'000'000;
  int periods_ = 0;
  double phase_ = 0;
  Angles setpoint_{};
  Angles moved_{};
};

void it_arms_follows_and_is_let_go(bool fd) {
  Loop loop(fd);
  loop.bring_up();
  TEST_ASSERT_EQUAL(0, loop.command(FLEXCOMP_COMMAND_DISARM));
  loop.run(100);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, loop.largest());
  TEST_ASSERT_FALSE(flexcomp_client_is_lost(&loop.client));
}

void on_classic_can_it_arms_follows_and_is_let_go() { it_arms_follows_and_is_let_go(false); }
void on_fd_it_arms_follows_and_is_let_go() { it_arms_follows_and_is_let_go(true); }

void when_the_nodes_frames_cease_it_fades_and_takes_none_until_armed_again() {
  Loop loop(false);
  loop.bring_up();
  loop.run(200, false);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, loop.largest());
  loop.run(50);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, loop.largest());
  TEST_ASSERT_TRUE(flexcomp_client_is_lost(&loop.client));
  TEST_ASSERT_EQUAL(0, loop.command(FLEXCOMP_COMMAND_DISARM));
  loop.run(100);
  TEST_ASSERT_FALSE(flexcomp_client_is_lost(&loop.client));
  loop.bring_up();
}

void a_node_that_starts_anew_is_faded_out_and_armed_again() {
  Loop loop(false);
  loop.bring_up();
  loop.start_node();
  loop.run(200);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, loop.largest());
  loop.bring_up();
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(on_classic_can_it_arms_follows_and_is_let_go);
  RUN_TEST(on_fd_it_arms_follows_and_is_let_go);
  RUN_TEST(when_the_nodes_frames_cease_it_fades_and_takes_none_until_armed_again);
  RUN_TEST(a_node_that_starts_anew_is_faded_out_and_armed_again);
  return UNITY_END();
}
