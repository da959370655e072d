#include "formula/dimensions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "files/one_line.hpp"
#include "formula/functions.hpp"

namespace flexcomp::formula {
namespace {

constexpr double kNothing = 1e-9;

/// A dimension in which that of some names is not known yet: fixed + Σ exponent · unknown.
struct Open {
  Dimension fixed = kPlain;
  std::map<std::size_t, double> unknown;  ///< exponents, by the unknown
};

Open scaled(double factor, Open open) {
  open.fixed = factor * open.fixed;
  for (auto& [index, exponent] : open.unknown) {
    exponent *= factor;
  }
  return open;
}

Open sum(Open a, const Open& b) {
  a.fixed = a.fixed + b.fixed;
  for (const auto& [index, exponent] : b.unknown) {
    a.unknown[index] += exponent;
    if (std::abs(a.unknown[index]) < kNothing) {
      a.unknown.erase(index);
    }
  }
  return a;
}

Open difference(const Open& a, const Open& b) { return sum(a, scaled(-1, b)); }

/// Equations between dimensions, solved one by one: an unknown that an equation tells is replaced
/// by what it is equal to.
class Equations {
 public:
  Open solved(Open open) const {
    for (const auto& [index, value] : solved_) {
      const auto at = open.unknown.find(index);
      if (at != open.unknown.end()) {
        const double exponent = at->second;
        open.unknown.erase(at);
        open = sum(std::move(open), scaled(exponent, value));
      }
    }
    return open;
  }

  /// Takes a = b for true; false where it cannot be.
  bool equate(const Open& a, const Open& b) {
    const Open zero = solved(difference(a, b));
    if (zero.unknown.empty()) {
      return is_same(zero.fixed, kPlain);
    }
    const auto [index, exponent] = *zero.unknown.begin();
    Open value = zero;
    value.unknown.erase(index);
    value = scaled(-1 / exponent, std::move(value));
    for (auto& [other, known] : solved_) {
      const auto at = known.unknown.find(index);
      if (at != known.unknown.end()) {
        const double share = at->second;
        known.unknown.erase(at);
        known = sum(std::move(known), scaled(share, value));
      }
    }
    solved_[index] = std::move(value);
    return true;
  }

 private:
  std::map<std::size_t, Open> solved_;
};

class Checker {
 public:
  Checker(const Formula& formula, const std::vector<std::optional<Dimension>>& known)
      : formula_(formula), known_(known), unknowns_(known.size()) {}

  std::vector<std::optional<Dimension>> run(const Dimension& wanted, const std::string& what) {
    for (const Node& node : formula_.nodes()) {
      all_.push_back(of(node));
    }
    const Open result{wanted, {}};
    if (!equations_.equate(all_.back(), result)) {
      throw FormulaError(
          1, fmt::format("it is in {}; {} needs {}", text_of(all_.back()), what, text_of(result)));
    }
    std::vector<std::optional<Dimension>> found;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      const Open open = equations_.solved({kPlain, {{i, 1.0}}});
      found.push_back(
          known_[i] ? known_[i]
                    : (open.unknown.empty() ? std::optional<Dimension>(open.fixed) : std::nullopt));
    }
    return found;
  }

 private:
  Open of(const Node& node) {
    const std::size_t a = node.operand[0];
    const std::size_t b = node.operand[1];
    switch (node.operation) {
      case Operation::number:
        return node.number == 0 ? Open{kPlain, {{unknowns_++, 1.0}}} : Open{};
      case Operation::name:
        return known_[node.index] ? Open{*known_[node.index], {}}
                                  : Open{kPlain, {{node.index, 1.0}}};
      case Operation::add:
      case Operation::subtract:
        demand_same(a, b);
        return all_[a];
      case Operation::multiply:
        return sum(all_[a], all_[b]);
      case Operation::divide:
        return difference(all_[a], all_[b]);
      case Operation::power:
        return power(a, b);
      case Operation::negate:
        return all_[a];
      case Operation::call:
        return call(node);
    }
    return {};
  }

  Open power(std::size_t base, std::size_t exponent) {
    double value = 0;
    if (is_constant(formula_, exponent, &value) && std::isfinite(value)) {
      return scaled(value, all_[base]);
    }
    demand_plain(exponent, "a power that is no number");
    demand_plain(base, "what is raised to a power that is no number");
    return {};
  }

  Open call(const Node& node) {
    const std::size_t a = node.operand[0];
    const std::size_t b = node.operand[1];
    const Function& function = kFunctions[node.index];
    switch (function.units) {
      case FunctionUnits::of_angle:
        demand_plain(a, fmt::format("the argument of {}", function.name), "an angle (rad)");
        return {};
      case FunctionUnits::of_number:
        demand_plain(a, fmt::format("the argument of {}", function.name));
        return {};
      case FunctionUnits::root:
        return scaled(0.5, all_[a]);
      case FunctionUnits::sign:
        return {};
      case FunctionUnits::same:
        demand_same(a, b);
        return all_[a];
      case FunctionUnits::lag:
        if (!equations_.equate(all_[b], {{0, 0, 1, 0}, {}})) {
          refuse(b, fmt::format("'{}' is in {}; the second argument of lag is a time (s)",
                                quoted(b), text_of(all_[b])));
        }
        return all_[a];
    }
    return {};
  }

  void demand_same(std::size_t a, std::size_t b) {
    if (!equations_.equate(all_[a], all_[b])) {
      refuse(b, fmt::format("'{}' is in {}, but '{}' in {}; expected one unit", quoted(b),
                            text_of(all_[b]), quoted(a), text_of(all_[a])));
    }
  }

  void demand_plain(std::size_t at, const std::string& what,
                    const std::string& wanted = "a plain number or an angle") {
    if (!equations_.equate(all_[at], {})) {
      refuse(at,
             fmt::format("'{}' is in {}; {} is {}", quoted(at), text_of(all_[at]), what, wanted));
    }
  }

  std::string quoted(std::size_t node) const {
    return files::one_line(formula_.text_of(formula_.nodes()[node]), 40);
  }

  std::string text_of(const Open& open) const {
    const Open solved = equations_.solved(open);
    if (solved.unknown.empty() && is_same(solved.fixed, kPlain)) {
      return "rad or a plain number";
    }
    return solved.unknown.empty() ? unit_text(solved.fixed) : "another unit";
  }

  [[noreturn]] void refuse(std::size_t node, const std::string& why) const {
    throw FormulaError(formula_.nodes()[node].begin + 1, why);
  }

  const Formula& formula_;
  const std::vector<std::optional<Dimension>>& known_;
  std::size_t unknowns_;  ///< the names first, then zeros
  std::vector<Open> all_;
  Equations equations_;
};

}  // namespace

std::vector<std::optional<Dimension>> check_dimensions(
    const Formula& formula, const std::vector<std::optional<Dimension>>& known,
    const Dimension& wanted, const std::string& what) {
  return Checker(formula, known).run(wanted, what);
}

}  // namespace flexcomp::formula
