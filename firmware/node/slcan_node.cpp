#include "node/slcan_node.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "node/default_config.hpp"
#include "node/table_admission.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kBytesAStep = 1024;
constexpr int kMessagesATick = 2;  // beside the corrected setpoint
constexpr std::uint32_t kLinesToRecover = 64;
constexpr std::uint8_t kDone = '\r';
constexpr std::uint8_t kError = '\a';
constexpr std::uint32_t kErased = 0xFFFFFFFF;  // as flash is

std::int64_t in_nanoseconds(float period) {
  constexpr float kLongest = 2000.0F;  // s, in microseconds less than the target's `long` holds
  // Whole microseconds, which a float holds exactly where nanoseconds are rounded.
  return std::int64_t{1000} * std::lround(1e6F * std::fmin(period, kLongest));
}

}  // namespace

SlcanNode::SlcanNode(const NodeSettings& settings, Bytes* received, Bytes* to_send, TableSlot first,
                     TableSlot second)
    : received_(received),
      to_send_(to_send),
      link_(false, settings.tolerated_losses),
      trigger_(settings.trigger),
      period_(in_nanoseconds(settings.node.compensator.period)),
      table_key_(settings.table_key) {
  node_.use_memory(first, second);
  if (node_.configure(settings.node) != Result::ok) {
    const NodeConfig config = default_node_config();  // without a model hash: it takes no table
    node_.configure(config);
    period_ = in_nanoseconds(config.compensator.period);
    trigger_ = Trigger::clock;
    node_.announce(kConfigRefusedCode, static_cast<std::uint32_t>(Result::bad_config));
  }
  due_at_ = period_;
}

void SlcanNode::step(std::int64_t now) {
  exchange_tables();
  take_bytes(now);
  if (trigger_ != Trigger::lockstep && now >= due_at_) {
    tick(now);
    due_at_ = now - due_at_ < period_ ? due_at_ + period_ : now + period_;
  }
}

void SlcanNode::take_bytes(std::int64_t now) {
  std::size_t count = 0;
  for (std::size_t left = kBytesAStep; left > 0; left -= count) {
    const std::uint8_t* const bytes = received_->front(&count);
    count = std::min(count, left);
    if (count == 0) {
      break;
    }
    take_bytes(bytes, count, now);
    received_->drop(count);
  }
}

void SlcanNode::take_bytes(const std::uint8_t* bytes, std::size_t count, std::int64_t now) {
  for (std::size_t i = 0; i < count;) {
    if (const std::size_t whole_line = reader_.take_frame(bytes + i, count - i)) {
      i += whole_line;
      take_frame(now);
      continue;
    }
    switch (reader_.take(bytes[i++])) {
      case SlcanReader::Event::frame:
        take_frame(now);
        break;
      case SlcanReader::Event::foreign:
      case SlcanReader::Event::corrupt:
        ++other_lines_;
        break;
      case SlcanReader::Event::command:
        to_send_->push(kDone);
        break;
      case SlcanReader::Event::unknown:
        ++other_lines_;
        to_send_->push(kError);
        break;
      case SlcanReader::Event::nothing:
        break;
    }
  }
}

void SlcanNode::take_frame(std::int64_t now) {
  const std::int64_t received_at = trigger_ == Trigger::lockstep ? steps_ * period_ : now;
  if (link_.receive(reader_.frame(), &node_, received_at)) {
    on_setpoint(now);
  }
}

void SlcanNode::on_setpoint(std::int64_t now) {
  if (trigger_ == Trigger::lockstep) {
    ++steps_;
    tick(steps_ * period_);
  } else if (trigger_ == Trigger::setpoint) {
    if (now - ticked_at_ >= period_ / 2) {
      tick(now);
    }
    // The next one makes the next tick, even if it is a little late; also where this one came soon
    // after a tick without any, so that ticks fall into step with the setpoints.
    due_at_ = now + period_ + period_ / 2;
  }
}

void SlcanNode::report_link() {
  LinkState* const state = node_.link_state();
  link_.report(state);
  state->bus_fault = lines_to_recover_ > 0;
  state->foreign_frames += other_lines_;
  state->dropped_frames = dropped_frames_;
  state->stack_used = stack_used_.load(std::memory_order_relaxed);
}

void SlcanNode::tick(std::int64_t now) {
  ticked_at_ = now;
  if (node_.take_reset()) {
    link_.forget_conflicts();
  }
  report_link();
  const CorrectedMessage corrected = node_.tick(now);
  send(corrected);
  trial_.observe(corrected);
  if (trial_.has_run() && counter_in_use_ > counter_run_.load(std::memory_order_relaxed)) {
    counter_run_.store(counter_in_use_, std::memory_order_relaxed);
  }
  for (int i = 0; i < kMessagesATick; ++i) {
    if (const Message* const message = node_.next_message()) {
      send(*message);
    }
  }
}

template <typename SomeMessage>
void SlcanNode::send(const SomeMessage& message) {
  const FrameList& list = link_.encode(message);
  for (std::size_t i = 0; i < list.count; ++i) {
    send_line(to_slcan(list.frames[i]));
  }
}

/// A whole line or none of it: half a line would spoil the next.
void SlcanNode::send_line(const SlcanLine& line) {
  if (!to_send_->push_all(reinterpret_cast<const std::uint8_t*>(line.text.data()), line.size)) {
    ++dropped_frames_;
    lines_to_recover_ = kLinesToRecover;
    return;
  }
  lines_to_recover_ -= lines_to_recover_ > 0 ? 1U : 0U;
}

void SlcanNode::exchange_tables() {
  const Check check = check_.load(std::memory_order_acquire);
  if (check == Check::done) {
    if (checked_.refused != Reply::ok) {
      node_.refuse_transfer(checked_.refused);
    } else if (node_.conclude_transfer(checked_.opened, checked_.table) == Result::ok) {
      has_in_use(checked_.counter);
    }
    check_.store(Check::none, std::memory_order_relaxed);
  } else if (check == Check::none) {
    unchecked_ = node_.received_table(&unchecked_size_);
    unchecked_index_ = node_.index_of_received();
    if (unchecked_ != nullptr) {
      check_.store(Check::wanted, std::memory_order_release);
    }
  }
}

void SlcanNode::check_table() {
  if (check_.load(std::memory_order_acquire) == Check::wanted) {
    checked_ = checked(unchecked_, unchecked_size_, unchecked_index_);
    check_.store(Check::done, std::memory_order_release);
  }
}

SlcanNode::Checked SlcanNode::checked(const void* data, std::size_t size, IndexMemory index) const {
  Checked result;
  if (table_key_) {
    const TableAdmission admission(*table_key_, counter_run_.load(std::memory_order_relaxed));
    result.refused = admission.judge(data, size, &result.counter);
  }
  if (result.refused == Reply::ok) {
    result.opened = Table::open(data, bytes_of_table(data, size), &result.table);
  }
  if (result.opened == Result::ok && result.refused == Reply::ok) {
    index.index(&result.table);
  }
  return result;
}

void SlcanNode::has_in_use(std::uint32_t counter) {
  counter_in_use_ = counter;
  trial_.begin();
}

void SlcanNode::start_with(const void* memory, std::size_t size, IndexMemory index) {
  TableHeader header;
  if (size < sizeof header) {
    return;
  }
  std::memcpy(&header, memory, sizeof header);
  if (header.magic == kErased || header.magic == 0) {
    return;
  }
  const std::size_t room = size - sizeof(TableTrailer);
  const bool has_room = header.size <= room;
  // The bytes behind the table are its signature, or none of its own.
  const std::size_t whole = has_room ? header.size + sizeof(TableTrailer) : size;
  const bool is_signed = bytes_of_table(memory, whole) < whole;
  const Checked table = checked(memory, is_signed || !has_room ? whole : header.size, index);
  if (table.refused != Reply::ok) {
    node_.refuse_start(table.refused);
  } else if (node_.start_with(TableStore::kFixed, table.table, table.opened) == Result::ok) {
    has_in_use(table.counter);
  }
}

}  // namespace flexcomp
