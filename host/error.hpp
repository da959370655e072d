#pragma once

#include <stdexcept>

namespace flexcomp {

/// Input or arguments that flexcomp cannot use. `what()` is one line that names the file, the line,
/// column or key, and what was expected there. The command line turns it into exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexcomp
