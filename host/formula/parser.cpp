#include "formula/parser.hpp"

#include <fmt/format.h>
#include <muParserBase.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "files/one_line.hpp"
#include "formula/functions.hpp"

namespace flexcomp::formula {
namespace {

constexpr const char* kNameCharacters =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr const char* kOperators = "+-*/^";
constexpr std::size_t kMostDeep = 100;  // brackets in brackets

bool is_part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_part_of_number(char c) { return is_part_of_name(c) || c == '.'; }

/// A formula being read. muParser hands numbers from operator to operator: here they are indices of
/// nodes. Its operators take nothing but those numbers, so that the formula that a thread reads is
/// known to the thread.
struct Reading {
  std::string text;                  ///< without spaces that mean nothing
  std::vector<std::size_t> columns;  ///< of the text's bytes, and of its end, in the given text
  Parsed parsed;
};

thread_local Reading* reading = nullptr;

/// Makes a formula the one that this thread reads.
class Hold {
 public:
  explicit Hold(Reading* held) : before_(reading) { reading = held; }
  ~Hold() { reading = before_; }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  Reading* before_;
};

double written_down(const Node& node) {
  reading->parsed.nodes.push_back(node);
  return static_cast<double>(reading->parsed.nodes.size() - 1);
}

std::size_t index_of(double handle) { return static_cast<std::size_t>(handle); }

const Node& node_of(double handle) { return reading->parsed.nodes[index_of(handle)]; }

/// The bracket that closes the one at `open`.
std::size_t closing(std::size_t open) {
  const std::string& text = reading->text;
  std::size_t depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : 0;
    depth -= text[i] == ')' ? 1 : 0;
    if (depth == 0) {
      return i;
    }
  }
  return text.size();
}

/// Widens a piece of the text until as many brackets open in it as close.
void balance(Node* node) {
  const std::string& text = reading->text;
  std::size_t open = 0;
  for (std::size_t i = node->begin; i < node->end; ++i) {
    if (text[i] == '(') {
      ++open;
    } else if (text[i] == ')' && open > 0) {
      --open;
    } else if (text[i] == ')' && node->begin > 0) {
      node->begin = std::min(text.rfind('(', node->begin - 1), node->begin);
    }
  }
  for (; open > 0; --open) {
    node->end = std::min(text.find(')', node->end), text.size() - 1) + 1;
  }
}

template <Operation operation>
double binary(double a, double b) {
  Node node{operation, {index_of(a), index_of(b)}, 0, 0, node_of(a).begin, node_of(b).end};
  balance(&node);
  return written_down(node);
}

double negated(double a) {
  const std::size_t inner = node_of(a).begin;
  const std::size_t sign = inner > 0 ? reading->text.rfind('-', inner - 1) : 0;
  Node node{Operation::negate, {index_of(a), index_of(a)}, 0, 0, std::min(sign, inner),
            node_of(a).end};
  balance(&node);
  return written_down(node);
}

double plus(double a) { return a; }

template <std::size_t function>
double call(double a, double b) {
  const std::string name = std::string(kFunctions[function].name) + "(";
  const std::size_t inner = node_of(a).begin;
  const std::size_t begin =
      std::min(inner > 0 ? reading->text.rfind(name, inner - 1) : inner, inner);
  const std::size_t end = std::min(closing(begin + name.size() - 1), reading->text.size() - 1) + 1;
  return written_down({Operation::call, {index_of(a), index_of(b)}, 0, function, begin, end});
}

template <std::size_t function>
double call_of_one(double a) {
  return call<function>(a, a);
}

std::size_t function_named(const std::string& name) {
  const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                         [&](const Function& each) { return each.name == name; });
  return static_cast<std::size_t>(found - kFunctions.begin());
}

std::string all_functions() {
  std::string all;
  for (const Function& each : kFunctions) {
    all += fmt::format("{}{}", all.empty() ? "" : " ", each.name);
  }
  return all;
}

std::size_t column_at(std::size_t byte) {
  return reading->columns[std::min(byte, reading->text.size())] + 1;
}

[[noreturn]] void refuse(std::size_t byte, const std::string& why) {
  throw FormulaError(column_at(byte), why);
}

double name_node(const std::string& name, std::size_t begin) {
  if (name == "pi") {
    return written_down({Operation::number, {0, 0}, M_PI, 0, begin, begin + name.size()});
  }
  std::vector<std::string>& names = reading->parsed.names;
  const auto at = std::find(names.begin(), names.end(), name);
  const auto index = static_cast<std::size_t>(at - names.begin());
  if (at == names.end()) {
    names.push_back(name);
  }
  return written_down({Operation::name, {0, 0}, 0, index, begin, begin + name.size()});
}

/// muParser asks here first what stands at `text`, `position` bytes behind the beginning; a number
/// or a name is taken, with the length that it has.
int take(const char* text, int* position, double* handle) {
  const auto begin = static_cast<std::size_t>(*position);
  const std::string& whole = reading->text;
  std::size_t end = begin;
  if (std::isdigit(static_cast<unsigned char>(*text)) != 0 || *text == '.') {
    double value = 0;
    const char* const last = whole.data() + whole.size();
    const auto [after, error] = std::from_chars(whole.data() + begin, last, value);
    end = static_cast<std::size_t>(after - whole.data());
    if (error != std::errc() || !std::isfinite(value)) {
      refuse(begin, "expected a number, such as 0.5 or 1.2e-6");
    }
    *handle = written_down({Operation::number, {0, 0}, value, 0, begin, end});
  } else if (std::isalpha(static_cast<unsigned char>(*text)) != 0) {
    while (end < whole.size() && is_part_of_name(whole[end])) {
      ++end;
    }
    const std::string name = whole.substr(begin, end - begin);
    const bool is_called = end < whole.size() && whole[end] == '(';
    const bool is_function = function_named(name) < kFunctions.size();
    if (is_called && is_function) {
      return 0;
    }
    if (is_called) {
      refuse(begin, fmt::format("'{}' is no function; expected one of: {}", files::one_line(name),
                                all_functions()));
    }
    if (is_function) {
      refuse(begin, fmt::format("'{}' is a function; expected ( behind it", name));
    }
    *handle = name_node(name, begin);
  } else {
    return 0;
  }
  *position = static_cast<int>(end);
  return 1;
}

/// The grammar of formulas, on muParser's parser.
class Grammar : public mu::ParserBase {
 public:
  Grammar() {
    Grammar::InitCharSets();
    Grammar::InitOprt();
    Grammar::InitFun();
    AddValIdent(take);
  }

 private:
  void InitCharSets() override {
    DefineNameChars(kNameCharacters);
    DefineOprtChars(kOperators);
    DefineInfixOprtChars(kOperators);
  }

  void InitConst() override {}

  void InitOprt() override {
    EnableBuiltInOprt(false);
    EnableOptimizer(false);
    DefineOprt("+", binary<Operation::add>, mu::prADD_SUB);
    DefineOprt("-", binary<Operation::subtract>, mu::prADD_SUB);
    DefineOprt("*", binary<Operation::multiply>, mu::prMUL_DIV);
    DefineOprt("/", binary<Operation::divide>, mu::prMUL_DIV);
    DefineOprt("^", binary<Operation::power>, mu::prPOW, mu::oaRIGHT);
    DefineInfixOprt("-", negated, mu::prINFIX, false);
    DefineInfixOprt("+", plus, mu::prINFIX, false);
  }

  template <std::size_t function>
  void define() {
    if (kFunctions[function].arguments == 1) {
      DefineFun(kFunctions[function].name, call_of_one<function>, false);
    } else {
      DefineFun(kFunctions[function].name, call<function>, false);
    }
  }

  template <std::size_t... functions>
  void define_all(std::index_sequence<functions...> /*all*/) {
    (define<functions>(), ...);
  }

  void InitFun() override { define_all(std::make_index_sequence<kFunctions.size()>()); }
};

/// Refuses what no formula holds before muParser sees it, so that of its grammar only what is meant
/// is used; leaves out spaces but between words, where they would join.
Reading prepared(const std::string& text) {
  Reading ready;
  std::size_t depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ') {
      const std::size_t next = text.find_first_not_of(' ', i);
      const bool joins = !ready.text.empty() && is_part_of_number(ready.text.back()) &&
                         next != std::string::npos && is_part_of_number(text[next]);
      if (joins && next == i + 1) {
        throw FormulaError(next + 1, "expected an operator (+ - * / ^) between two values");
      }
      continue;
    }
    if (!is_part_of_number(c) && std::string("+-*/^(),").find(c) == std::string::npos) {
      throw FormulaError(
          i + 1, fmt::format("unexpected '{}'; expected numbers, names, + - * / ^ ( ) and ,",
                             files::one_line(text.substr(i, 1))));
    }
    depth += c == '(' ? 1 : 0;
    depth -= c == ')' && depth > 0 ? 1 : 0;
    if (depth > kMostDeep) {
      throw FormulaError(i + 1, fmt::format("expected at most {} brackets in brackets", kMostDeep));
    }
    ready.text += c;
    ready.columns.push_back(i);
  }
  ready.columns.push_back(text.size());
  return ready;
}

std::string expectation(const mu::ParserError& error) {
  const std::string token = files::one_line(error.GetToken());
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return "it ends here; expected a number, a name or (";
    case mu::ecUNEXPECTED_ARG_SEP:
      return "unexpected ','; expected it between the arguments of a function";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "expected an operator (+ - * / ^) between two values";
    case mu::ecUNEXPECTED_PARENS:
      return "unexpected bracket; expected a value or an operator";
    case mu::ecMISSING_PARENS:
      return "expected a closing bracket )";
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS: {
      const std::size_t function = function_named(token);
      const std::size_t count = function < kFunctions.size() ? kFunctions[function].arguments : 1;
      return fmt::format("{} takes {} argument{}", token, count, count == 1 ? "" : "s");
    }
    default:
      return "expected a number, a name, an operator (+ - * / ^) or a bracket";
  }
}

}  // namespace

Parsed parse(const std::string& text) {
  if (text.size() > Formula::kLongest) {
    throw FormulaError(Formula::kLongest + 1,
                       fmt::format("expected at most {} characters", Formula::kLongest));
  }
  Reading ready = prepared(text);
  if (ready.text.empty()) {
    throw FormulaError(1, "expected a formula, found nothing");
  }
  const Hold hold(&ready);
  try {
    Grammar grammar;
    grammar.SetExpr(ready.text);
    int results = 0;
    grammar.Eval(results);
    if (results != 1) {
      refuse(ready.text.find(','), "expected one value, without ','");
    }
  } catch (const mu::ParserError& error) {
    const int at = error.GetPos();
    refuse(at > 0 ? static_cast<std::size_t>(at) : 0, expectation(error));
  }
  for (Node& node : ready.parsed.nodes) {
    node.begin = ready.columns[std::min(node.begin, ready.text.size())];
    node.end = node.end == 0 ? 0 : ready.columns[std::min(node.end, ready.text.size()) - 1] + 1;
  }
  return std::move(ready.parsed);
}

}  // namespace flexcomp::formula
