#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "hil/faults/fault.hpp"

/// Ways to disturb the two streams of messages that a node lives on. An injection that draws or
/// remembers keeps that to itself: a new one begins anew.
namespace flexcomp::test {

enum class Stream { setpoint, wrench };

constexpr int kAll = 1 << 30;  ///< messages

/// Frames of one message to be put on the bus, or not, or changed.
using ChangeOfFrames = std::function<void(NodeOnABus*, const FrameList&, int tick)>;
using ChangeOfSetpoint = std::function<SetpointMessage(SetpointMessage, int tick)>;
using ChangeOfWrench = std::function<WrenchMessage(WrenchMessage, int tick)>;

inline SetpointMessage moved(SetpointMessage message, double angle) {
  for (double& q : message.q) {
    q += angle;
  }
  return message;
}

inline WrenchMessage scaled(WrenchMessage message, double factor) {
  for (double& component : message.wrench) {
    component *= factor;
  }
  return message;
}

/// Chance that is the same in every run.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  double within(double largest) { return largest * (2.0 * bits() / 4294967295.0 - 1); }

 private:
  std::mt19937 engine_;
};

/// The frames of one stream go through `change`; those of the other through as they are.
inline Injection on_frames(Stream stream, ChangeOfFrames change) {
  return [stream, change = std::move(change)](NodeOnABus* bus, int tick) {
    const FrameList wrench = bus->encode(bus->next_wrench());
    const FrameList setpoint = bus->encode(bus->next_setpoint());
    if (stream == Stream::setpoint) {
      bus->put(wrench);
      change(bus, setpoint, tick);
    } else {
      change(bus, wrench, tick);
      bus->put(setpoint);
    }
    return bus->tick();
  };
}

inline Injection on_setpoints(ChangeOfSetpoint change) {
  return [change = std::move(change)](NodeOnABus* bus, int tick) {
    bus->send(bus->next_wrench());
    bus->send(change(bus->next_setpoint(), tick));
    return bus->tick();
  };
}

inline Injection on_wrenches(ChangeOfWrench change) {
  return [change = std::move(change)](NodeOnABus* bus, int tick) {
    bus->send(change(bus->next_wrench(), tick));
    bus->send(bus->next_setpoint());
    return bus->tick();
  };
}

inline Injection losing_every_fourth(Stream stream) {
  return on_frames(stream, [](NodeOnABus* bus, const FrameList& frames, int tick) {
    if (tick % 4 != 0) {
      bus->put(frames);
    }
  });
}

inline Injection losing_a_third_at_random(Stream stream) {
  return on_frames(stream, [dice = Dice(7)](NodeOnABus* bus, const FrameList& frames, int) mutable {
    if (dice.bits() % 3 != 0) {
      bus->put(frames);
    }
  });
}

inline Injection sending_twice(Stream stream) {
  return on_frames(stream, [](NodeOnABus* bus, const FrameList& frames, int) {
    bus->put(frames);
    bus->put(frames);
  });
}

inline Injection sending_every_fourth_after_the_next(Stream stream) {
  return on_frames(
      stream, [kept = FrameList()](NodeOnABus* bus, const FrameList& frames, int tick) mutable {
        if (tick % 4 == 0) {
          kept = frames;
          return;
        }
        bus->put(frames);
        if (tick % 4 == 1) {
          bus->put(kept);
        }
      });
}

inline Injection sending_none(Stream stream) {
  return on_frames(stream, [](NodeOnABus*, const FrameList&, int) {});
}

/// The others are never sent, and so not lost either: the counter in them goes on from message to
/// message.
inline Injection sending_one_in_eight_ticks(Stream stream) {
  return [stream](NodeOnABus* bus, int tick) {
    const bool sends = tick % 8 == 0;
    if (sends || stream != Stream::wrench) {
      bus->send(bus->next_wrench());
    }
    if (sends || stream != Stream::setpoint) {
      bus->send(bus->next_setpoint());
    }
    return bus->tick();
  };
}

inline Injection sending_100_ms_later(Stream stream) {
  return on_frames(stream, [queue = std::vector<FrameList>()](
                               NodeOnABus* bus, const FrameList& frames, int tick) mutable {
    queue.push_back(frames);
    if (tick >= 25) {
      bus->put(queue[static_cast<std::size_t>(tick - 25)]);
    }
  });
}

inline Injection sending_1_ms_later_every_tick(Stream stream) {
  return [stream](NodeOnABus* bus, int tick) {
    const std::int64_t late = 1'000'000LL * tick;
    SetpointMessage setpoint = bus->next_setpoint();
    WrenchMessage wrench = bus->next_wrench();
    (stream == Stream::setpoint ? setpoint.timestamp : wrench.timestamp) -= late;
    bus->send(wrench);
    bus->send(setpoint);
    return bus->tick();
  };
}

/// All components of the first `count` messages.
inline Injection not_available(Stream stream, int count) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (stream == Stream::setpoint) {
    return on_setpoints([count](const SetpointMessage& message, int tick) {
      return tick < count ? moved(message, kNan) : message;
    });
  }
  return on_wrenches([count](const WrenchMessage& message, int tick) {
    return tick < count ? scaled(message, kNan) : message;
  });
}

/// One component of every message.
inline Injection with_a(double value, Stream stream) {
  return [value, stream](NodeOnABus* bus, int) {
    SetpointMessage setpoint = bus->next_setpoint();
    WrenchMessage wrench = bus->next_wrench();
    (stream == Stream::setpoint ? setpoint.q[2] : wrench.wrench[1]) = value;
    bus->send(wrench);
    bus->send(setpoint);
    return bus->tick();
  };
}

inline Injection random_bits(Stream stream) {
  return on_frames(stream, [dice = Dice(11)](NodeOnABus* bus, FrameList frames, int) mutable {
    for (std::size_t i = 0; i < frames.count; ++i) {
      for (std::size_t k = 0; k < 8; ++k) {
        frames.frames[i].data[k] ^= static_cast<std::uint8_t>(dice.bits() | 1U);
      }
    }
    bus->put(frames);
  });
}

inline Injection without_the_last_frame(Stream stream) {
  return on_frames(stream, [](NodeOnABus* bus, FrameList frames, int) {
    --frames.count;
    bus->put(frames);
  });
}

/// A second sender, whose values differ a little.
inline Injection two_senders(Stream stream) {
  return [stream, other = CanEncoder()](NodeOnABus* bus, int tick) mutable {
    const Message message = stream == Stream::setpoint ? Message(moved(bus->next_setpoint(), 1e-3))
                                                       : Message(scaled(bus->next_wrench(), 0.9));
    const FrameList second = other.encode(message);
    return on_frames(stream, [&second](NodeOnABus* to, const FrameList& frames, int) {
      to->put(frames);
      to->put(second);
    })(bus, tick);
  };
}

inline Injection standing_still() {
  return on_setpoints(
      [first = std::optional<SetpointMessage>()](const SetpointMessage& message, int) mutable {
        first = first.value_or(message);
        return *first;
      });
}

inline Injection repeating_the_first_wrench() {
  return on_wrenches(
      [first = std::optional<WrenchMessage>()](const WrenchMessage& message, int) mutable {
        first = first.value_or(message);
        return *first;
      });
}

inline Injection random_angles() {
  return on_setpoints([dice = Dice(3)](SetpointMessage message, int) mutable {
    for (double& q : message.q) {
      q = dice.within(6.7);
    }
    return message;
  });
}

inline Injection random_wrenches() {
  return on_wrenches([dice = Dice(5)](WrenchMessage message, int) mutable {
    for (double& component : message.wrench) {
      component = dice.within(6000);
    }
    return message;
  });
}

inline Injection in_degrees() {
  return on_setpoints([](SetpointMessage message, int) {
    for (double& q : message.q) {
      q *= 180 / 3.14159265358979;
    }
    return message;
  });
}

/// All joints by an angle, in rad.
inline Injection off_by(double angle) {
  return on_setpoints(
      [angle](const SetpointMessage& message, int) { return moved(message, angle); });
}

/// The second joint goes away from the program by `step` in each of the first ticks.
inline Injection leaving_by(double step, int ticks) {
  return on_setpoints([step, ticks](SetpointMessage message, int tick) {
    message.q[1] += std::min(tick, ticks) * step;
    return message;
  });
}

inline Injection times(double factor) {
  return on_wrenches(
      [factor](const WrenchMessage& message, int) { return scaled(message, factor); });
}

/// The wrench grows by `step` of itself in each of the first ticks.
inline Injection growing_by(double step, int ticks) {
  return on_wrenches([step, ticks](const WrenchMessage& message, int tick) {
    return scaled(message, 1 + step * std::min(tick, ticks));
  });
}

inline Injection in_and_out_of_the_cut() {
  return on_wrenches([](const WrenchMessage& message, int tick) {
    return scaled(message, tick % 20 < 10 ? 0.1 : 1);
  });
}

/// The sensor says so of the first `count` samples.
inline Injection saturated(int count) {
  return on_wrenches([count](WrenchMessage message, int tick) {
    message.saturated = tick < count;
    return message;
  });
}

/// The fifth component is a number that a processor may take for zero.
inline Injection with_a_denormal_moment() {
  return on_wrenches([](WrenchMessage message, int) {
    message.wrench[4] = 1e-40;
    return message;
  });
}

/// Nothing is wrong with the streams; `before` is done ahead of each tick.
inline Injection machining(std::function<void(NodeOnABus*, int tick)> before) {
  return [before = std::move(before)](NodeOnABus* bus, int tick) {
    before(bus, tick);
    return bus->machine();
  };
}

/// Nothing is wrong with the streams; `period(tick)` in ns passes until each tick.
inline Injection ticking_after(std::function<std::int64_t(int tick)> period) {
  return [period = std::move(period)](NodeOnABus* bus, int tick) {
    bus->send(bus->next_wrench());
    bus->send(bus->next_setpoint());
    return bus->tick(period(tick));
  };
}

}  // namespace flexcomp::test
