#pragma once

#include <string>
#include <vector>

#include "formula/formula.hpp"

namespace flexcomp::formula {

/// A formula's operations and names, as they stand in its text.
struct Parsed {
  std::vector<Node> nodes;
  std::vector<std::string> names;
};

/// Reads a formula; throws FormulaError. The grammar is muParser's
/// (https://beltoforion.de/en/muparser), whose operators and functions are bound to ones that write
/// down what is to be computed.
Parsed parse(const std::string& text);

}  // namespace flexcomp::formula
