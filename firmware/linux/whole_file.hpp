#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flexcomp {

/// The whole of a file; nothing if it cannot be read or is empty.
std::optional<std::vector<char>> read_whole(const std::string& path);

/// Written aside and renamed, so that who reads it never sees half, also after a loss of power.
/// Throws std::runtime_error, naming the file.
void write_whole(const std::string& path, const void* data, std::size_t size);

}  // namespace flexcomp
