#include "messages/can_layout.hpp"

#include <algorithm>
#include <array>

#include "flexcomp_can.h"

namespace flexcomp {
namespace {

#define FRAME(NAME, fd, group, part, parts)                                              \
  FrameLayout {                                                                          \
    FLEXCOMP_CAN_##NAME##_FRAME_ID, FLEXCOMP_CAN_##NAME##_LENGTH, fd, group, part, parts \
  }

constexpr std::array<FrameLayout, 35> kLayouts = {
    FRAME(FAULT, false, FrameGroup::fault, 0, 1),
    FRAME(SETPOINT_A, false, FrameGroup::setpoint, 0, 3),
    FRAME(SETPOINT_B, false, FrameGroup::setpoint, 1, 3),
    FRAME(SETPOINT_C, false, FrameGroup::setpoint, 2, 3),
    FRAME(SETPOINT_FD, true, FrameGroup::setpoint_fd, 0, 1),
    FRAME(WRENCH_FORCE, false, FrameGroup::wrench, 0, 2),
    FRAME(WRENCH_MOMENT, false, FrameGroup::wrench, 1, 2),
    FRAME(WRENCH_FD, true, FrameGroup::wrench_fd, 0, 1),
    FRAME(COMMAND, false, FrameGroup::command, 0, 1),
    FRAME(IDENTITY_LOW, false, FrameGroup::identity, 0, 2),
    FRAME(IDENTITY_HIGH, false, FrameGroup::identity, 1, 2),
    FRAME(TRANSFER_BEGIN, false, FrameGroup::transfer_begin, 0, 1),
    FRAME(TRANSFER_DATA, false, FrameGroup::transfer_data, 0, 1),
    FRAME(TRANSFER_END, false, FrameGroup::transfer_end, 0, 1),
    FRAME(TRANSFER_DATA_FD, true, FrameGroup::transfer_data_fd, 0, 1),
    FRAME(MEASURED_A, false, FrameGroup::measured_joints, 0, 3),
    FRAME(MEASURED_B, false, FrameGroup::measured_joints, 1, 3),
    FRAME(MEASURED_C, false, FrameGroup::measured_joints, 2, 3),
    FRAME(MEASURED_POSITION_XY, false, FrameGroup::measured_position, 0, 2),
    FRAME(MEASURED_POSITION_Z, false, FrameGroup::measured_position, 1, 2),
    FRAME(CORRECTED_A, false, FrameGroup::corrected, 0, 7),
    FRAME(CORRECTED_B, false, FrameGroup::corrected, 1, 7),
    FRAME(CORRECTED_C, false, FrameGroup::corrected, 2, 7),
    FRAME(UNCORRECTED_A, false, FrameGroup::corrected, 3, 7),
    FRAME(UNCORRECTED_B, false, FrameGroup::corrected, 4, 7),
    FRAME(UNCORRECTED_C, false, FrameGroup::corrected, 5, 7),
    FRAME(CORRECTED_FD, true, FrameGroup::corrected_fd, 0, 1),
    FRAME(STATUS, false, FrameGroup::corrected, 6, 7),
    FRAME(LATCHED, false, FrameGroup::heartbeat, 1, 4),
    FRAME(HEARTBEAT, false, FrameGroup::heartbeat, 0, 4),
    FRAME(TABLE_LOW, false, FrameGroup::heartbeat, 2, 4),
    FRAME(TABLE_HIGH, false, FrameGroup::heartbeat, 3, 4),
    FRAME(STATISTIC, false, FrameGroup::statistic, 0, 1),
    FRAME(TRANSFER_REPLY, false, FrameGroup::transfer_reply, 0, 1),
    FRAME(COMMAND_REPLY, false, FrameGroup::command_reply, 0, 1),
};

#undef FRAME

#define AUTHENTICATION(NAME, fd, group, parts)                                                  \
  AuthenticationLayout {                                                                        \
    FLEXCOMP_CAN_##NAME##_AUTHENTICATION_FRAME_ID, FLEXCOMP_CAN_##NAME##_AUTHENTICATION_LENGTH, \
        fd, group, parts                                                                        \
  }

constexpr std::array<AuthenticationLayout, 12> kAuthentications = {
    AUTHENTICATION(SETPOINT, false, FrameGroup::setpoint, 3),
    AUTHENTICATION(SETPOINT_FD, true, FrameGroup::setpoint_fd, 1),
    AUTHENTICATION(WRENCH, false, FrameGroup::wrench, 2),
    AUTHENTICATION(WRENCH_FD, true, FrameGroup::wrench_fd, 1),
    AUTHENTICATION(COMMAND, false, FrameGroup::command, 1),
    AUTHENTICATION(IDENTITY, false, FrameGroup::identity, 2),
    AUTHENTICATION(TRANSFER_BEGIN, false, FrameGroup::transfer_begin, 1),
    AUTHENTICATION(TRANSFER_DATA, false, FrameGroup::transfer_data, 1),
    AUTHENTICATION(TRANSFER_END, false, FrameGroup::transfer_end, 1),
    AUTHENTICATION(TRANSFER_DATA_FD, true, FrameGroup::transfer_data_fd, 1),
    AUTHENTICATION(CORRECTED, false, FrameGroup::corrected, 7),
    AUTHENTICATION(CORRECTED_FD, true, FrameGroup::corrected_fd, 1),
};

#undef AUTHENTICATION

template <typename Condition>
const AuthenticationLayout* first_with(const Condition& holds) {
  const auto* found = std::find_if(kAuthentications.begin(), kAuthentications.end(), holds);
  return found == kAuthentications.end() ? nullptr : found;
}

constexpr std::uint32_t kMostId = FLEXCOMP_CAN_COMMAND_REPLY_FRAME_ID;
constexpr std::uint8_t kNone = 0xFF;

/// For each identifier the place of its layout.
constexpr std::array<std::uint8_t, kMostId + 1> make_index() {
  std::array<std::uint8_t, kMostId + 1> index{};
  for (std::uint8_t& place : index) {
    place = kNone;
  }
  for (std::size_t i = 0; i < kLayouts.size(); ++i) {
    index[kLayouts[i].id] = static_cast<std::uint8_t>(i);
  }
  return index;
}

constexpr std::array<std::uint8_t, kMostId + 1> kIndex = make_index();

}  // namespace

const FrameLayout* find_layout(std::uint32_t id) {
  return id <= kMostId && kIndex[id] != kNone ? &kLayouts[kIndex[id]] : nullptr;
}

const AuthenticationLayout* find_authentication(std::uint32_t id) {
  return first_with([id](const AuthenticationLayout& layout) { return layout.id == id; });
}

const AuthenticationLayout* find_authentication(FrameGroup group) {
  return first_with([group](const AuthenticationLayout& layout) { return layout.group == group; });
}

}  // namespace flexcomp
