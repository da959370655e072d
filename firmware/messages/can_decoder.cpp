#include "messages/can_decoder.hpp"

#include <algorithm>
#include <cstring>

#include "messages/can_codec.hpp"
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
std::uint32_t digest(const std::array<std::array<std::uint8_t, 8>, kMaxFrameParts>& parts,
                     std::size_t count) {
  std::uint32_t hash = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint32_t, 2> words{};
    std::memcpy(words.data(), parts[i].data(), parts[i].size());
    hash = (hash << 7 | hash >> 25) ^ words[0];
    hash = (hash << 7 | hash >> 25) ^ words[1];
  }
  return hash;
}

}  // namespace

CanDecoder::CanDecoder(std::uint32_t tolerated) {
  monitors_.fill(SequenceMonitor(kClassicCounter, tolerated));
  for (const FrameGroup group : {FrameGroup::setpoint_fd, FrameGroup::wrench_fd,
                                 FrameGroup::transfer_data_fd, FrameGroup::corrected_fd}) {
    monitor(group) = SequenceMonitor(kFdCounter, tolerated);
  }
  for (const FrameGroup group : {FrameGroup::command, FrameGroup::transfer_begin,
                                 FrameGroup::transfer_data, FrameGroup::transfer_end}) {
    monitor(group) = SequenceMonitor(kClassicCounter, tolerated, true);
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
  if (layout->parts == 1) {
    return unpack_message(layout->id, frame.data.data());
  }
  return unpack_set(layout->group, sets_[static_cast<std::size_t>(layout->group)].parts);
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
  std::array<std::uint8_t, 8> content{};
  std::copy_n(frame.data.begin(), content.size(), content.begin());

  if (stream.is_repetition(counter)) {
    const bool same = content == set.accepted[layout.part];
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
  set.parts[layout.part] = content;
  set.received |= 1U << layout.part;
  if (set.received != (1U << layout.parts) - 1U) {
    return false;
  }
  set.received = 0;
  if (!stream.accept(counter, digest(set.parts, layout.parts), now)) {
    return false;
  }
  std::copy_n(set.parts.begin(), layout.parts, set.accepted.begin());
  return true;
}

}  // namespace flexcomp
