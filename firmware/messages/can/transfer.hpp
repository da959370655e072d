#pragma once

#include "messages/can/frame_set.hpp"

/// The transfer of a table on CAN.
namespace flexcomp::can {

template <>
struct Classic<TransferBeginMessage> : FrameSet<DBC_FRAME(TRANSFER_BEGIN, transfer_begin)> {
  using Authentication = DBC_FRAME(TRANSFER_BEGIN_AUTHENTICATION, transfer_begin_authentication);
  static constexpr bool kMayRestart = true;

  static void pack(const TransferBeginMessage& message, flexcomp_can_transfer_begin_t* raw) {
    raw->size = message.size;
    raw->table_crc = message.crc;
  }

  static TransferBeginMessage unpack(const flexcomp_can_transfer_begin_t& raw) {
    return {raw.size, raw.table_crc};
  }
};

template <>
struct Classic<TransferDataMessage> : FrameSet<DBC_FRAME(TRANSFER_DATA, transfer_data)> {
  using Authentication = DBC_FRAME(TRANSFER_DATA_AUTHENTICATION, transfer_data_authentication);
  static constexpr bool kMayRestart = true;

  static bool can_hold(const TransferDataMessage& message) { return message.count == 1; }

  static void pack(const TransferDataMessage& message, flexcomp_can_transfer_data_t* raw) {
    raw->word_index = message.word_index;
    raw->word = message.words[0];
  }

  static TransferDataMessage unpack(const flexcomp_can_transfer_data_t& raw) {
    return {raw.word_index, 1, {raw.word}};
  }
};

template <>
struct Fd<TransferDataMessage> : FrameSet<DBC_FRAME(TRANSFER_DATA_FD, transfer_data_fd)> {
  using Authentication = DBC_FRAME(TRANSFER_DATA_FD_AUTHENTICATION,
                                   transfer_data_fd_authentication);
  static constexpr bool kMayRestart = true;

  static bool can_hold(const TransferDataMessage& message) {
    return message.count <= TransferDataMessage::kMaxWords;
  }

  static void pack(const TransferDataMessage& message, flexcomp_can_transfer_data_fd_t* raw) {
    raw->word_index = message.word_index;
    raw->words = static_cast<std::uint8_t>(message.count);
    raw->word0 = message.words[0];
    raw->word1 = message.words[1];
    raw->word2 = message.words[2];
    raw->word3 = message.words[3];
    raw->word4 = message.words[4];
    raw->word5 = message.words[5];
    raw->word6 = message.words[6];
    raw->word7 = message.words[7];
    raw->word8 = message.words[8];
    raw->word9 = message.words[9];
    raw->word10 = message.words[10];
    raw->word11 = message.words[11];
    raw->word12 = message.words[12];
    raw->word13 = message.words[13];
  }

  static TransferDataMessage unpack(const flexcomp_can_transfer_data_fd_t& raw) {
    return {raw.word_index,
            raw.words,
            {raw.word0, raw.word1, raw.word2, raw.word3, raw.word4, raw.word5, raw.word6, raw.word7,
             raw.word8, raw.word9, raw.word10, raw.word11, raw.word12, raw.word13}};
  }
};

template <>
struct Classic<TransferEndMessage> : FrameSet<DBC_FRAME(TRANSFER_END, transfer_end)> {
  using Authentication = DBC_FRAME(TRANSFER_END_AUTHENTICATION, transfer_end_authentication);
  static constexpr bool kMayRestart = true;

  static void pack(const TransferEndMessage& message, flexcomp_can_transfer_end_t* raw) {
    raw->table_crc = message.crc;
  }

  static TransferEndMessage unpack(const flexcomp_can_transfer_end_t& raw) {
    return {raw.table_crc};
  }
};

template <>
struct Classic<TransferReplyMessage> : FrameSet<DBC_FRAME(TRANSFER_REPLY, transfer_reply)> {
  static void pack(const TransferReplyMessage& message, flexcomp_can_transfer_reply_t* raw) {
    raw->stage = static_cast<std::uint8_t>(message.stage);
    raw->result = message.result;
    raw->words = message.words;
  }

  static TransferReplyMessage unpack(const flexcomp_can_transfer_reply_t& raw) {
    return {static_cast<TransferStage>(raw.stage), raw.result, raw.words};
  }
};

}  // namespace flexcomp::can
