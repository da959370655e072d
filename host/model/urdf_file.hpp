#pragma once

#include <urdf_world/types.h>

#include <filesystem>

namespace flexcomp::model {

/// Parses a URDF. Throws InputError for a file that is missing, unreadable, no XML (with the line),
/// holds a value that cannot be read (with the line), or is no URDF (with what urdfdom says of it,
/// which it then does not print).
///
/// Not for several threads at once: urdfdom's messages go through one handler for the process.
urdf::ModelInterfaceSharedPtr read_urdf(const std::filesystem::path& file);

}  // namespace flexcomp::model
