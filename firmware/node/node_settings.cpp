#include "node/node_settings.hpp"

#include <cstring>

#include "core/crc32.hpp"
#include "node/settings_numbers.hpp"

namespace flexcomp {
namespace {

constexpr std::uint32_t kMagic = 0x31534346;  // "FCS1"
constexpr std::uint32_t kVersion = 2;         // 1 had no key
constexpr std::uint32_t kRequireIdentity = 1;
constexpr std::uint32_t kUseTimestamps = 2;
constexpr std::uint32_t kHasKey = 4;

static_assert(sizeof(SettingsRecord) == 4 * 56, "the record is written to files: no padding");

/// Puts numbers into words, one after the other.
class WordWriter {
 public:
  explicit WordWriter(std::uint32_t* to) : to_(to) {}

  template <typename About, typename Number>
  void operator()(About /*about*/, const Number* number) {
    put(*number);
  }
  template <typename About, typename Number>
  void operator()(About /*about*/, const JointNumbers<Number>& numbers) {
    for (const Number* number : numbers) {
      put(*number);
    }
  }

 private:
  void put(std::uint32_t number) { *to_++ = number; }
  void put(double number) { put(static_cast<float>(number)); }
  void put(float number) { std::memcpy(to_++, &number, sizeof number); }

  std::uint32_t* to_;
};

/// Takes them out again.
class WordReader {
 public:
  explicit WordReader(const std::uint32_t* from) : from_(from) {}

  template <typename About, typename Number>
  void operator()(About /*about*/, Number* number) {
    take(number);
  }
  template <typename About, typename Number>
  void operator()(About /*about*/, const JointNumbers<Number>& numbers) {
    for (Number* number : numbers) {
      take(number);
    }
  }

 private:
  void take(std::uint32_t* number) { *number = *from_++; }
  void take(float* number) { std::memcpy(number, from_++, sizeof *number); }
  void take(double* number) {
    float single = 0;
    take(&single);
    *number = static_cast<double>(single);
  }

  const std::uint32_t* from_;
};

/// Looks at numbers one by one.
struct RangeCheck {
  bool holds = true;

  template <typename About, typename Number>
  void operator()(About about, const Number* number) {
    holds = holds && is_in_range(static_cast<float>(*number), about().range);
  }
  template <typename About, typename Number>
  void operator()(About about, const JointNumbers<Number>& numbers) {
    for (const Number* number : numbers) {
      (*this)(about, number);
    }
  }
};

std::uint32_t record_crc(const SettingsRecord& record) {
  constexpr std::size_t kBegin = offsetof(SettingsRecord, crc) + sizeof record.crc;
  return crc32(reinterpret_cast<const unsigned char*>(&record) + kBegin, sizeof record - kBegin);
}

}  // namespace

bool numbers_are_in_range(const NodeSettings& settings) {
  RangeCheck check;
  visit_numbers(&settings, check);
  return check.holds;
}

SettingsRecord to_record(const NodeSettings& settings) {
  const NodeConfig& node = settings.node;
  const auto& core = node.compensator;
  SettingsRecord record{};
  record.magic = kMagic;
  record.version = kVersion;
  record.size = sizeof record;
  record.model_hash_low = static_cast<std::uint32_t>(core.model_hash & 0xFFFFFFFFU);
  record.model_hash_high = static_cast<std::uint32_t>(core.model_hash >> 32);
  record.trigger = static_cast<std::uint32_t>(settings.trigger);
  record.flags = (node.require_identity ? kRequireIdentity : 0U) |
                 (node.use_timestamps ? kUseTimestamps : 0U) | (settings.table_key ? kHasKey : 0U);
  record.table_key = settings.table_key.value_or(AuthenticationKey{});
  visit_numbers(&settings, WordWriter(record.numbers.data()));
  record.crc = record_crc(record);
  return record;
}

Result read_record(const void* data, std::size_t size, NodeSettings* settings) {
  if (data == nullptr || settings == nullptr || size < sizeof(SettingsRecord)) {
    return Result::bad_config;
  }
  SettingsRecord record;
  std::memcpy(&record, data, sizeof record);
  if (record.magic != kMagic || record.version != kVersion || record.size != sizeof record ||
      record.crc != record_crc(record) ||
      record.trigger > static_cast<std::uint32_t>(Trigger::lockstep)) {
    return Result::bad_config;
  }
  NodeSettings read;
  NodeConfig& node = read.node;
  auto& core = node.compensator;
  core.model_hash = std::uint64_t{record.model_hash_high} << 32 | record.model_hash_low;
  read.trigger = static_cast<Trigger>(record.trigger);
  node.require_identity = (record.flags & kRequireIdentity) != 0;
  node.use_timestamps = (record.flags & kUseTimestamps) != 0;
  if ((record.flags & kHasKey) != 0) {
    read.table_key = record.table_key;
  }
  visit_numbers(&read, WordReader(record.numbers.data()));
  if (!numbers_are_in_range(read) || !is_usable(node)) {
    return Result::bad_config;
  }
  *settings = read;
  return Result::ok;
}

}  // namespace flexcomp
