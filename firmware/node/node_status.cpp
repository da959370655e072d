#include "node/node_status.hpp"

namespace flexcomp {

const char* describe(NodeBit bit) {
  switch (bit) {
    case kSetpointConflict:
      return "two senders of setpoints";
    case kWrenchConflict:
      return "two senders of wrenches";
    case kWrenchStuck:
      return "wrench stuck";
    case kIdentityMismatch:
      return "the sender works with another robot, tool or wrench frame";
    case kTableDamaged:
      return "the table in use is damaged";
    case kTickLate:
      return "ticks late";
    case kBusFault:
      return "bus fault";
    case kOtherNode:
      return "another node sends corrected setpoints";
    case kDeflectionTooLarge:
      return "predicted deflection too large";
    case kWrenchSaturated:
      return "wrench sensor saturated";
    case kWrenchImplausible:
      return "wrench implausible";
    case kSomeLost:
      return "some messages lost";
    case kDeflectionWarning:
      return "predicted deflection above the warning limit";
  }
  return "unknown bit";
}

}  // namespace flexcomp
