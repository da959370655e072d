#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexcomp/types.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// The numbers of a RAPID aggregate such as [[1,2,3],[1,0,0,0]], brackets, truth values and texts
/// left out; nothing if anything else stands in it.
std::optional<std::vector<double>> read_rapid_numbers(Scanner* scanner);

/// The parts of a target in brackets behind its place and orientation, ",[0,0,0,0],[9E9,…]" as they
/// stand; those of a target without any if there are none.
std::string rapid_configuration(std::string_view target);

/// Declarations of a module, by name in capitals.
struct RapidData {
  std::map<std::string, Pose<double>> targets;        ///< robtargets, m
  std::map<std::string, std::string> configurations;  ///< of targets by name, as they are written
  std::map<std::string, double> speeds;               ///< m/s of the TCP
  std::map<std::string, Pose<double>> frames;  ///< work objects: user frame times object frame

  /// CONST robtarget p10:=[…]; false if the statement declares nothing. `word` is its first word.
  bool read_declaration(std::string word, Scanner* scanner);

  /// A target in brackets, by its name, or by Offs or RelTool of one; nothing where it cannot be
  /// told. `depth` counts the Offs and RelTool that it stands in.
  std::optional<Pose<double>> target(Scanner* scanner, int depth = 0) const;

  /// A feed by name (v100, vmax), in brackets, or declared; nothing where it cannot be told.
  std::optional<double> speed(Scanner* scanner) const;
};

}  // namespace flexcomp::programs
