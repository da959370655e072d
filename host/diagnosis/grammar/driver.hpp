#pragma once

#include <string>
#include <vector>

#include "diagnosis/grammar/seat.hpp"
#include "effects/signals.hpp"

namespace flexcomp::diagnosis::grammar {

/// A signal that may drive a law, along all rows, or a product of two: a joint's power, since a
/// gear behaves otherwise when it drives than when it is driven; or the speeds of two joints, whose
/// product a body feels that both turn (Coriolis' force).
struct Driver {
  std::string name;  ///< as formulas have it: q4, tau5, temp_c, (v5*tau5)
  bool is_product = false;
  effects::SignalKind kind = effects::SignalKind::angle;
  int joint = 0;     ///< from 1 on; 0 where it belongs to none
  std::string unit;  ///< rad, N·m, …
  Eigen::VectorXd course;
  double low = 0, high = 0;  ///< of the course

  double span() const { return high - low; }
  /// The larger of its ends, without sign.
  double size() const;
};

/// The signals that vary along the recordings by more than their noise, and then the products. A
/// load test's time counts its poses in the order in which they were taken. A joint's load is the
/// one that the measurement shows: at rest for the TCP, with inertia for others.
std::vector<Driver> drivers_of(const Observations& observations, const Rows& rows);

/// The driver of a name; null where there is none.
const Driver* find_driver(const std::vector<Driver>& drivers, const std::string& name);

}  // namespace flexcomp::diagnosis::grammar
