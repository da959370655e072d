#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

/// Formulas that a person writes, such as a·sin(q4) + b·v5·|tau5|: read, checked and computed along
/// a course of values. They know no robot: what their names stand for is for others to say.
namespace flexcomp::formula {

/// A formula that cannot be read or whose units disagree. `what()` says what is wrong and what was
/// expected; it is one printable line.
class FormulaError : public std::runtime_error {
 public:
  FormulaError(std::size_t column, const std::string& why)
      : std::runtime_error(why), column_(column) {}

  /// Where in the formula, from 1 on.
  std::size_t column() const { return column_; }

 private:
  std::size_t column_;
};

enum class Operation { number, name, add, subtract, multiply, divide, power, negate, call };

/// One operation of a formula.
struct Node {
  Operation operation = Operation::number;
  std::array<std::size_t, 2> operand = {0, 0};  ///< indices of nodes before it
  double number = 0;
  std::size_t index = 0;  ///< of its name, or of its function (functions.hpp)
  std::size_t begin = 0;  ///< its text: from this byte on
  std::size_t end = 0;    ///< up to this one
};

/// A formula that was read: its operations in the order in which they are computed, the last of
/// which is the result.
class Formula {
 public:
  /// Reads a text: numbers, names, + - * / ^, brackets, and the functions of functions.hpp. `pi` is
  /// a number. Throws FormulaError. A text is at most `kLongest` bytes.
  explicit Formula(std::string text);

  const std::string& text() const { return text_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// The names that it is a function of, in the order of their first appearance.
  const std::vector<std::string>& names() const { return names_; }
  /// Column of a name's first appearance, from 1 on.
  std::size_t column_of(std::size_t name) const;
  /// The text of a node.
  std::string text_of(const Node& node) const {
    return text_.substr(node.begin, node.end - node.begin);
  }

  static constexpr std::size_t kLongest = 1000;

 private:
  std::string text_;
  std::vector<Node> nodes_;
  std::vector<std::string> names_;
};

/// Is it a name that a formula may have: a letter, then letters, digits and underscores?
bool is_name(const std::string& text);

/// A sum or product of numbers alone, of a node and what is below it; false where it is none.
bool is_constant(const Formula& formula, std::size_t node, double* value);

}  // namespace flexcomp::formula
