#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flexcomp/types.hpp"
#include "programs/program.hpp"
#include "programs/rapid_aggregate.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// The orientation's speed of all speeddata that a controller has by itself, rad/s: no bound.
constexpr double kFastestRapidTurn = 500 * kDegree;

/// External axes of a target; 9E9 is none.
using RapidAxes = std::array<double, 6>;

/// Where a motion goes to, as a robtarget says it.
struct RapidTarget {
  Pose<double> pose;               ///< m
  RapidAxes external{};            ///< 9E9 is none
  bool has_configuration = false;  ///< another than [0,0,0,0]
};

/// A speeddata.
struct RapidSpeed {
  double feed = 0;  ///< m/s of the TCP
  double turn = 0;  ///< rad/s of the orientation; zero where it does not say
};

/// A work object, and why motions in it cannot be planned; empty where they can.
struct RapidWorkObject {
  Pose<double> frame;  ///< user frame times object frame
  std::string why;
};

/// Declarations of a module, by name in capitals; of arrays by name and number, as PT{2}.
struct RapidData {
  std::map<std::string, RapidTarget> targets;
  std::map<std::string, std::string> configurations;  ///< of targets by name, as they are written
  std::map<std::string, RapidAxes> joints;            ///< external axes of jointtargets
  std::map<std::string, double> numbers;              ///< that nothing changes
  std::map<std::string, RapidSpeed> speeds;
  std::map<std::string, RapidWorkObject> work_objects;
  std::map<std::string, bool> tools;  ///< does the robot hold it?

  /// Reads all declarations of a module, which may stand below the routine that uses them. Numbers,
  /// speeds, work objects and tools that a statement changes are not known then, nor is anything
  /// that two routines declare differently.
  void read_all(std::string_view text);

  /// CONST robtarget p10:=[…]; false if the statement declares nothing. `word` is its first word.
  bool read_declaration(std::string word, Scanner* scanner);

  /// Forgets a target that is changed, or one of an array's.
  void forget_target(const std::string& name);

  /// The name of a target with its number in an array: PT{2}; nothing if that is computed.
  std::optional<std::string> target_name(Scanner* scanner) const;

  /// A target in brackets, by its name, or by Offs or RelTool of one; nothing where it cannot be
  /// told. `depth` counts the Offs and RelTool that it stands in.
  std::optional<RapidTarget> target(Scanner* scanner, int depth = 0) const;

  /// The external axes of a jointtarget in brackets or by its name; nothing where they cannot be
  /// told.
  std::optional<RapidAxes> joint_axes(Scanner* scanner) const;

  /// A number, a constant, or a sum, product or quotient of such; nothing where it cannot be told.
  std::optional<double> number(Scanner* scanner, int depth = 0) const;

  /// A feed by name (v100, vmax), in brackets, or declared; nothing where it cannot be told.
  std::optional<RapidSpeed> speed(Scanner* scanner) const;

 private:
  void declare(const std::string& type, const std::string& name, Scanner* scanner);
  void declare_targets(const std::string& name, Scanner* scanner);
  void declare_work_object(const std::string& name, const std::vector<double>& values,
                           std::string_view text);
  void note_changes(const std::string& statement);
  std::optional<double> factor(Scanner* scanner, int depth) const;
  std::optional<double> product(Scanner* scanner, int depth) const;
  std::optional<RapidTarget> moved(Scanner* scanner, bool is_by_tool, int depth) const;
  bool turn(Scanner* scanner, Matrix3<double>* rotation) const;

  std::map<std::string, std::string> declared_;  ///< what stands behind a name
  std::set<std::string> changed_;                ///< names that a statement sets, or two declare
};

}  // namespace flexcomp::programs
