#include "check/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace flexcomp::check {

const char* word(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    default:
      return "note";
  }
}

bool is_something_wrong(const Checks& checks) {
  return std::any_of(checks.begin(), checks.end(),
                     [](const Check& each) { return each.severity != Severity::note; });
}

void add(Checks more, Checks* checks) {
  checks->insert(checks->end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
}

std::string sentence(const Check& check) {
  return fmt::format("{} ({}): {}. Fix: {}.", word(check.severity), check.name, check.what,
                     check.fix);
}

Checks worst_first(Checks checks) {
  std::stable_sort(checks.begin(), checks.end(),
                   [](const Check& a, const Check& b) { return a.severity < b.severity; });
  return checks;
}

}  // namespace flexcomp::check
