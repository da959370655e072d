#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace flexcomp::files {

/// The whole of a file. Throws InputError, with the reason, for a file that is missing, a
/// directory, empty, unreadable, or larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit);

/// Same, for text: also refuses a file with NUL bytes, which is binary. The limit is 1 GiB.
std::string read_text(const std::filesystem::path& path);

/// Writes a file through `write`, whole or not at all: to a temporary file in the same folder that
/// replaces `path` when it is complete and on the disk, with the permissions that `path` had.
/// Devices and pipes are written directly. Throws InputError, with the reason, where that fails;
/// the temporary file is removed then, and also if `write` throws.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Writes text, or any bytes, as `write_file` does.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Removes the temporary file of a `write_file` that is under way. For signal handlers: it does
/// nothing that is not allowed there.
void remove_unfinished_file() noexcept;

}  // namespace flexcomp::files
