#include "messages/can_decoder.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr std::uint32_t kClassicCounter = 16;
constexpr std::uint32_t kFdCounter = 256;

/// Tells contents apart, no more. A word at a time: this is on the way of every setpoint. `size`:
/// whole words.
std::uint32_t digest(const std::uint8_t* payloads, std::size_t size) {
  std::uint32_t hash = 0;
  for (const std::uint8_t* at = payloads; at < payloads + size; at += sizeof hash) {
    std::uint32_t word = 0;
    std::memcpy(&word, at, sizeof word);
    hash = (hash << 7 | hash >> 25) ^ word;
  }
  return hash;
}

/// A set that is dropped is dropped once.
bool is_counted(const FrameLayout& layout) { return layout.part == 0; }

bool is_intact(const CanFrame& frame, const FrameLayout& layout) {
  return layout.parts > 1 ? is_classic_intact(layout.crc_of_identifier, frame.data.data())
                          : is_intact(frame);
}

/// Which counters a group has.
struct Counting {
  std::uint32_t modulus;
  bool may_restart;
};

template <typename... Formats>
constexpr std::array<Counting, kFrameGroups> countings_of(
    const std::tuple<Formats...>& /*formats*/) {
  return {{{Formats::kFd ? kFdCounter : kClassicCounter, Formats::kMayRestart}...}};
}

constexpr std::array<Counting, kFrameGroups> kCountings = countings_of(can::Formats());

// All in one function, on the way of every message: some instructions less.
template <typename Format>
[[gnu::flatten]] Message unpack(const std::uint8_t* payloads) {
  return can::unpack<Format>(payloads);
}

using Unpack = Message (*)(const std::uint8_t* payloads);

template <typename... Formats>
constexpr std::array<Unpack, kFrameGroups> unpacks_of(const std::tuple<Formats...>& /*formats*/) {
  return {unpack<Formats>...};
}

constexpr std::array<Unpack, kFrameGroups> kUnpack = unpacks_of(can::Formats());

}  // namespace

CanDecoder::CanDecoder(std::uint32_t tolerated) {
  for (std::size_t group = 0; group < kFrameGroups; ++group) {
    streams_[group].monitor =
        SequenceMonitor(kCountings[group].modulus, tolerated, kCountings[group].may_restart);
  }
}

Message CanDecoder::decode(const CanFrame& frame, std::int64_t now) {
  return message(take(frame, now));
}

Message CanDecoder::message(const WholeMessage& whole) {
  return whole.payloads != nullptr ? kUnpack[static_cast<std::size_t>(whole.group)](whole.payloads)
                                   : Message();
}

WholeMessage CanDecoder::take(const CanFrame& frame, std::int64_t now) {
  const FrameLayout* layout = find_layout(frame.id);
  if (layout == nullptr) {
    ++foreign_frames_;
    return {};
  }
  Stream& stream = streams_[static_cast<std::size_t>(layout->group)];
  if (frame.size != layout->size || frame.fd != layout->fd || !is_intact(frame, *layout)) {
    ++stream.monitor.counters.corrupt;
    return {};
  }
  if (layout->parts > 1) {
    return {layout->group, add_part(*layout, frame, now, &stream)};
  }
  const bool is_used =
      stream.monitor.accept(counter_of(frame), digest(frame.data.data(), frame.size), now);
  return {layout->group, is_used ? frame.data.data() : nullptr};
}

/// The payloads of a set that this part makes whole, or null.
const std::uint8_t* CanDecoder::add_part(const FrameLayout& layout, const CanFrame& frame,
                                         std::int64_t now, Stream* whole) {
  SequenceMonitor& stream = whole->monitor;
  Set& set = whole->set;
  const std::uint32_t counter = frame.data[1] & (kClassicCounter - 1);
  if (stream.is_repetition(counter)) {
    drop_repeated_part(layout, frame, now, whole);
    return nullptr;
  }
  if (set.received != 0 && counter != set.counter && !begins_anew(layout, counter, whole)) {
    return nullptr;
  }
  set.counter = counter;
  std::uint8_t* const payloads = set.payloads[set.next].data();
  std::memcpy(payloads + std::size_t{8} * layout.part, frame.data.data(), 8);
  set.received |= layout.part_bit;
  if (set.received != layout.all_parts) {
    return nullptr;
  }
  set.received = 0;
  if (!stream.accept(counter, digest(payloads, std::size_t{8} * layout.parts), now)) {
    return nullptr;
  }
  set.next = 1 - set.next;
  return payloads;
}

// These two stand by themselves, so that they take no registers from what happens every time.

[[gnu::noinline]] void CanDecoder::drop_repeated_part(const FrameLayout& layout,
                                                      const CanFrame& frame, std::int64_t now,
                                                      Stream* whole) {
  const Set& set = whole->set;
  const bool same = std::equal(frame.data.begin(), frame.data.begin() + 8,
                               set.payloads[1 - set.next].begin() + std::size_t{8} * layout.part);
  if (is_counted(layout) || !same) {
    whole->monitor.drop_repetition(same, now);
  }
}

/// Does a part with another counter than those that wait begin the next set? Else it is late.
[[gnu::noinline]] bool CanDecoder::begins_anew(const FrameLayout& layout, std::uint32_t counter,
                                               Stream* whole) {
  Set& set = whole->set;
  SequenceMonitor& stream = whole->monitor;
  const bool older = ((counter - set.counter) & (kClassicCounter - 1)) > kClassicCounter / 2;
  if (older && stream.is_behind(counter)) {
    if (is_counted(layout)) {
      stream.drop_late();
    }
    return false;
  }
  ++stream.counters.incomplete;
  set.received = 0;
  return true;
}

}  // namespace flexcomp
