#include "cli/joint_names.hpp"

#include <fmt/format.h>

#include <regex>
#include <set>

namespace flexcomp::cli {
namespace {

bool is_its_number(const std::string& name, std::size_t joint) {
  return name == fmt::format("joint_{}", joint) || name == fmt::format("joint{}", joint);
}

}  // namespace

std::string with_joint_names(const std::string& sentence, const model::Robot& robot) {
  static const std::regex mention(
      R"(\b[Jj]oint \d\d?\b|\b[Jj]oints \d\d?(?:, \d\d?)*(?: and \d\d?)?\b)");
  static const std::regex number(R"(\d+)");
  std::string named;
  std::set<std::size_t> told;
  std::size_t copied = 0;
  const std::sregex_iterator end;
  for (std::sregex_iterator at(sentence.begin(), sentence.end(), mention); at != end; ++at) {
    const std::size_t from = static_cast<std::size_t>(at->position());
    const std::string words = at->str();
    for (std::sregex_iterator each(words.begin(), words.end(), number); each != end; ++each) {
      const std::size_t joint = std::stoul(each->str());
      const std::size_t behind = from + static_cast<std::size_t>(each->position() + each->length());
      named += sentence.substr(copied, behind - copied);
      copied = behind;
      if (joint < 1 || joint > robot.joint_names.size() || !told.insert(joint).second) {
        continue;
      }
      const std::string& name = robot.joint_names[joint - 1];
      named += is_its_number(name, joint) ? "" : fmt::format(" ({})", name);
    }
  }
  return named + sentence.substr(copied);
}

}  // namespace flexcomp::cli
