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

/// Reads a formula; throws FormulaError.
///
/// The grammar is muParser's (https://beltoforion.de/en/muparser). Its own operators and functions
/// are off; those that are on write down what is to be computed. It tells where a text is wrong,
/// takes a compiler half a second, and is in Debian 12, unlike ExprTk.
Parsed parse(const std::string& text);

}  // namespace flexcomp::formula
