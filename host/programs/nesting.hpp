#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace flexcomp::programs {

constexpr const char* kInBranch =
    "a motion in a branch or a loop: whether it is run cannot be told";

constexpr const char* kInSecondRoutine =
    "a motion in a second routine: when it is called cannot be told";

/// Something that leaves it open whether, or how, the motions behind it are run.
struct Doubt {
  std::size_t line = 0;
  std::string why;
};

/// Where the statement that is read stands: in which routine of a KRL or RAPID program, and in how
/// many branches and loops of it. Motions are read in one routine, outside of these.
class Nesting {
 public:
  void begin_routine() {
    ++routine_;
    depth_ = 0;
    is_over_ = false;
    doubt_.reset();
  }
  void open() { ++depth_; }
  void close() { depth_ -= depth_ > 0 ? 1 : 0; }
  bool is_inside() const { return depth_ > 0; }
  int depth() const { return depth_; }
  /// Is what stands here run, and once?
  bool is_surely_run() const { return depth_ == 0 && !doubt_; }

  /// What stands behind in the routine is not run: RETURN outside of branches, END.
  void end_run() { is_over_ = true; }
  bool is_over() const { return is_over_; }

  /// Of the motions behind in the routine; the first doubt is kept.
  void doubt(std::size_t line, const std::string& why) {
    if (!doubt_) {
      doubt_ = Doubt{line, why};
    }
  }
  const std::optional<Doubt>& doubt() const { return doubt_; }

  /// A call that is followed has come to its end: what stands behind it is run as before it.
  void come_back(int depth, const std::optional<Doubt>& doubt) {
    depth_ = depth;
    doubt_ = doubt;
  }

  /// Of the file; what stands before every routine counts to it.
  bool is_in_first_routine() const { return routine_ <= 1; }

  /// Has the routine that is read moved the robot?
  bool moves_here() const { return moving_routine_ != 0 && moving_routine_ == routine_; }
  /// Has another one?
  bool moves_elsewhere() const { return moving_routine_ != 0 && moving_routine_ != routine_; }

  /// Why a motion that stands here cannot be read; null where it can. The first that can be makes
  /// its routine the one that moves.
  const char* why_no_motion() {
    if (depth_ > 0) {
      return kInBranch;
    }
    if (moves_elsewhere()) {
      return kInSecondRoutine;
    }
    moving_routine_ = routine_;
    return nullptr;
  }

 private:
  int depth_ = 0;
  int routine_ = 0;
  int moving_routine_ = 0;
  bool is_over_ = false;
  std::optional<Doubt> doubt_;
};

}  // namespace flexcomp::programs
