#pragma once

namespace flexcomp::programs {

constexpr const char* kInBranch =
    "a motion in a branch or a loop: whether it is run cannot be told";

/// Where the statement that is read stands: in which routine of a KRL or RAPID program, and in how
/// many branches and loops of it. Motions are read in one routine, outside of these.
class Nesting {
 public:
  void begin_routine() { ++routine_; }
  void open() { ++depth_; }
  void close() { --depth_; }
  void close_all() { depth_ = 0; }

  /// Why a motion that stands here cannot be read; null where it can. The first that can be makes
  /// its routine the one that moves.
  const char* why_no_motion() {
    if (depth_ > 0) {
      return kInBranch;
    }
    if (moving_routine_ != 0 && moving_routine_ != routine_) {
      return "a motion in a second routine: when it is called cannot be told";
    }
    moving_routine_ = routine_;
    return nullptr;
  }

 private:
  int depth_ = 0;
  int routine_ = 0;
  int moving_routine_ = 0;
};

}  // namespace flexcomp::programs
