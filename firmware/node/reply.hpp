#pragma once

#include <cstdint>

namespace flexcomp {

/// A few words for a person on the answer to a command or a transfer: a Result or a Reply; never
/// null.
const char* describe_reply(std::uint8_t reply);

}  // namespace flexcomp
