#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kClassicChecksumBytes = 1;
constexpr std::size_t kFdChecksumBytes = 2;

template <typename Word, unsigned Polynomial>
constexpr std::array<Word, 256> make_crc_table() {
  constexpr unsigned kBits = 8 * sizeof(Word);
  std::array<Word, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << (kBits - 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & (1U << (kBits - 1))) != 0 ? (crc << 1) ^ Polynomial : crc << 1;
    }
    table[byte] = static_cast<Word>(crc);
  }
  return table;
}

constexpr std::array<std::uint8_t, 256> kCrc8 = make_crc_table<std::uint8_t, 0x2F>();
constexpr std::array<std::uint16_t, 256> kCrc16 = make_crc_table<std::uint16_t, 0x1021>();

std::uint8_t step(std::uint8_t crc, std::uint8_t byte) { return kCrc8[crc ^ byte]; }

std::uint16_t step(std::uint16_t crc, std::uint8_t byte) {
  return static_cast<std::uint16_t>((crc << 8) ^ kCrc16[(crc >> 8) ^ byte]);
}

template <typename Word>
Word checksum(const CanFrame& frame, std::size_t first) {
  auto crc = static_cast<Word>(~Word{0});
  crc = step(crc, static_cast<std::uint8_t>(frame.id & 0xFFU));
  crc = step(crc, static_cast<std::uint8_t>(frame.id >> 8));
  for (std::size_t i = first; i < frame.size; ++i) {
    crc = step(crc, frame.data[i]);
  }
  return crc;
}

/// The loop over the seven bytes of nearly all frames, without a loop.
std::uint8_t classic_checksum(const CanFrame& frame) {
  if (frame.size != 8) {
    return static_cast<std::uint8_t>(~checksum<std::uint8_t>(frame, kClassicChecksumBytes));
  }
  std::uint8_t crc = step(step(std::uint8_t{0xFF}, static_cast<std::uint8_t>(frame.id & 0xFFU)),
                          static_cast<std::uint8_t>(frame.id >> 8));
#pragma GCC unroll 7
  for (std::size_t i = kClassicChecksumBytes; i < 8; ++i) {
    crc = step(crc, frame.data[i]);
  }
  return static_cast<std::uint8_t>(~crc);
}

std::uint16_t fd_checksum(const CanFrame& frame) {
  return checksum<std::uint16_t>(frame, kFdChecksumBytes);
}

}  // namespace

void protect(CanFrame* frame) {
  if (frame->fd) {
    const std::uint16_t crc = fd_checksum(*frame);
    frame->data[0] = static_cast<std::uint8_t>(crc & 0xFFU);
    frame->data[1] = static_cast<std::uint8_t>(crc >> 8);
  } else {
    frame->data[0] = classic_checksum(*frame);
  }
}

bool is_intact(const CanFrame& frame) {
  if (frame.size > frame.data.size() || frame.id > 0x7FFU) {
    return false;
  }
  if (frame.fd) {
    return frame.size > kFdChecksumBytes &&
           (frame.data[0] | frame.data[1] << 8) == fd_checksum(frame);
  }
  return frame.size > kClassicChecksumBytes && frame.size <= 8 &&
         frame.data[0] == classic_checksum(frame);
}

}  // namespace flexcomp
