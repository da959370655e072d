#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flexcomp {

/// The whole of an ordinary file; nothing if there is no such file. Never waits for another process
/// (a FIFO, a device) and never takes more memory than `most` bytes and one. Throws
/// std::runtime_error, naming the file, if it is not an ordinary one, holds more than `most` bytes
/// or cannot be read.
std::optional<std::vector<char>> read_whole(const std::string& path, std::size_t most);

/// Written aside (path + ".new") and renamed, so that who reads it never sees half, also after a
/// loss of power. What stands aside already is written over if it is an ordinary file. Never waits
/// for another process, but for the disk. Throws std::runtime_error, naming the file.
///
/// `readers`: a secret is for its owner alone, also where a file stood aside that others may read.
enum class Readers { all, owner };
void write_whole(const std::string& path, const void* data, std::size_t size,
                 Readers readers = Readers::all);

}  // namespace flexcomp
