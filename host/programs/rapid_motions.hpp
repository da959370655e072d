#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "programs/nesting.hpp"
#include "programs/program.hpp"
#include "programs/rapid_statements.hpp"
#include "programs/rapid_values.hpp"

namespace flexcomp::programs {

/// Reads MoveJ, MoveL and MoveC with all that stands in them, and what changes how the motions
/// behind it are made. Refuses with the line what is not read.
class RapidMotions {
 public:
  /// All of these live as long as this. `statement` is the one that is read.
  RapidMotions(Program* program, const RapidData* data, const RapidStatement* statement,
               Nesting* nesting)
      : program_(*program), data_(data), statement_(statement), nesting_(nesting) {}

  /// VelSet, PDispSet and the like; false for a word that is none of these.
  bool set(const std::string& word, Scanner* scanner);

  /// Whatever routine it stands in, the motions behind are not known.
  void doubt(const std::string& why);

  void read(const std::string& word, Scanner* scanner);

  /// A motion to a point in joint angles (MoveAbsJ): nothing is planned.
  void pass_joints(Scanner* scanner);

  /// Is the statement in the line of another one? The writer could not tell them apart.
  void stand_within(bool is_within) { is_within_ = is_within; }

 private:
  struct Speed {
    double feed = 0;             ///< m/s; zero where the module does not tell it
    double turn = 0;             ///< rad/s; zero where nothing bounds it
    std::optional<double> time;  ///< s, of the whole motion
  };

  [[noreturn]] void fail(const std::string& why) const {
    refuse(program_.file, statement_->line, why);
  }
  [[noreturn]] void refuse_option(const std::string& option) const;
  void note(const std::string& text) { program_.notes.push_back({statement_->line, text}); }
  void leave_out(const std::string& why);
  void set_orientation_mode(const std::string& word, Scanner* scanner);
  void end_mode(const std::string& name);
  void refuse_hidden(const std::string& word);
  void pass_options(std::initializer_list<std::string_view> known, Scanner* scanner) const;
  static std::optional<std::string> next_option(Scanner* scanner);
  Speed read_speed(Scanner* scanner);
  void read_zone(Scanner* scanner);
  void read_tool(Scanner* scanner);
  void set_tool(const std::string& name);
  void set_work_object(const std::string& name);
  void set_frame(const std::string& name);
  void meet(const RapidTarget& target);
  void add(const std::string& word, const std::optional<RapidTarget>& between,
           const Pose<double>& end, const Speed& speed);
  void set_feed(const Speed& speed, Motion* motion) const;

  static constexpr double kFastest = 1e6;  // m/s: no limit

  Program& program_;
  const RapidData* data_;
  const RapidStatement* statement_;
  Nesting* nesting_;
  std::string work_object_;
  std::string tool_;
  std::array<std::optional<double>, 6> external_{};  ///< where motions are planned
  std::array<std::optional<double>, 6> left_at_{};   ///< where what is left out sends them
  std::size_t left_in_ = 0;                          ///< line of that
  double override_ = 1;                              ///< VelSet
  double most_ = kFastest;
  std::optional<Doubt> doubt_;
  std::map<std::string, Doubt> modes_;  ///< by name: PDISP, EOFFS, SINGAREA, CIRPATHMODE
  bool has_told_of_posture_ = false;
  bool is_lost_ = true;
  std::size_t lost_in_ = 0;  ///< line
  bool is_within_ = false;
};

}  // namespace flexcomp::programs
