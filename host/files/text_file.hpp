#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace flexcomp::files {

/// The whole of a file or of what a pipe delivers. Throws InputError, with the reason, for a file
/// that is missing, a directory, a device, empty, unreadable, or larger than `limit` bytes, before
/// more than that has been read.
std::string read_file(const std::filesystem::path& path, std::size_t limit);

/// Longest recording or log, and longest file that a person writes.
constexpr std::size_t kLargestRecording = std::size_t{1} << 30;
constexpr std::size_t kLargestDescription = std::size_t{16} << 20;

/// Same, for text: also refuses a file with NUL bytes, which is binary.
std::string read_text(const std::filesystem::path& path, std::size_t limit = kLargestRecording);

/// Writes a file through `write`, whole or not at all: to a temporary file in the same folder that
/// replaces `path` when it is complete and on the disk, with the permissions that `path` had.
/// Devices and pipes are written directly. Throws InputError, with the reason, where that fails;
/// the temporary file is removed then, and also if `write` throws.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Writes text, or any bytes, as `write_file` does.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Writes several files, up to eight, as `write_text` does: all are complete and on the disk before
/// the first takes its place, so that what cannot be written, or a full disk, leaves all as they
/// were.
void write_texts(const std::vector<std::pair<std::filesystem::path, std::string>>& texts);

/// Removes the temporary files of writes that are under way. For signal handlers: it does
/// nothing that is not allowed there.
void remove_unfinished_file() noexcept;

}  // namespace flexcomp::files
