#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// A component of a KRL aggregate: X 1.5, IPO_FRAME #BASE, POINT2[] " ".
struct KrlComponent {
  std::string name;              ///< in capitals
  std::optional<double> number;  ///< where its value is one
  std::string word;              ///< else an enumeration or a truth value, in capitals
};

/// A line of KRL without its comment, which a semicolon begins outside of quotation marks.
std::string_view krl_code(std::string_view line);

/// Reads an aggregate such as `{E6POS: X 1,S 2,E1 0.0}`, without its type; nothing if it is none,
/// or if a component's value is computed.
std::optional<std::vector<KrlComponent>> read_krl_aggregate(Scanner* scanner);

/// The component of this name; null if there is none.
const KrlComponent* component_of(const std::vector<KrlComponent>& aggregate, std::string_view name);

}  // namespace flexcomp::programs
