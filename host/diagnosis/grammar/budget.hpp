#pragma once

#include <ctime>

namespace flexcomp::diagnosis::grammar {

/// Processor time that the search for laws may take. Other programs on the computer do not change
/// what it finds.
class Budget {
 public:
  explicit Budget(double seconds)
      : end_(static_cast<double>(std::clock()) + seconds * CLOCKS_PER_SEC) {}

  /// Is it used up? A call that finds it so is remembered.
  bool is_spent() {
    has_stopped_ = has_stopped_ || static_cast<double>(std::clock()) > end_;
    return has_stopped_;
  }
  /// Was anything left undone?
  bool has_stopped() const { return has_stopped_; }

 private:
  double end_;  ///< in ticks of the processor's clock
  bool has_stopped_ = false;
};

}  // namespace flexcomp::diagnosis::grammar
