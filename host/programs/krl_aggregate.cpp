#include "programs/krl_aggregate.hpp"

#include <algorithm>

namespace flexcomp::programs {
namespace {

/// Passes over what stands between two marks; false where the second is missing.
bool pass_text(char mark, Scanner* scanner) {
  const std::size_t close = scanner->rest().find(mark);
  if (close == std::string_view::npos) {
    return false;
  }
  scanner->go_to(scanner->place() + close + 1);
  return true;
}

/// An enumeration (#NONE), a truth value, a text in marks, or bits ('B010').
bool read_word(Scanner* scanner, std::string* word) {
  for (const char mark : {'"', '\''}) {
    if (scanner->take(mark)) {
      return pass_text(mark, scanner);
    }
  }
  scanner->take('#');
  *word = scanner->name();
  return !word->empty();
}

}  // namespace

std::string_view krl_code(std::string_view line) {
  bool is_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    is_text = is_text != (line[i] == '"');
    if (line[i] == ';' && !is_text) {
      return line.substr(0, i);
    }
  }
  return line;
}

std::optional<std::vector<KrlComponent>> read_krl_aggregate(Scanner* scanner) {
  if (!scanner->take('{')) {
    return std::nullopt;
  }
  std::vector<KrlComponent> aggregate;
  bool may_be_type = true;
  while (!scanner->take('}')) {
    KrlComponent component;
    component.name = scanner->name();
    if (component.name.empty()) {
      return std::nullopt;
    }
    const bool is_type = may_be_type && scanner->take(':');
    may_be_type = false;
    if (is_type) {
      continue;
    }
    if (scanner->take('[') && !scanner->take(']')) {
      return std::nullopt;
    }
    component.number = scanner->number();
    if (!component.number && !read_word(scanner, &component.word)) {
      return std::nullopt;
    }
    aggregate.push_back(std::move(component));
    if (!scanner->take(',') && scanner->peek() != '}') {
      return std::nullopt;
    }
  }
  return aggregate;
}

const KrlComponent* component_of(const std::vector<KrlComponent>& aggregate,
                                 std::string_view name) {
  const auto found = std::find_if(aggregate.begin(), aggregate.end(),
                                  [&](const KrlComponent& each) { return each.name == name; });
  return found == aggregate.end() ? nullptr : &*found;
}

}  // namespace flexcomp::programs
