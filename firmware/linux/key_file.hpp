#pragma once

#include <string>

#include "messages/authentication_key.hpp"

namespace flexcomp {

/// Reads a key from a file of 32 hexadecimal digits and at most one line end after them. Throws
/// std::runtime_error, naming the file, if it is anything else or others than its owner may read or
/// write it.
AuthenticationKey read_key(const std::string& path);

}  // namespace flexcomp
