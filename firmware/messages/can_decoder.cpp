#include "messages/can_decoder.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr std::uint32_t kClassicCounter = 16;
constexpr std::uint32_t kFdCounter = 256;

/// FNV-1a: tells contents apart, no more.
std::uint32_t digest(const CanFrame& frame) {
  std::uint32_t hash = 2166136261U;
  for (std::size_t i = 0; i < frame.size; ++i) {
    hash = (hash ^ frame.data[i]) * 16777619U;
  }
  return hash;
}

/// The same of a set of classic frames, a word at a time: this is on the way of every setpoint.
std::uint32_t digest(const std::uint8_t* parts, std::size_t count) {
  std::uint32_t hash = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint32_t, 2> words{};
    std::memcpy(words.data(), parts + 8 * i, 8);
    hash = (hash << 7 | hash >> 25) ^ words[0];
    hash = (hash << 7 | hash >> 25) ^ words[1];
  }
  return hash;
}

/// Which counters a group has.
struct Stream {
  std::uint32_t modulus;
  bool may_restart;
};

template <typename... Formats>
constexpr std::array<Stream, kFrameGroups> streams_of(const std::tuple<Formats...>& /*formats*/) {
  return {{{Formats::kFd ? kFdCounter : kClassicCounter, Formats::kMayRestart}...}};
}

constexpr std::array<Stream, kFrameGroups> kStreams = streams_of(can::Formats());

/// The message in the payloads of its frames, which lie one after the other.
template <typename Format, typename... Frames>
Message unpack_frames(const std::uint8_t* payloads, const can::FrameSet<Frames...>& /*format*/) {
  const std::tuple<typename Frames::Raw...> raws{
      Frames::unpack(std::exchange(payloads, payloads + Frames::kSize))...};
  return std::apply(Format::unpack, raws);
}

// All in one function, on the way of every setpoint: some instructions less.
template <typename Format>
[[gnu::flatten]] Message unpack(const std::uint8_t* payloads) {
  return unpack_frames<Format>(payloads, Format());
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
    monitors_[group] =
        SequenceMonitor(kStreams[group].modulus, tolerated, kStreams[group].may_restart);
  }
}

Message CanDecoder::decode(const CanFrame& frame, std::int64_t now) {
  const FrameLayout* layout = find_layout(frame.id);
  if (layout == nullptr) {
    ++foreign_frames_;
    return {};
  }
  if (frame.size != layout->size || frame.fd != layout->fd || !is_intact(frame)) {
    ++monitor(layout->group).counters.corrupt;
    return {};
  }
  if (!complete(*layout, frame, now)) {
    return {};
  }
  const auto group = static_cast<std::size_t>(layout->group);
  return kUnpack[group](layout->parts == 1 ? frame.data.data() : sets_[group].parts.data());
}

bool CanDecoder::complete(const FrameLayout& layout, const CanFrame& frame, std::int64_t now) {
  if (layout.parts > 1) {
    return add_part(layout, frame, now);
  }
  return monitor(layout.group).accept(counter_of(frame), digest(frame), now);
}

bool CanDecoder::add_part(const FrameLayout& layout, const CanFrame& frame, std::int64_t now) {
  SequenceMonitor& stream = monitor(layout.group);
  Set& set = sets_[static_cast<std::size_t>(layout.group)];
  const std::uint32_t counter = counter_of(frame);
  const bool counts = layout.part == 0;  // a set that is dropped is dropped once
  const std::size_t place = std::size_t{8} * layout.part;

  if (stream.is_repetition(counter)) {
    const bool same =
        std::equal(frame.data.begin(), frame.data.begin() + 8, set.accepted.begin() + place);
    if (counts || !same) {
      stream.drop_repetition(same, now);
    }
    return false;
  }
  if (set.received != 0 && counter != set.counter) {
    const bool older = ((counter - set.counter) & (kClassicCounter - 1)) > kClassicCounter / 2;
    if (older && stream.is_behind(counter)) {
      if (counts) {
        stream.drop_late();
      }
      return false;
    }
    ++stream.counters.incomplete;
    set.received = 0;
  }
  set.counter = counter;
  std::memcpy(set.parts.data() + place, frame.data.data(), 8);
  set.received |= 1U << layout.part;
  if (set.received != (1U << layout.parts) - 1U) {
    return false;
  }
  set.received = 0;
  if (!stream.accept(counter, digest(set.parts.data(), layout.parts), now)) {
    return false;
  }
  std::copy_n(set.parts.begin(), 8 * layout.parts, set.accepted.begin());
  return true;
}

}  // namespace flexcomp
