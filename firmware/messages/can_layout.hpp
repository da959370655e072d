#pragma once

#include <cstdint>

namespace flexcomp {

/// Frames that make up one message: those of a group and one counter belong together.
enum class FrameGroup : std::uint8_t {
  fault,
  setpoint,
  setpoint_fd,
  wrench,
  wrench_fd,
  command,
  identity,
  transfer_begin,
  transfer_data,
  transfer_data_fd,
  transfer_end,
  measured_joints,
  measured_position,
  corrected,
  corrected_fd,
  heartbeat,
  statistic,
  transfer_reply,
  command_reply,
};

constexpr std::size_t kFrameGroups = 19;
constexpr std::size_t kMaxFrameParts = 7;

/// Where a frame of flexcomp.dbc belongs.
struct FrameLayout {
  std::uint32_t id;
  std::uint8_t size;
  bool fd;
  FrameGroup group;
  std::uint8_t part;   ///< place in its group, from 0
  std::uint8_t parts;  ///< frames in the group
};

/// The layout of a frame by its identifier; null for one that is not ours, and for the frames
/// below.
const FrameLayout* find_layout(std::uint32_t id);

/// The frame that authenticates the messages of a group, where a key is configured.
struct AuthenticationLayout {
  std::uint32_t id;
  std::uint8_t size;
  bool fd;
  FrameGroup group;
  std::uint8_t parts;  ///< frames in the group, beside this one
};

/// By its own identifier, or by the group; null for one that is none, or that has none.
const AuthenticationLayout* find_authentication(std::uint32_t id);
const AuthenticationLayout* find_authentication(FrameGroup group);

}  // namespace flexcomp
