#include "formula/formula.hpp"

#include <cctype>
#include <cmath>

#include "formula/parser.hpp"

namespace flexcomp::formula {
namespace {

bool combine(Operation operation, double a, double b, double* value) {
  switch (operation) {
    case Operation::add:
      *value = a + b;
      return true;
    case Operation::subtract:
      *value = a - b;
      return true;
    case Operation::multiply:
      *value = a * b;
      return true;
    case Operation::divide:
      *value = a / b;
      return true;
    case Operation::power:
      *value = std::pow(a, b);
      return true;
    default:
      return false;
  }
}

}  // namespace

Formula::Formula(std::string text) : text_(std::move(text)) {
  Parsed parsed = parse(text_);
  nodes_ = std::move(parsed.nodes);
  names_ = std::move(parsed.names);
}

std::size_t Formula::column_of(std::size_t name) const {
  for (const Node& node : nodes_) {
    if (node.operation == Operation::name && node.index == name) {
      return node.begin + 1;
    }
  }
  return 1;
}

bool is_name(const std::string& text) {
  bool is_name = !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0;
  for (const char c : text) {
    is_name = is_name && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  }
  return is_name;
}

bool is_constant(const Formula& formula, std::size_t node, double* value) {
  // Nodes stand behind their operands, so that one pass over those before it does.
  const std::vector<Node>& nodes = formula.nodes();
  std::vector<double> known(node + 1, 0);
  std::vector<bool> is_known(node + 1, false);
  for (std::size_t i = 0; i <= node; ++i) {
    const Node& at = nodes[i];
    const std::size_t a = at.operand[0];
    const std::size_t b = at.operand[1];
    if (at.operation == Operation::number) {
      known[i] = at.number;
      is_known[i] = true;
    } else if (at.operation == Operation::negate) {
      known[i] = -known[a];
      is_known[i] = is_known[a];
    } else {
      is_known[i] =
          is_known[a] && is_known[b] && combine(at.operation, known[a], known[b], &known[i]);
    }
  }
  *value = known[node];
  return is_known[node];
}

}  // namespace flexcomp::formula
