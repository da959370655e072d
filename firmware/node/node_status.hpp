#pragma once

#include <cstdint>

namespace flexcomp {

/// Bits of the node's own status word, beside the compensator's. The lower 12 are faults: each
/// makes the compensator hold and, if it lasts, fade out and latch. The numbers are stable.
enum NodeBit : std::uint16_t {
  kSetpointConflict = 1U << 0,    ///< two senders of setpoints; until reset
  kWrenchConflict = 1U << 1,      ///< two senders of wrenches; until reset
  kWrenchStuck = 1U << 2,         ///< the same bits for too long while the robot moves
  kIdentityMismatch = 1U << 3,    ///< the sender works with another robot, tool or wrench frame
  kTableDamaged = 1U << 4,        ///< the table in use no longer fits its CRC; until a new table
  kTickLate = 1U << 5,            ///< too many ticks late or early in a row
  kBusFault = 1U << 6,            ///< the bus is off or does not take frames
  kOtherNode = 1U << 7,           ///< somebody else sends corrected setpoints; until reset
  kDeflectionTooLarge = 1U << 8,  ///< predicted deflection above the error limit; until reset
  kWrenchSaturated = 1U << 12,    ///< the sensor is at its end: the correction is a lower bound
  kWrenchImplausible = 1U << 13,  ///< changed faster than it can: sample not used
  kSomeLost = 1U << 14,           ///< messages were lost since the last tick, few enough to go on
  kDeflectionWarning = 1U << 15,  ///< predicted deflection above the warning limit
};

constexpr std::uint16_t kNodeFaultBits = 0x0FFF;

/// A few words for a person on one bit; never null.
const char* describe(NodeBit bit);

/// Codes of fault messages, after CANopen's emergency codes; stable numbers.
constexpr std::uint16_t kCompensatorFaultCode = 0x7000;  ///< + bit number in the status word
constexpr std::uint16_t kNodeFaultCode = 0x7100;         ///< + bit number in the node status word
constexpr std::uint16_t kTableInUseCode = 0x7201;        ///< detail: slot
constexpr std::uint16_t kTableRefusedCode = 0x7202;      ///< detail: Result or Reply
constexpr std::uint16_t kConfigInUseCode = 0x7203;
constexpr std::uint16_t kConfigRefusedCode = 0x7204;  ///< detail: Result
constexpr std::uint16_t kRestartCode = 0x7205;  ///< after a fault; detail: where the program was
// Under a key: messages are refused that are forged, not fresh, or come without authentication.
// Each is told when it begins, and when there was none for a second.
constexpr std::uint16_t kForgedCode = 0x7206;
constexpr std::uint16_t kNotFreshCode = 0x7207;
constexpr std::uint16_t kUnauthenticatedCode = 0x7208;

}  // namespace flexcomp
