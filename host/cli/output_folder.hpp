#pragma once

#include <filesystem>
#include <string>

namespace flexcomp::cli {

/// A folder to write results to, made if it is not there. Throws InputError where it cannot be.
std::filesystem::path output_folder(const std::string& folder);

}  // namespace flexcomp::cli
