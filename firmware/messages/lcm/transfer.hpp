#pragma once

#include "flexcomp_lcm/table_begin.hpp"
#include "flexcomp_lcm/table_data.hpp"
#include "flexcomp_lcm/table_end.hpp"
#include "flexcomp_lcm/table_reply.hpp"
#include "messages/lcm/event.hpp"

/// The transfer of a table on LCM.
namespace flexcomp::lcm {

template <>
struct Event<TransferBeginMessage> {
  using Type = flexcomp_lcm::table_begin;

  static void write(const TransferBeginMessage& message, Type* type) {
    type->size = message.size;
    type->crc = message.crc;
  }

  static TransferBeginMessage read(const Type& type) {
    return {static_cast<std::uint32_t>(type.size), static_cast<std::uint32_t>(type.crc)};
  }
};

template <>
struct Event<TransferDataMessage> {
  using Type = flexcomp_lcm::table_data;

  static void write(const TransferDataMessage& message, Type* type) {
    type->word_index = message.word_index;
    type->count = static_cast<std::int8_t>(message.count);
    std::transform(message.words.begin(), message.words.end(), type->words,
                   [](std::uint32_t word) { return static_cast<std::int32_t>(word); });
  }

  static TransferDataMessage read(const Type& type) {
    TransferDataMessage message{
        static_cast<std::uint32_t>(type.word_index), static_cast<std::uint32_t>(type.count), {}};
    std::transform(std::begin(type.words), std::end(type.words), message.words.begin(),
                   [](std::int32_t word) { return static_cast<std::uint32_t>(word); });
    return message;
  }
};

template <>
struct Event<TransferEndMessage> {
  using Type = flexcomp_lcm::table_end;

  static void write(const TransferEndMessage& message, Type* type) { type->crc = message.crc; }

  static TransferEndMessage read(const Type& type) {
    return {static_cast<std::uint32_t>(type.crc)};
  }
};

template <>
struct Event<TransferReplyMessage> {
  using Type = flexcomp_lcm::table_reply;

  static void write(const TransferReplyMessage& message, Type* type) {
    type->stage = static_cast<std::int8_t>(message.stage);
    type->result = message.result;
    type->words = message.words;
  }

  static TransferReplyMessage read(const Type& type) {
    return {static_cast<TransferStage>(type.stage), static_cast<std::uint8_t>(type.result),
            static_cast<std::uint32_t>(type.words)};
  }
};

}  // namespace flexcomp::lcm
