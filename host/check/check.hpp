#pragma once

#include <string>
#include <vector>

namespace flexcomp::check {

/// error: what follows from it will be wrong. warning: suspicious, a person should look. note:
/// worth knowing, nothing is wrong.
enum class Severity { error, warning, note };

/// One thing that is wrong or suspicious in what was given, in a person's words.
struct Check {
  Severity severity;
  std::string about;  ///< model, recording, path, table or config
  std::string name;   ///< stable, for programs: units.position
  std::string what;   ///< one plain sentence
  std::string fix;    ///< one plain sentence
};

using Checks = std::vector<Check>;

/// error, warning or note.
const char* word(Severity severity);

/// Is there more than notes?
bool is_something_wrong(const Checks& checks);

/// Appends.
void add(Checks more, Checks* checks);

/// "error (units.position): what. Fix: fix." on a line.
std::string sentence(const Check& check);

/// The errors first, then the warnings, then the notes; in their order within each.
Checks worst_first(Checks checks);

}  // namespace flexcomp::check
