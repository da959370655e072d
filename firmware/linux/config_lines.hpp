#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flexcomp {

/// Says what is wrong with one option and its values; empty if nothing.
using OptionComplaint =
    std::function<std::string(const std::string& name, const std::vector<std::string>& values)>;

/// The first line of a configuration file (name = value, one a line) that cannot stand there, as
/// "file:line: what is wrong"; nothing where each line can. The parser of the whole file does not
/// say where.
std::optional<std::string> complaint_about_lines(const std::string& path,
                                                 const OptionComplaint& complaint_about);

/// The same for a name that stands twice.
std::optional<std::string> complaint_about_repeated_names(const std::string& path);

/// A complaint that begins with "--name: " or "name: ", with the line where that name stands.
std::optional<std::string> complaint_at_line_of_its_option(const std::string& path,
                                                           const std::string& complaint);

}  // namespace flexcomp
