// A second sender of setpoints or wrenches is found, whatever its format, transport and rate; and
// one sender is never taken for two.
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>

#include "node/lcm_receiver.hpp"
#include "node/node_on_a_bus.hpp"

using namespace flexcomp;
using namespace flexcomp::test;

namespace {

constexpr Source kSources[] = {Source::can_classic, Source::can_fd, Source::lcm};
constexpr std::uint64_t kSuspects = 32;  // messages of a second sender, by which it is found

/// A node that hears CAN and LCM, as flexcompd's loop does.
class Bench {
 public:
  void put(const FrameList& list) {
    for (std::size_t i = 0; i < list.count; ++i) {
      bus_.put(list.frames[i]);
    }
  }

  void put(const Message& message, std::uint32_t sequence) {
    lcm_.receive(message, sequence, &bus_.node, bus_.now);
  }

  void tick() {
    bus_.now += 4'000'000;
    if (bus_.node.take_reset()) {
      bus_.link.forget_conflicts();
      lcm_.forget_conflicts();
    }
    LinkState state = bus_.link.state();
    lcm_.add_to(&state);
    bus_.node.set_link(state);
    node_status_ = bus_.node.tick(bus_.now).node_status;
    Message message;
    while (bus_.node.next_message(&message)) {
    }
  }

  bool has(NodeBit bit) const { return (node_status_ & bit) != 0; }
  std::int64_t now() const { return bus_.now; }
  void wait(std::int64_t time) { bus_.now += time; }
  NodeOnABus& bus() { return bus_; }

 private:
  NodeOnABus bus_;
  LcmReceiver lcm_{3};
  std::uint16_t node_status_ = 0;
};

/// One sender of a stream, in a format of its own, with counters of its own.
class Sender {
 public:
  Sender(Source source, bool sends_setpoints, double offset, std::uint32_t first = 0)
      : source_(source),
        encoder_(source == Source::can_fd),
        sends_setpoints_(sends_setpoints),
        offset_(offset),
        sequence_(first) {
    for (std::uint32_t i = 0; i < first % 16; ++i) {
      encoder_.encode(message(0));
    }
  }

  void send(Bench* bench) {
    if (source_ == Source::lcm) {
      bench->put(message(bench->now()), sequence_++);
    } else {
      bench->put(encoder_.encode(message(bench->now())));
    }
    ++sent_;
  }

  /// A message that is on its way: made, and not put.
  void lose() {
    encoder_.encode(message(0));
    ++sequence_;
  }

  std::uint64_t sent() const { return sent_; }

 private:
  Message message(std::int64_t now) const {
    const double place = 1e-9 * static_cast<double>(now) + offset_;
    if (sends_setpoints_) {
      SetpointMessage setpoint{source_ == Source::can_classic ? kNoTime : now, {}};
      const JointVector<double, 6> q = loop_angles<double>(place);
      std::copy_n(q.data(), 6, setpoint.q.begin());
      return setpoint;
    }
    return WrenchMessage{source_ == Source::can_classic ? kNoTime : now,
                         {440 + std::sin(50 * place), 1370, 635, 0, 3, 10.5 + offset_},
                         false};
  }

  Source source_;
  CanEncoder encoder_;
  bool sends_setpoints_;
  double offset_;
  std::uint32_t sequence_;
  std::uint64_t sent_ = 0;
};

struct Pair {
  Source first = Source::can_classic;
  Source second = Source::can_classic;
  bool sends_setpoints = true;
  int first_every = 1;  ///< ticks
  int second_every = 1;
  int phase = 0;                    ///< ticks by which the second begins later
  std::uint32_t second_count = 0;   ///< where its counter begins
  bool second_comes_first = false;  ///< within a tick
};

/// How many messages the second sender sent until it was found; ten thousand ticks are waited.
std::uint64_t sent_until_found(const Pair& pair) {
  Bench bench;
  Sender first(pair.first, pair.sends_setpoints, 0);
  Sender second(pair.second, pair.sends_setpoints, 0.3, pair.second_count);
  const NodeBit bit = pair.sends_setpoints ? kSetpointConflict : kWrenchConflict;
  for (int tick = 0; tick < 10'000 && !bench.has(bit); ++tick) {
    const bool first_sends = tick % pair.first_every == 0;
    const bool second_sends = tick >= pair.phase && (tick - pair.phase) % pair.second_every == 0;
    if (second_sends && pair.second_comes_first) {
      second.send(&bench);
    }
    if (first_sends) {
      first.send(&bench);
    }
    if (second_sends && !pair.second_comes_first) {
      second.send(&bench);
    }
    bench.tick();
  }
  return bench.has(bit) ? second.sent() : UINT64_MAX;
}

void require_found(const Pair& pair) {
  char label[160];
  const std::uint64_t sent = sent_until_found(pair);
  std::snprintf(label, sizeof label,
                "%s: source %d beside %d, every %d and %d ticks, phase %d, counter %u, %s: %llu",
                pair.sends_setpoints ? "setpoints" : "wrenches", static_cast<int>(pair.second),
                static_cast<int>(pair.first), pair.second_every, pair.first_every, pair.phase,
                pair.second_count, pair.second_comes_first ? "first" : "last",
                static_cast<unsigned long long>(sent));
  TEST_ASSERT_TRUE_MESSAGE(sent <= kSuspects, label);
}

void a_second_sender_is_found_in_every_pair_of_formats_at_every_rate() {
  for (const bool sends_setpoints : {true, false}) {
    for (const Source first : kSources) {
      for (const Source second : kSources) {
        for (const int every : {1, 2, 4, 8, 16, 64}) {
          Pair pair;
          pair.first = first;
          pair.second = second;
          pair.sends_setpoints = sends_setpoints;
          pair.second_every = every;
          pair.phase = 30;
          pair.second_count = 5;
          require_found(pair);
        }
      }
    }
  }
}

void a_second_sender_is_found_in_random_pairs() {
  const char* wanted = std::getenv("FLEXCOMP_SENDER_PAIRS");
  const int count = wanted != nullptr ? std::atoi(wanted) : 40;
  std::mt19937 random(20261124);
  const auto draw = [&](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  for (int i = 0; i < count; ++i) {
    Pair pair;
    pair.first = kSources[draw(3)];
    pair.second = kSources[draw(3)];
    pair.sends_setpoints = draw(2) == 0;
    pair.first_every = 1 + draw(3);
    pair.second_every = 1 + draw(80);
    pair.phase = draw(200);
    pair.second_count = static_cast<std::uint32_t>(draw(16));
    pair.second_comes_first = draw(2) == 0;
    require_found(pair);
  }
}

void of_a_second_format_nothing_is_used() {
  for (const Source second : {Source::can_fd, Source::lcm}) {
    Bench bench;
    Sender first(Source::can_classic, true, 0);
    Sender other(second, true, 0.3);
    for (int i = 0; i < 7; ++i) {
      first.send(&bench);
      other.send(&bench);
      bench.tick();
    }
    bool exists = false;
    TEST_ASSERT_EQUAL_UINT64(
        7, bench.bus().node.statistic(static_cast<std::uint8_t>(StatisticName::setpoint_received),
                                      &exists));
    TEST_ASSERT_FALSE(bench.has(kSetpointConflict));  // seven may be chance
  }
}

/// One sender on any bus: the stream is never called that of two.
void require_one(const char* what, Source source,
                 const std::function<void(Bench*, Sender*, int tick)>& behave) {
  for (const bool sends_setpoints : {true, false}) {
    Bench bench;
    Sender sender(source, sends_setpoints, 0);
    for (int tick = 0; tick < 20'000; ++tick) {
      behave(&bench, &sender, tick);
      bench.tick();
      TEST_ASSERT_FALSE_MESSAGE(bench.has(sends_setpoints ? kSetpointConflict : kWrenchConflict),
                                what);
    }
  }
}

void one_sender_is_never_taken_for_two() {
  for (const Source source : kSources) {
    std::mt19937 random(7);
    for (const unsigned percent : {10U, 30U, 50U, 60U}) {
      require_one("losses", source, [&](Bench* bench, Sender* sender, int) {
        random() % 100 < percent ? sender->lose() : sender->send(bench);
      });
    }
    require_one("bursts of losses", source, [&](Bench* bench, Sender* sender, int tick) {
      tick % 50 < 20 ? sender->lose() : sender->send(bench);
    });
    require_one("pauses", source, [&](Bench* bench, Sender* sender, int tick) {
      if (tick % 100 < 60) {
        sender->send(bench);
      }
    });
    require_one("slow", source, [&](Bench* bench, Sender* sender, int tick) {
      if (tick % 5 == 0) {
        sender->send(bench);
      }
    });
    require_one("restarts", source, [&](Bench* bench, Sender* sender, int tick) {
      if (tick % 500 == 499) {
        *sender = Sender(source, true, 0);
      } else if (tick % 500 > 25) {  // a sender takes a tenth of a second to start
        sender->send(bench);
      }
    });
  }
}

void another_format_may_follow_after_a_pause() {
  Bench bench;
  Sender classic(Source::can_classic, true, 0);
  Sender fd(Source::can_fd, true, 0);
  for (int i = 0; i < 200; ++i) {
    (i / 50 % 2 == 0 ? classic : fd).send(&bench);
    bench.tick();
    if (i % 50 == 49) {
      bench.wait(60'000'000);
    }
  }
  TEST_ASSERT_FALSE(bench.has(kSetpointConflict));
}

void a_reset_forgets_the_second_sender() {
  Bench bench;
  Sender first(Source::can_classic, true, 0);
  Sender second(Source::lcm, true, 0.3);
  for (int i = 0; i < 20; ++i) {
    first.send(&bench);
    second.send(&bench);
    bench.tick();
  }
  TEST_ASSERT_TRUE(bench.has(kSetpointConflict));
  bench.bus().send(CommandMessage{Command::reset});
  for (int i = 0; i < 20; ++i) {
    first.send(&bench);
    bench.tick();
  }
  TEST_ASSERT_FALSE(bench.has(kSetpointConflict));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_second_sender_is_found_in_every_pair_of_formats_at_every_rate);
  RUN_TEST(a_second_sender_is_found_in_random_pairs);
  RUN_TEST(of_a_second_format_nothing_is_used);
  RUN_TEST(one_sender_is_never_taken_for_two);
  RUN_TEST(another_format_may_follow_after_a_pause);
  RUN_TEST(a_reset_forgets_the_second_sender);
  return UNITY_END();
}
