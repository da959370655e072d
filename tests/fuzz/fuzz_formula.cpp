// Any text as a formula: refused at a column in one line, or computed without harm, with units that
// are read again as they were written.
//
// Input: the formula, a line end, the unit of its result.
#include <string>

#include "byte_source.hpp"
#include "formula/course.hpp"
#include "formula/dimensions.hpp"
#include "formula/proportion.hpp"

using namespace flexcomp::formula;
using flexcomp::fuzz::expect;

namespace {

void check_complaint(const FormulaError& error, std::size_t longest) {
  expect(error.column() >= 1 && error.column() <= longest + 1,
         "a complaint's column is in the text");
  for (const char* c = error.what(); *c != 0; ++c) {
    expect(static_cast<unsigned char>(*c) >= 0x20, "a complaint is one line");
  }
}

void use(const std::string& text, const std::string& unit) {
  const Formula formula(text);
  for (const Node& node : formula.nodes()) {
    expect(node.begin < node.end && node.end <= text.size(), "every operation has its text");
  }
  std::vector<std::size_t> names;
  for (std::size_t i = 0; i < formula.names().size(); ++i) {
    expect(is_name(formula.names()[i]), "a name is a name");
    names.push_back(i);
  }
  in_proportion(formula, names);
  Course course(formula);
  for (int row = 0; row < 3; ++row) {
    course.next(std::vector<double>(names.size(), row - 0.5), 0.01 * row);
  }
  const Dimension wanted = dimension_of(unit);
  expect(is_same(dimension_of(unit_text(wanted)), wanted), "a unit is read as it is written");
  check_dimensions(formula, std::vector<std::optional<Dimension>>(names.size()), wanted, "it");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find('\n'), bytes.size());
  const std::string text = bytes.substr(0, end);
  const std::string unit = end < bytes.size() ? bytes.substr(end + 1) : "1";
  try {
    use(text, unit);
  } catch (const FormulaError& error) {
    check_complaint(error, std::max({text.size(), 2 * unit.size(), Formula::kLongest}));
  }
  return 0;
}
