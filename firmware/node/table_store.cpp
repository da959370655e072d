#include "node/table_store.hpp"

#include <algorithm>
#include <cstring>

#include "core/crc32.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kScrubBytes = 64;  // a tick
constexpr std::size_t kCrcPlace = offsetof(TableHeader, crc);

}  // namespace

Reply TableStore::begin(const TransferBeginMessage& message) {
  const std::size_t words = message.size / sizeof(std::uint32_t);
  if (phase_ == Phase::complete || message.size % sizeof(std::uint32_t) != 0 || words == 0 ||
      words > slots_[receiving_slot()].capacity) {
    return Reply::transfer_refused;
  }
  phase_ = Phase::receiving;
  words_ = static_cast<std::uint32_t>(words);
  crc_ = message.crc;
  running_crc_ = 0;
  received_ = 0;
  return Reply::ok;
}

Reply TableStore::add(const TransferDataMessage& message) {
  if (phase_ != Phase::receiving || message.word_index != received_ || message.count == 0 ||
      message.count > TransferDataMessage::kMaxWords || message.count > words_ - received_) {
    phase_ = phase_ == Phase::receiving ? Phase::idle : phase_;
    return Reply::transfer_out_of_order;
  }
  std::uint32_t* place = slots_[receiving_slot()].words + received_;
  std::copy_n(message.words.begin(), message.count, place);
  running_crc_ = crc32(place, message.count * sizeof(std::uint32_t), running_crc_);
  received_ += message.count;
  return Reply::ok;
}

Reply TableStore::end(const TransferEndMessage& message) {
  if (phase_ != Phase::receiving || received_ != words_) {
    phase_ = phase_ == Phase::receiving ? Phase::idle : phase_;
    return Reply::transfer_out_of_order;
  }
  if (running_crc_ != crc_ || message.crc != crc_) {
    phase_ = Phase::idle;
    return Reply::transfer_crc;
  }
  phase_ = Phase::complete;
  return Reply::ok;
}

const void* TableStore::received(std::size_t* size) const {
  if (phase_ != Phase::complete) {
    return nullptr;
  }
  *size = words_ * sizeof(std::uint32_t);
  return slots_[receiving_slot()].words;
}

void TableStore::conclude(std::size_t size) {
  if (phase_ == Phase::complete && size > 0) {
    const std::size_t slot = receiving_slot();
    use(slot, slots_[slot].words, size);
  }
  phase_ = Phase::idle;
}

void TableStore::use(std::size_t place, const void* table, std::size_t size) {
  active_ = place;
  in_use_ = static_cast<const unsigned char*>(table);
  scrub_size_ = size;
  restart_scrub();
}

void TableStore::restart_scrub() {
  scrub_place_ = 0;
  scrub_crc_ = 0;
}

bool TableStore::scrub() {
  if (active_ == kNone) {
    return true;
  }
  const std::size_t size = std::min(kScrubBytes, scrub_size_ - scrub_place_);
  const unsigned char* const piece = in_use_ + scrub_place_;
  if (scrub_place_ <= kCrcPlace && kCrcPlace < scrub_place_ + size) {
    // The CRC was made with its own word zero.
    constexpr std::uint32_t kZero = 0;
    const std::size_t before = kCrcPlace - scrub_place_;
    const std::size_t behind = before + sizeof kZero;
    scrub_crc_ = crc32(piece, before, scrub_crc_);
    scrub_crc_ = crc32(&kZero, sizeof kZero, scrub_crc_);
    scrub_crc_ = crc32(piece + behind, size - behind, scrub_crc_);
  } else {
    scrub_crc_ = crc32(piece, size, scrub_crc_);
  }
  scrub_place_ += size;
  if (scrub_place_ < scrub_size_) {
    return true;
  }
  std::uint32_t stored = 0;
  std::memcpy(&stored, in_use_ + kCrcPlace, sizeof stored);
  const bool intact = stored == scrub_crc_;
  restart_scrub();
  return intact;
}

}  // namespace flexcomp
