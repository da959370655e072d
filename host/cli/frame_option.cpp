#include "cli/frame_option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "error.hpp"
#include "model/frame_numbers.hpp"
#include "model/whole_turn.hpp"

namespace flexcomp::cli {

CLI::Option* add_frame(CLI::App* command, std::vector<double>* frame) {
  return add_frame(command, "--frame", "work frame in the base frame", frame);
}

CLI::Option* add_frame(CLI::App* command, const std::string& name, const std::string& what,
                       std::vector<double>* frame) {
  return command->add_option(name, *frame, what + ": x,y,z[,roll,pitch,yaw], m and rad")
      ->delimiter(',')
      ->expected(1, 6)
      ->type_name("X,Y,Z[,R,P,Y]");
}

std::optional<Pose<double>> frame_of(const std::vector<double>& numbers,
                                     const std::string& option) {
  if (numbers.empty()) {
    return std::nullopt;
  }
  const bool is_finite =
      std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); });
  if ((numbers.size() != 3 && numbers.size() != 6) || !is_finite) {
    throw InputError(option + ": expected x,y,z or x,y,z,roll,pitch,yaw");
  }
  constexpr double kFar = 50;  // m: no robot reaches a tenth of it
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i < 3 ? std::abs(numbers[i]) > kFar : model::is_beyond_a_turn(numbers[i])) {
      throw InputError(fmt::format("{}: expected {}, found {:g}", option,
                                   i < 3 ? "metres" : "radians", numbers[i]));
    }
  }
  std::array<double, 6> all{};
  std::copy(numbers.begin(), numbers.end(), all.begin());
  return model::frame_of_numbers(all);
}

}  // namespace flexcomp::cli
