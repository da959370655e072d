#include "cli/output_folder.hpp"

#include <fmt/format.h>

#include "error.hpp"

namespace flexcomp::cli {

std::filesystem::path output_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made a folder: {}", folder, error.message()));
  }
  return folder;
}

}  // namespace flexcomp::cli
