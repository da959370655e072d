#pragma once

#include "messages/messages.hpp"

namespace flexcomp::test {

/// One message of every kind. The values are those in test_frames.py, no two of a frame the same.
inline std::array<Message, 15> one_of_each() {
  constexpr std::int64_t kMicrosecond = 1000;  // ns
  const JointAngles q = {0.1, -0.2, 0.3, -0.4, 0.5, -0.6};
  const JointAngles p = {-1.1, 1.2, -1.3, 1.4, -1.5, 6.7};
  TransferDataMessage data{77, 1, {}};
  for (std::uint32_t i = 0; i < TransferDataMessage::kMaxWords; ++i) {
    data.words[i] = 0xDEADBE00 + i;
  }
  return {SetpointMessage{123456 * kMicrosecond, q},
          WrenchMessage{234567 * kMicrosecond, {440.5, 1370, -635, 0.25, 3, 10.5}, true},
          CommandMessage{Command::arm},
          IdentityMessage{0x0123456789ABCDEF, WrenchFrame::tool},
          TransferBeginMessage{10272, 0xCAFEBABE},
          data,
          TransferEndMessage{0xBABECAFE},
          MeasuredJointsMessage{p},
          MeasuredPositionMessage{{1.6, -0.1, 1.2}},
          CorrectedMessage{345678 * kMicrosecond, q, p, 0x00080041, 0x5003, 3},
          HeartbeatMessage{12345, 2, 1, 14, 0x21, 0x81, 0xFEDCBA9876543210, 0.5},
          FaultMessage{0x7105, true, 42},
          StatisticMessage{64, 123456789},
          TransferReplyMessage{TransferStage::end, 12, 2568},
          CommandReplyMessage{Command::reset, 33, 0.25}};
}

}  // namespace flexcomp::test
