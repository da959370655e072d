#include "programs/rapid_aggregate.hpp"

#include "files/one_line.hpp"

namespace flexcomp::programs {

std::optional<std::vector<double>> read_rapid_numbers(Scanner* scanner) {
  std::vector<double> numbers;
  int depth = 0;
  do {
    if (scanner->take('[')) {
      ++depth;
    } else if (scanner->take(']')) {
      --depth;
      if (depth > 0) {
        scanner->take(',');
      }
    } else if (scanner->take('"')) {
      const std::size_t close = scanner->rest().find('"');
      if (close == std::string_view::npos) {
        return std::nullopt;
      }
      scanner->go_to(scanner->place() + close + 1);
      scanner->take(',');
    } else if (const std::optional<double> number = scanner->number()) {
      numbers.push_back(*number);
      scanner->take(',');
    } else {
      const std::string word = scanner->name();
      if (word != "TRUE" && word != "FALSE") {
        return std::nullopt;
      }
      scanner->take(',');
    }
  } while (depth > 0 && numbers.size() < 1000);
  return numbers;
}

std::string rapid_configuration(std::string_view target) {
  std::size_t at = target.find(']');
  at = at == std::string_view::npos ? at : target.find(']', at + 1);
  const std::size_t end = target.rfind(']');
  if (at == std::string_view::npos || end <= at + 1 ||
      target.substr(at + 1).find('[') == std::string_view::npos) {
    return ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]";
  }
  return files::one_line(target.substr(at + 1, end - at - 1), 200);
}

}  // namespace flexcomp::programs
