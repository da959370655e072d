#include "node/node_settings.hpp"

#include <cstring>

#include "core/crc32.hpp"

namespace flexcomp {
namespace {

constexpr std::uint32_t kMagic = 0x31534346;  // "FCS1"
constexpr std::uint32_t kVersion = 2;         // 1 had no key
constexpr std::uint32_t kRequireIdentity = 1;
constexpr std::uint32_t kUseTimestamps = 2;
constexpr std::uint32_t kHasKey = 4;
constexpr std::uint32_t kMostToleratedLosses = 6;

static_assert(sizeof(SettingsRecord) == 4 * 56, "the record is written to files: no padding");

float single(double value) { return static_cast<float>(value); }

std::uint32_t record_crc(const SettingsRecord& record) {
  constexpr std::size_t kBegin = offsetof(SettingsRecord, crc) + sizeof record.crc;
  return crc32(reinterpret_cast<const unsigned char*>(&record) + kBegin, sizeof record - kBegin);
}

}  // namespace

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
  record.ready_ticks = core.ready_ticks;
  record.late_ticks = node.late_ticks;
  record.tolerated_losses = settings.tolerated_losses;
  record.period = core.period;
  record.gain = core.gain;
  record.filter_cutoff = core.filter_cutoff;
  record.force_range = core.force_range;
  record.moment_range = core.moment_range;
  record.setpoint_age_limit = core.setpoint_age_limit;
  record.wrench_age_limit = core.wrench_age_limit;
  for (std::size_t i = 0; i < core.limits.size(); ++i) {
    record.joint_speed[i] = core.joint_speed[static_cast<Eigen::Index>(i)];
    record.limit_value[i] = core.limits[i].value;
    record.limit_rate[i] = core.limits[i].rate;
    record.limit_acceleration[i] = core.limits[i].acceleration;
  }
  record.deflection_limit = core.deflection_limit;
  record.chart_margin = core.chart_margin;
  record.hold_time = core.hold_time;
  record.fade_time = core.fade_time;
  record.deflection_warning = single(node.deflection_warning);
  record.deflection_error = single(node.deflection_error);
  record.heartbeat_period = single(node.heartbeat_period);
  record.force_rate = single(node.wrench.force_rate);
  record.moment_rate = single(node.wrench.moment_rate);
  record.stuck_time = single(node.wrench.stuck_time);
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
      record.trigger > static_cast<std::uint32_t>(Trigger::lockstep) ||
      record.tolerated_losses > kMostToleratedLosses) {
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
  core.ready_ticks = record.ready_ticks;
  node.late_ticks = record.late_ticks;
  read.tolerated_losses = record.tolerated_losses;
  core.period = record.period;
  core.gain = record.gain;
  core.filter_cutoff = record.filter_cutoff;
  core.force_range = record.force_range;
  core.moment_range = record.moment_range;
  core.setpoint_age_limit = record.setpoint_age_limit;
  core.wrench_age_limit = record.wrench_age_limit;
  for (std::size_t i = 0; i < core.limits.size(); ++i) {
    core.joint_speed[static_cast<Eigen::Index>(i)] = record.joint_speed[i];
    core.limits[i] = {record.limit_value[i], record.limit_rate[i], record.limit_acceleration[i]};
  }
  core.deflection_limit = record.deflection_limit;
  core.chart_margin = record.chart_margin;
  core.hold_time = record.hold_time;
  core.fade_time = record.fade_time;
  node.deflection_warning = static_cast<double>(record.deflection_warning);
  node.deflection_error = static_cast<double>(record.deflection_error);
  node.heartbeat_period = static_cast<double>(record.heartbeat_period);
  node.wrench.force_rate = static_cast<double>(record.force_rate);
  node.wrench.moment_rate = static_cast<double>(record.moment_rate);
  node.wrench.stuck_time = static_cast<double>(record.stuck_time);
  if (!is_usable(node)) {
    return Result::bad_config;
  }
  *settings = read;
  return Result::ok;
}

}  // namespace flexcomp
