#include "messages/can_encoder.hpp"

#include <cstring>

#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr std::uint8_t kClassicCounterMask = 0x0F;

template <typename Frame>
void make_frame(typename Frame::Raw* raw, std::uint8_t counter, CanFrame* frame) {
  raw->counter = Frame::kFd ? counter : counter & kClassicCounterMask;
  auto payload = Frame::pack(*raw);
  if constexpr (Frame::kSize == 8) {
    constexpr std::uint8_t kStart = crc8_of_identifier(Frame::kId);
    payload[0] |= classic_checksum(kStart, payload[0], payload[1]);
  }
  std::memcpy(frame->data.data(), payload.data(), sizeof payload);
  frame->id = Frame::kId;
  frame->size = Frame::kSize;
  frame->fd = Frame::kFd;
  if constexpr (Frame::kSize != 8) {
    protect(frame);
  }
}

// All in one function, on the way of every answer: what is packed stays in registers.
template <typename Format, typename Content, typename... Frames>
[[gnu::flatten]] void make_frames(const Content& message, std::uint8_t counter, FrameList* list,
                                  const can::FrameSet<Frames...>& /*format*/) {
  std::tuple<typename Frames::Raw...> raws{};
  std::apply([&](auto&... raw) { Format::pack(message, &raw...); }, raws);
  CanFrame* frame = list->frames.data();
  (make_frame<Frames>(&std::get<typename Frames::Raw>(raws), counter, frame++), ...);
  list->count = sizeof...(Frames);
}

}  // namespace

template <typename Format, typename Content>
void CanEncoder::put_in(const Content& message) {
  if (Format::can_hold(message)) {
    make_frames<Format>(message, counters_[can::kPlace<Format>]++, &list_, Format());
  }
}

template <typename Content>
void CanEncoder::put(const Content& message) {
  if constexpr (can::kHasFd<Content>) {
    if (fd_) {
      return put_in<can::Fd<Content>>(message);
    }
  }
  put_in<can::Classic<Content>>(message);
}

void CanEncoder::put(std::monostate /*nothing*/) {}

const FrameList& CanEncoder::encode(const CorrectedMessage& message) {
  list_.count = 0;
  put(message);
  return list_;
}

const FrameList& CanEncoder::encode(const Message& message) {
  list_.count = 0;
  std::visit([this](const auto& content) { put(content); }, message);
  return list_;
}

}  // namespace flexcomp
