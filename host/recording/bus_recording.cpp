#include "recording/bus_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "error.hpp"
#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "messages/lcm_codec.hpp"
#include "messages/sequence.hpp"
#include "recording/bus_rows.hpp"

namespace flexcomp::recording {
namespace {

constexpr double kPerSecond = 1e9;

std::size_t rejected(const CanDecoder& decoder) {
  std::size_t sum = 0;
  for (std::size_t group = 0; group < kFrameGroups; ++group) {
    const StreamCounters& counters = decoder.monitor(static_cast<FrameGroup>(group)).counters;
    sum += std::size_t{counters.repeated} + counters.old + counters.out_of_sequence +
           counters.contradicting + counters.corrupt + counters.incomplete;
  }
  return sum;
}

template <std::size_t Width>
bool get_row(const std::optional<Samples>& group, Eigen::Index row,
             std::array<double, Width>* values) {
  if (!group || group->row(row).array().isNaN().any()) {
    return false;
  }
  std::copy_n(group->row(row).data(), Width, values->begin());
  return true;
}

}  // namespace

std::vector<LoggedMessage> decode(const std::vector<LoggedFrame>& frames, DecodingCounts* counts) {
  std::map<std::string, CanDecoder> decoders;
  std::vector<LoggedMessage> messages;
  for (const LoggedFrame& logged : frames) {
    if (find_authentication(logged.frame.id) != nullptr) {
      continue;  // without the key nothing can be said about it
    }
    const Message message = decoders[logged.interface].decode(logged.frame, logged.time);
    if (message.index() != 0) {
      messages.push_back({logged.time, message});
    }
  }
  for (const auto& [interface, decoder] : decoders) {
    counts->foreign += decoder.foreign_frames();
    counts->rejected += rejected(decoder);
  }
  return messages;
}

std::vector<LoggedMessage> decode(const std::vector<LoggedEvent>& events, DecodingCounts* counts) {
  constexpr std::uint32_t kCounter = 256;
  std::map<std::string, SequenceMonitor> monitors;
  std::vector<LoggedMessage> messages;
  for (const LoggedEvent& event : events) {
    const LcmMessage decoded = decode_lcm(event.channel, event.data.data(), event.data.size());
    if (decoded.message.index() == 0) {
      ++counts->foreign;
      continue;
    }
    SequenceMonitor& monitor = monitors.try_emplace(event.channel, kCounter).first->second;
    if (monitor.accept(static_cast<std::uint32_t>(decoded.sequence), 0, event.time)) {
      messages.push_back({event.time, decoded.message});
    } else {
      ++counts->rejected;
    }
  }
  return messages;
}

Recording to_recording(const std::vector<LoggedMessage>& messages, bool corrected,
                       const std::string& file) {
  BusRows rows;
  for (const LoggedMessage& logged : messages) {
    rows.take(logged.message);
    const auto* setpoint = std::get_if<SetpointMessage>(&logged.message);
    const auto* answer = std::get_if<CorrectedMessage>(&logged.message);
    if (!rows.is_after_last(logged.time)) {
      continue;  // two in one tick of the log's clock: a recording's time strictly increases
    }
    if (!corrected && setpoint != nullptr) {
      rows.end_row(logged.time, setpoint->q);
    } else if (corrected && answer != nullptr && std::isfinite(answer->corrected[0])) {
      rows.end_row(logged.time, answer->corrected);
    }
  }
  return rows.finish(file);
}

std::vector<LoggedMessage> to_messages(const Recording& recording, std::int64_t start) {
  if (!recording.q_cmd) {
    throw InputError(recording.file + ": q_cmd_1..q_cmd_6 are missing; they become the setpoints");
  }
  std::vector<LoggedMessage> messages;
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    const std::int64_t time =
        start + std::llround(kPerSecond * (recording.time[row] - recording.time[0]));
    JointAngles q{};
    std::array<double, 6> wrench{};
    std::array<double, 3> position{};
    if (get_row(recording.q_meas, row, &q)) {
      messages.push_back({time, MeasuredJointsMessage{q}});
    }
    if (get_row(recording.position, row, &position)) {
      messages.push_back({time, MeasuredPositionMessage{position}});
    }
    if (get_row(recording.wrench, row, &wrench)) {
      messages.push_back({time, WrenchMessage{time, wrench, false}});
    }
    if (get_row(recording.q_cmd, row, &q)) {
      messages.push_back({time, SetpointMessage{time, q}});
    }
  }
  return messages;
}

std::vector<LoggedFrame> encode_frames(const std::vector<LoggedMessage>& messages,
                                       const std::string& interface, bool fd) {
  CanEncoder encoder(fd);
  std::vector<LoggedFrame> frames;
  for (const LoggedMessage& logged : messages) {
    const FrameList list = encoder.encode(logged.message);
    for (std::size_t i = 0; i < list.count; ++i) {
      frames.push_back({logged.time, interface, list.frames[i]});
    }
  }
  return frames;
}

std::vector<LoggedEvent> encode_events(const std::vector<LoggedMessage>& messages) {
  std::array<std::int64_t, std::variant_size_v<Message>> sequences{};
  std::vector<LoggedEvent> events;
  for (const LoggedMessage& logged : messages) {
    LcmEvent event = encode_lcm(logged.message, sequences[logged.message.index()]++, logged.time);
    events.push_back({logged.time, std::move(event.channel), std::move(event.data)});
  }
  return events;
}

std::string groups_without_message(const Recording& recording) {
  std::string names;
  const auto add = [&](bool present, const char* name) {
    if (present) {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  };
  add(recording.q_link.has_value(), "q_link");
  add(recording.tau.has_value(), "tau");
  add(recording.temperature.has_value(), "temp_c");
  return names;
}

}  // namespace flexcomp::recording
