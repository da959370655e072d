#pragma once

#include <vector>

#include "messages/messages.hpp"
#include "recording/candump_log.hpp"
#include "recording/lcm_log.hpp"
#include "recording/recording.hpp"

namespace flexcomp::recording {

/// A message and when it was logged.
struct LoggedMessage {
  std::int64_t time = 0;  ///< ns since the epoch
  Message message;
};

/// Frames and events of a log that gave no message.
struct DecodingCounts {
  std::size_t foreign = 0;   ///< frames or events that are not flexcomp's
  std::size_t rejected = 0;  ///< of flexcomp's: damaged, repeated, late, or of incomplete sets
};

/// The messages in a log, in its order. Frames of each interface are put together by themselves.
std::vector<LoggedMessage> decode(const std::vector<LoggedFrame>& frames, DecodingCounts* counts);
std::vector<LoggedMessage> decode(const std::vector<LoggedEvent>& events, DecodingCounts* counts);

/// A row for every setpoint: q_cmd, and of q_meas, wrench and position what came last since the row
/// before; missing where nothing came. Time begins at zero. `corrected`: q_cmd is the corrected
/// setpoint instead, a row for every one of those.
///
/// Throws InputError if there are fewer than two setpoints.
Recording to_recording(const std::vector<LoggedMessage>& messages, bool corrected,
                       const std::string& file);

/// The messages of a recording, a row's in the order measured joints, position, wrench, setpoint,
/// at `start` (ns since the epoch) and the times of the rows. Missing samples are left out. Throws
/// InputError if there is no q_cmd.
std::vector<LoggedMessage> to_messages(const Recording& recording, std::int64_t start);

std::vector<LoggedFrame> encode_frames(const std::vector<LoggedMessage>& messages,
                                       const std::string& interface, bool fd);
std::vector<LoggedEvent> encode_events(const std::vector<LoggedMessage>& messages);

/// Which groups of a recording the messages cannot carry: "tau, q_link"; empty if none.
std::string groups_without_message(const Recording& recording);

}  // namespace flexcomp::recording
