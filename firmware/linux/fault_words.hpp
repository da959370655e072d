#pragma once

#include <string>

#include "flexcomp/compensator.hpp"
#include "node/node_status.hpp"

namespace flexcomp {

/// The faults of status words, or of latched ones, in words; empty where there is none. A fault of
/// the node comes to the core as one "reported by the caller", which is left out beside it.
inline std::string fault_words(std::uint32_t status, std::uint16_t node_status) {
  if ((node_status & kNodeFaultBits) != 0) {
    status &= ~static_cast<std::uint32_t>(kExternalFault);
  }
  std::string text;
  const auto add = [&](const char* words) {
    text += (text.empty() ? "" : ", ") + std::string(words);
  };
  for (std::uint32_t bit = 1; (bit & kFaultBits) != 0; bit <<= 1) {
    if ((status & bit) != 0) {
      add(describe(static_cast<StatusBit>(bit)));
    }
    if ((node_status & kNodeFaultBits & bit) != 0) {
      add(describe(static_cast<NodeBit>(bit)));
    }
  }
  return text;
}

}  // namespace flexcomp
