#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>

namespace flexcomp::model {

/// Parses a file of one YAML document. Throws InputError for one that is missing, unreadable, not
/// YAML (with the line), or goes on after the document.
YAML::Node read_yaml(const std::filesystem::path& file);

}  // namespace flexcomp::model
