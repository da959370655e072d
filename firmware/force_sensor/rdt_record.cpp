#include "force_sensor/rdt_record.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kRecordSize = 36;
constexpr std::uint16_t kHeader = 0x1234;

std::uint32_t number_at(std::string_view bytes, std::size_t place) {
  std::uint32_t number = 0;
  for (std::size_t i = place; i < place + 4; ++i) {
    number = number << 8U | static_cast<std::uint8_t>(bytes[i]);
  }
  return number;
}

}  // namespace

bool read_record(std::string_view datagram, RdtRecord* record) {
  if (datagram.size() != kRecordSize) {
    return false;
  }
  record->sequence = number_at(datagram, 0);
  record->sample = number_at(datagram, 4);
  record->status = number_at(datagram, 8);
  for (std::size_t i = 0; i < record->load.size(); ++i) {
    record->load[i] = static_cast<std::int32_t>(number_at(datagram, 12 + 4 * i));
  }
  return true;
}

/// Header, command and the number of records, none for no end.
RdtRequest rdt_request(RdtCommand command) {
  const auto number = static_cast<std::uint16_t>(command);
  return {static_cast<char>(kHeader >> 8U), static_cast<char>(kHeader & 0xFFU),
          static_cast<char>(number >> 8U), static_cast<char>(number & 0xFFU)};
}

}  // namespace flexcomp
