#include "linux/config_lines.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <sstream>

namespace flexcomp {
namespace {

/// Settings of one line; none where it is part of something that several lines say.
std::vector<CLI::ConfigItem> items_of(const std::string& line) {
  try {
    std::istringstream stream(line);
    return CLI::ConfigTOML().from_config(stream);
  } catch (const CLI::Error&) {
    return {};
  }
}

/// The first complaint about a line's item, with its place.
std::optional<std::string> first_complaint(
    const std::string& path,
    const std::function<std::string(const CLI::ConfigItem&, std::size_t line)>& complaint_about) {
  std::ifstream file(path);
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    for (const CLI::ConfigItem& item : items_of(line)) {
      const std::string complaint = complaint_about(item, number);
      if (!complaint.empty()) {
        return fmt::format("{}:{}: {}", path, number, complaint);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> complaint_about_lines(const std::string& path,
                                                 const OptionComplaint& complaint_about) {
  return first_complaint(path, [&](const CLI::ConfigItem& item, std::size_t /*line*/) {
    return item.name.empty() || !item.parents.empty() ? "expected name = value"
                                                      : complaint_about(item.name, item.inputs);
  });
}

std::optional<std::string> complaint_about_repeated_names(const std::string& path) {
  std::map<std::string, std::size_t> lines;
  return first_complaint(path, [&](const CLI::ConfigItem& item, std::size_t line) {
    const auto [before, is_new] = lines.emplace(item.name, line);
    return is_new ? std::string()
                  : fmt::format("{} stands in line {} already", item.name, before->second);
  });
}

std::optional<std::string> complaint_at_line_of_its_option(const std::string& path,
                                                           const std::string& complaint) {
  return first_complaint(path, [&](const CLI::ConfigItem& item, std::size_t /*line*/) {
    const bool is_about_it = complaint.rfind("--" + item.name + ": ", 0) == 0 ||
                             complaint.rfind(item.name + ": ", 0) == 0;
    return is_about_it ? complaint : std::string();
  });
}

}  // namespace flexcomp
