#pragma once

#include <string>

#include "error.hpp"

namespace flexcomp::test {

/// What an action says when it refuses its input; "accepted" if it does not.
template <typename Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace flexcomp::test
