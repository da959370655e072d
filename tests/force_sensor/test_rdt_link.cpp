#include <random>
#include <string>

#include "force_sensor/rdt_link.hpp"
#include "node/node_on_a_bus.hpp"

using namespace flexcomp;
using flexcomp::test::loop_angles;
using flexcomp::test::usual_config;

namespace {

constexpr std::int64_t kPeriod = 4'000'000;
constexpr std::int64_t kSilence = 500'000'000;

void append(std::string* datagram, std::uint32_t number) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    datagram->push_back(static_cast<char>(number >> shift & 0xFFU));
  }
}

/// A sensor, a link, and a node that stands still, every joint at zero and the TCP at the flange.
class Bench {
 public:
  Bench() {
    TEST_ASSERT_EQUAL(Result::ok, node.configure(usual_config()));
    node.receive(SetpointMessage{kNoTime, {}}, Source::lcm, now);
  }

  static RdtConfig config() {
    RdtConfig config;
    config.counts_per_newton = 1000;
    config.counts_per_newton_metre = 10000;
    return config;
  }

  /// The next record of the stream, with this force along x in N.
  std::string record(double force, std::uint32_t status = 0) {
    std::string datagram;
    append(&datagram, sequence);
    append(&datagram, 7 * sequence);
    append(&datagram, status);
    append(&datagram, static_cast<std::uint32_t>(static_cast<std::int32_t>(1000 * force)));
    for (int i = 0; i < 5; ++i) {
      append(&datagram, 0);
    }
    ++sequence;
    return datagram;
  }

  void send(double force, std::uint32_t status = 0) { link.receive(record(force, status), now); }

  /// What the node was given in a tick.
  std::uint32_t ticked() {
    const std::uint32_t before = given();
    link.hand_over(&node, now);
    now += kPeriod;
    return given() - before;
  }

  LinkState state() const {
    LinkState all;
    link.add_to(&all);
    return all;
  }

  Node node;
  RdtLink link{config()};
  std::uint32_t sequence = 1;
  std::int64_t now = kPeriod;

 private:
  /// A wrench of another source is refused while one has been given lately.
  std::uint32_t given() {
    Node copy = node;
    return copy.receive(WrenchMessage{kNoTime, {}, false}, Source::lcm, now) ? 0 : 1;
  }
};

void a_tick_gets_the_newest_record_once() {
  Bench bench;
  TEST_ASSERT_EQUAL(0, bench.ticked());
  bench.send(1);
  bench.send(2);
  TEST_ASSERT_EQUAL(1, bench.ticked());
  TEST_ASSERT_EQUAL(2, bench.state().wrench.received);
  TEST_ASSERT_EQUAL(0, bench.state().wrench.lost);
  std::uint32_t since = 1;
  for (int i = 0; i < 14; ++i) {  // longer than one source keeps another away
    since = bench.ticked();
  }
  TEST_ASSERT_EQUAL(0, since);
}

void without_a_setpoint_there_is_no_wrench() {
  RdtLink link{Bench::config()};
  Node node;
  TEST_ASSERT_EQUAL(Result::ok, node.configure(usual_config()));
  Bench other;
  link.receive(other.record(1), kPeriod);
  link.hand_over(&node, kPeriod);
  TEST_ASSERT_TRUE(node.receive(WrenchMessage{}, Source::lcm, kPeriod));
}

void records_that_are_lost_are_counted() {
  Bench bench;
  bench.send(1);
  bench.sequence += 3;
  bench.send(2);
  TEST_ASSERT_EQUAL(2, bench.state().wrench.received);
  TEST_ASSERT_EQUAL(3, bench.state().wrench.lost);
}

void one_that_is_overtaken_is_not_used() {
  Bench bench;
  bench.send(1);
  const std::string late = bench.record(2);
  bench.send(3);
  TEST_ASSERT_EQUAL(1, bench.ticked());
  bench.now += kPeriod;
  bench.link.receive(late, bench.now);
  TEST_ASSERT_EQUAL(1, bench.state().wrench.old);
}

void a_record_with_a_fault_is_none() {
  Bench bench;
  bench.send(1, 0x80000000U);
  TEST_ASSERT_EQUAL(0, bench.ticked());
  TEST_ASSERT_EQUAL(1, bench.state().wrench.corrupt);
  TEST_ASSERT_EQUAL(0, bench.state().wrench.received);
}

void what_is_no_record_is_counted_and_no_more() {
  Bench bench;
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 64; ++size) {
    std::string datagram(size, '\0');
    for (char& c : datagram) {
      c = static_cast<char>(random());
    }
    bench.link.receive(size == 36 ? "" : datagram, bench.now);
  }
  TEST_ASSERT_EQUAL(64, bench.state().wrench.corrupt);
  TEST_ASSERT_EQUAL(0, bench.ticked());
}

void a_sensor_that_starts_anew_is_followed() {
  Bench bench;
  bench.sequence = 100000;
  bench.send(1);
  bench.sequence = 1;
  bench.now += kSilence;
  bench.send(2);
  TEST_ASSERT_EQUAL(2, bench.state().wrench.received);
  TEST_ASSERT_EQUAL(1, bench.ticked());
}

void a_silent_sensor_is_asked_twice_a_second() {
  Bench bench;
  int asked = 0;
  for (int i = 0; i < 500; ++i) {  // two seconds
    asked += bench.link.wants_request(bench.now) ? 1 : 0;
    bench.now += kPeriod;
  }
  TEST_ASSERT_EQUAL(4, asked);
  for (int i = 0; i < 500; ++i) {
    bench.send(1);
    TEST_ASSERT_FALSE(bench.link.wants_request(bench.now));
    bench.now += kPeriod;
  }
  bench.now += kSilence;
  TEST_ASSERT_TRUE(bench.link.wants_request(bench.now));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_tick_gets_the_newest_record_once);
  RUN_TEST(without_a_setpoint_there_is_no_wrench);
  RUN_TEST(records_that_are_lost_are_counted);
  RUN_TEST(one_that_is_overtaken_is_not_used);
  RUN_TEST(a_record_with_a_fault_is_none);
  RUN_TEST(what_is_no_record_is_counted_and_no_more);
  RUN_TEST(a_sensor_that_starts_anew_is_followed);
  RUN_TEST(a_silent_sensor_is_asked_twice_a_second);
  return UNITY_END();
}
