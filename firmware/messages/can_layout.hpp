#pragma once

#include <algorithm>
#include <cstdint>

#include "messages/can/all_messages.hpp"

namespace flexcomp {

/// Frames that make up one message: those of a group and one counter belong together. Each message
/// has a group of classic frames, and some have one of FD frames beside it.
enum class FrameGroup : std::uint8_t {};

template <typename Content>
constexpr FrameGroup kClassicGroup{can::kPlace<can::Classic<Content>>};
template <typename Content>
constexpr FrameGroup kFdGroup{can::kPlace<can::Fd<Content>>};

constexpr std::size_t kFrameGroups = std::tuple_size_v<can::Formats>;

template <typename... Formats>
constexpr std::size_t most_parts(const std::tuple<Formats...>* /*formats*/) {
  return std::max({Formats::kParts...});
}
constexpr std::size_t kMaxFrameParts = most_parts(static_cast<can::Formats*>(nullptr));

/// Where a frame of flexcomp.dbc belongs.
struct FrameLayout {
  std::uint32_t id;
  std::uint8_t size;
  bool fd;
  FrameGroup group;
  std::uint8_t part;               ///< place in its group, from 0
  std::uint8_t parts;              ///< frames in the group
  std::uint8_t crc_of_identifier;  ///< classic: what the checksum goes on from
  std::uint8_t part_bit;           ///< one bit a part: this one
  std::uint8_t all_parts;          ///< and all of them
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
