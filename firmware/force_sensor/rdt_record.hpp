#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace flexcomp {

/// One datagram of ATI's Raw Data Transfer (RDT), which the Net F/T and the Ethernet Axia send: 36
/// bytes, each number of four bytes, the highest byte first. Facts from ATI's manuals
/// 9620-05-NET FT (chapter 10) and 9610-05-Ethernet Axia (chapter 12).
struct RdtRecord {
  std::uint32_t sequence = 0;          ///< one more in each record of a stream
  std::uint32_t sample = 0;            ///< the sensor's own count
  std::uint32_t status = 0;            ///< 0: nothing is wrong with it
  std::array<std::int32_t, 6> load{};  ///< counts: Fx Fy Fz Tx Ty Tz, sensor frame
};

/// False if the datagram is not one record.
bool read_record(std::string_view datagram, RdtRecord* record);

/// What a sensor is asked for.
enum class RdtCommand : std::uint16_t {
  stop = 0,
  stream = 2,  ///< a record a datagram, until it is stopped
};

using RdtRequest = std::array<char, 8>;

RdtRequest rdt_request(RdtCommand command);

}  // namespace flexcomp
