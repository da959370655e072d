#include "programs/rapid_routines.hpp"

#include <algorithm>

#include "programs/rapid_statements.hpp"
#include "programs/rapid_words.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

/// A statement's words, of which any may be a call or a motion in the line of a condition.
void take_words(const RapidStatement& statement, RapidRoutine* routine) {
  Scanner scanner(statement.text);
  while (!scanner.at_end()) {
    const std::string word = scanner.name();
    if (word.empty()) {
      const std::size_t close = scanner.peek() == '"' ? scanner.rest().find('"', 1) : 0;
      scanner.go_to(scanner.place() + 1 + (close == std::string_view::npos ? 0 : close));
    } else if (is_rapid_motion(word) && word != "MOVEABSJ") {
      routine->motion_line = routine->motion_line == 0 ? statement.line : routine->motion_line;
    } else {
      routine->calls.insert(word);
    }
  }
}

/// Adds the routines that call one of these, or one that does. What stands outside of all counts
/// where there is nothing else.
void add_callers(const RapidRoutines& routines, std::set<std::string>* called) {
  for (std::size_t before = 1; before != 0;) {
    before = 0;
    for (const auto& [name, routine] : routines) {
      const bool is_one = !name.empty() || routines.size() == 1;
      const bool calls = std::any_of(routine.calls.begin(), routine.calls.end(),
                                     [&](const auto& call) { return called->count(call) > 0; });
      before += is_one && calls && called->insert(name).second ? 1 : 0;
    }
  }
}

}  // namespace

std::string rapid_routine_begun(Scanner scanner) {
  std::string word = scanner.name();
  if (word == "LOCAL" || word == "TASK") {
    word = scanner.name();
  }
  if (!begins_rapid_routine(word)) {
    return {};
  }
  const std::string name = scanner.name();
  return word == "FUNC" ? scanner.name() : name;  // FUNC num name
}

RapidRoutines rapid_routines(std::string_view text) {
  RapidRoutines routines;
  RapidRoutine* routine = &routines[""];
  RapidStatements statements(text);
  RapidStatement statement;
  while (statements.next(&statement)) {
    std::string name = rapid_routine_begun(Scanner(statement.text));
    const std::string word = Scanner(statement.text).name();
    if (!name.empty()) {
      while (routines.count(name) > 0) {
        name += " again";  // which nothing can call
      }
      routine = &routines[name];
      routine->begin = statement.begin;
      routine->line = statement.line;
    } else if (ends_rapid_routine(word)) {
      routine = &routines[""];
    }
    take_words(statement, routine);
  }
  return routines;
}

std::set<std::string> moving_routines(const RapidRoutines& routines) {
  std::set<std::string> moving;
  for (const auto& [name, routine] : routines) {
    const bool is_one = !name.empty() || routines.size() == 1;
    if (is_one && routine.motion_line != 0) {
      moving.insert(name);
    }
  }
  add_callers(routines, &moving);
  return moving;
}

std::set<std::string> joint_moving_routines(const RapidRoutines& routines) {
  std::set<std::string> moving = {"MOVEABSJ"};
  add_callers(routines, &moving);
  return moving;
}

std::string first_routine(const RapidRoutines& routines, const std::set<std::string>& moving) {
  if (moving.count("MAIN") > 0) {
    return "MAIN";
  }
  for (const std::string& name : moving) {
    const bool is_called = std::any_of(moving.begin(), moving.end(), [&](const auto& other) {
      return other != name && routines.at(other).calls.count(name) > 0;
    });
    if (!is_called) {
      return name;
    }
  }
  return moving.empty() ? "" : *moving.begin();
}

}  // namespace flexcomp::programs
