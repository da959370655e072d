#pragma once

#include <array>
#include <cstdint>
#include <variant>

namespace flexcomp {

/// Messages, the same on every transport. SI units; vectors in the robot base frame; NaN where the
/// sender had no value. Times are of the sender's monotonic clock, ns; kNoTime where the transport
/// carries none.
///
/// How to add a message. It lives in four places:
///   1. here: its struct, and its name in `Message` below;
///   2. on the wire: its frames in flexcomp.dbc and its type in lcm/*.lcm, by numbers that stay;
///   3. can/: which frames they are, how they are packed and unpacked (can/frame_set.hpp says how);
///   4. lcm/: how its type is written and read (lcm/event.hpp).
/// All else is made from these by the compiler, which stops where one is missing. The tests want
/// one of it in tests/messages/one_of_each.hpp, its frames in test_frames.py beside that, and the
/// channel in test_lcm_codec.cpp.
constexpr std::int64_t kNoTime = -1;

using JointAngles = std::array<double, 6>;

struct SetpointMessage {
  std::int64_t timestamp = kNoTime;
  JointAngles q{};  ///< rad, uncorrected
};

struct WrenchMessage {
  std::int64_t timestamp = kNoTime;
  std::array<double, 6> wrench{};  ///< N, N·m, on the tool at the TCP
  bool saturated = false;          ///< the sensor is at the end of its range
};

/// The numbers are stable, as are those of all enumerations here: they are in flexcomp.dbc.
enum class Command : std::uint8_t { none = 0, arm = 1, disarm = 2, reset = 3, report = 4 };

struct CommandMessage {
  Command command = Command::none;
};

enum class WrenchFrame : std::uint8_t { unknown = 0, base = 1, tool = 2, sensor = 3 };

/// Which robot, tool and payload the sender of setpoints works with, and the frame of its wrench.
struct IdentityMessage {
  std::uint64_t model_hash = 0;
  WrenchFrame wrench_frame = WrenchFrame::unknown;
};

struct TransferBeginMessage {
  std::uint32_t size = 0;  ///< bytes
  std::uint32_t crc = 0;   ///< CRC-32 (IEEE 802.3) of all of them
};

struct TransferDataMessage {
  static constexpr std::uint32_t kMaxWords = 14;
  std::uint32_t word_index = 0;
  std::uint32_t count = 0;
  std::array<std::uint32_t, kMaxWords> words{};
};

struct TransferEndMessage {
  std::uint32_t crc = 0;
};

struct MeasuredJointsMessage {
  JointAngles q{};  ///< rad, motor side
};

struct MeasuredPositionMessage {
  std::array<double, 3> position{};  ///< m, of the TCP
};

/// Result of one tick.
struct CorrectedMessage {
  std::int64_t timestamp = kNoTime;  ///< of the setpoint
  JointAngles corrected{};           ///< rad
  JointAngles uncorrected{};         ///< rad
  std::uint32_t status = 0;          ///< bits as in compensator.hpp
  std::uint16_t node_status = 0;     ///< bits as in node_status.hpp
  std::uint8_t state = 0;
};

struct HeartbeatMessage {
  std::uint32_t uptime = 0;  ///< s
  std::uint8_t state = 0;
  std::uint8_t slot = 0;          ///< of the table in use: 1 or 2, 3 in fixed memory, 0 for none
  std::uint8_t table_result = 0;  ///< Result or Reply of the last table that was offered
  std::uint32_t latched_faults = 0;
  std::uint16_t node_latched_faults = 0;
  std::uint64_t table_model_hash = 0;
  double largest_gain = 0;  ///< 0: not analysed
};

struct FaultMessage {
  std::uint16_t code = 0;  ///< as in fault_code.hpp
  bool active = false;     ///< began, or ended
  std::uint32_t detail = 0;
};

struct StatisticMessage {
  std::uint8_t name = 0;  ///< as in statistics.hpp
  std::uint64_t value = 0;
};

enum class TransferStage : std::uint8_t { begin = 1, data = 2, end = 3 };

/// Replies beyond those of `Result`, which keep their numbers.
enum class Reply : std::uint8_t {
  ok = 0,
  robot_unknown = 32,       ///< no identity was announced
  other_robot = 33,         ///< the announced model is not the configured one
  wrong_wrench_frame = 34,  ///< the wrench is not in the base frame
  fault_present = 35,
  transfer_refused = 36,  ///< no room, or one is under way
  transfer_out_of_order = 37,
  transfer_crc = 38,
  transfer_not_checked = 39,  ///< it could not be checked in time
  table_not_signed = 40,      ///< this and the next two only where a key is configured
  table_forged = 41,          ///< the signature is of another key, or of other content
  table_older = 42,           ///< than one that has run
};

struct TransferReplyMessage {
  TransferStage stage = TransferStage::begin;
  std::uint8_t result = 0;  ///< Result or Reply
  std::uint32_t words = 0;  ///< received so far
};

struct CommandReplyMessage {
  Command command = Command::none;
  std::uint8_t reply = 0;   ///< Result or Reply
  double largest_gain = 0;  ///< of the table in use or refused
};

using Message =
    std::variant<std::monostate, SetpointMessage, WrenchMessage, CommandMessage, IdentityMessage,
                 TransferBeginMessage, TransferDataMessage, TransferEndMessage,
                 MeasuredJointsMessage, MeasuredPositionMessage, CorrectedMessage, HeartbeatMessage,
                 FaultMessage, StatisticMessage, TransferReplyMessage, CommandReplyMessage>;

}  // namespace flexcomp
