#include "node/can_link.hpp"

namespace flexcomp {

StreamCounters operator+(const StreamCounters& a, const StreamCounters& b) {
  return {a.received + b.received,
          a.lost + b.lost,
          a.repeated + b.repeated,
          a.old + b.old,
          a.out_of_sequence + b.out_of_sequence,
          a.contradicting + b.contradicting,
          a.corrupt + b.corrupt,
          a.incomplete + b.incomplete};
}

namespace {

/// Counts both formats of a stream together; one of them is idle as a rule.
[[gnu::always_inline]] inline void add_up(const SequenceMonitor& a, const SequenceMonitor& b,
                                          StreamCounters* sum) {
  if (!b.has_counted()) {
    *sum = a.counters;
  } else if (!a.has_counted()) {
    *sum = b.counters;
  } else {
    *sum = a.counters + b.counters;
  }
}

}  // namespace

bool CanLink::receive(const CanFrame& frame, Node* node, std::int64_t now) {
  const WholeMessage whole = decoder_.take(frame, now);
  // Most frames are a part of a message.
  return whole.payloads != nullptr && deliver(whole, frame.fd, node, now);
}

[[gnu::noinline]] bool CanLink::deliver(const WholeMessage& whole, bool fd, Node* node,
                                        std::int64_t now) {
  // Setpoints and wrenches come every cycle: they go their own way, and are not made a `Message`.
  if (whole.group == kClassicGroup<SetpointMessage>) {
    return node->receive(can::unpack<can::Classic<SetpointMessage>>(whole.payloads),
                         Source::can_classic, now);
  }
  if (whole.group == kClassicGroup<WrenchMessage>) {
    node->receive(can::unpack<can::Classic<WrenchMessage>>(whole.payloads), Source::can_classic,
                  now);
    return false;
  }
  if (whole.group == kFdGroup<SetpointMessage>) {
    return node->receive(can::unpack<can::Fd<SetpointMessage>>(whole.payloads), Source::can_fd,
                         now);
  }
  if (whole.group == kFdGroup<WrenchMessage>) {
    node->receive(can::unpack<can::Fd<WrenchMessage>>(whole.payloads), Source::can_fd, now);
    return false;
  }
  const Source source = fd ? Source::can_fd : Source::can_classic;
  node->receive(CanDecoder::message(whole), source, now);
  return false;
}

LinkState CanLink::state() const {
  LinkState state;
  report(&state);
  return state;
}

void CanLink::report(LinkState* state) const {
  const SequenceMonitor& setpoint = decoder_.monitor(kClassicGroup<SetpointMessage>);
  const SequenceMonitor& setpoint_fd = decoder_.monitor(kFdGroup<SetpointMessage>);
  const SequenceMonitor& wrench = decoder_.monitor(kClassicGroup<WrenchMessage>);
  const SequenceMonitor& wrench_fd = decoder_.monitor(kFdGroup<WrenchMessage>);
  state->setpoint_conflict = setpoint.has_conflict() || setpoint_fd.has_conflict();
  state->wrench_conflict = wrench.has_conflict() || wrench_fd.has_conflict();
  add_up(setpoint, setpoint_fd, &state->setpoint);
  add_up(wrench, wrench_fd, &state->wrench);
  state->foreign_frames = decoder_.foreign_frames();
}

void CanLink::forget_conflicts() {
  for (const FrameGroup group : {kClassicGroup<SetpointMessage>, kFdGroup<SetpointMessage>,
                                 kClassicGroup<WrenchMessage>, kFdGroup<WrenchMessage>}) {
    decoder_.monitor(group).clear_conflict();
  }
}

}  // namespace flexcomp
