#pragma once

#include <array>
#include <optional>
#include <string>

#include "programs/krl_data.hpp"
#include "programs/program.hpp"

namespace flexcomp::programs {

/// What a motion is made with.
struct KrlState {
  double feed = 0;                  ///< m/s; zero where the program does not say
  std::array<double, 2> turning{};  ///< $VEL.ORI1 and ORI2, rad/s; zero where it does not say
  double override = 1;              ///< $OV_PRO as a share
  KrlFrame base;
  KrlFrame tool;
  bool is_on_tool = false;

  /// The orientation turns so fast at most, rad/s; zero where the program does not say. Which of
  /// the two speeds holds for a turn is told by how it goes: the slower one is right for each.
  double turn_feed() const;
};

/// Follows what a KRL program sets for the motions behind it: feed, base, tool and how the way
/// between two points is made. Refuses with the line what would make two frames or tools of one,
/// or another way than the one that is planned.
class KrlSettings {
 public:
  KrlSettings(Program* program, const KrlData* data) : program_(*program), data_(*data) {}

  /// Would a statement change how motions behind it are made? `word` is its first word.
  static bool is_setting(const std::string& word, Scanner scanner);

  /// Takes what stands behind `name =` of a setting.
  void assign(const std::string& name, std::size_t line, Scanner* scanner);

  /// BAS(#BASE,2), BAS(#CP_PARAMS,0.2) and the like.
  void call_bas(std::size_t line, Scanner* scanner);

  /// What a motion is made with that says something for itself: WITH $VEL.CP=0.1, $BASE=SBASE(2).
  /// The word WITH is taken already.
  KrlState with(std::size_t line, Scanner* scanner);

  const KrlState& state() const { return state_; }

  /// Notes the frame of the first motion; refuses another one of those behind it.
  void meet(const KrlState& state, std::size_t line);

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& why) const {
    refuse(program_.file, line, why);
  }
  void note(std::size_t line, const std::string& text) { program_.notes.push_back({line, text}); }
  KrlReadNumber read_speed(std::size_t line, Scanner* scanner) const;
  void set_feed(const std::optional<double>& feed, std::size_t line, KrlState* state);
  void set_turning(std::size_t which, const KrlReadNumber& speed, std::size_t line);
  void refuse_behind_speed(std::size_t line, Scanner* scanner) const;
  void read_speeds(std::size_t line, Scanner* scanner);
  void set_override(std::size_t line, Scanner* scanner);
  KrlFrame read_frame(const std::string& name, std::size_t line, Scanner* scanner);
  void set_base(KrlFrame frame, std::size_t line);
  void set_tool(KrlFrame frame, std::size_t line);
  void set_mode(const std::string& name, std::size_t line, Scanner* scanner);
  void load(std::size_t line);
  void set_of_motion(const std::string& name, std::size_t line, Scanner* scanner, KrlState* state);

  Program& program_;
  const KrlData& data_;
  KrlState state_;
  std::optional<KrlState> first_;           ///< of the first motion
  std::optional<KrlFrameData> frame_data_;  ///< FDAT_ACT
  std::string why_no_path_;                 ///< of LDAT_ACT
  bool has_told_of_tool_ = false;
};

}  // namespace flexcomp::programs
