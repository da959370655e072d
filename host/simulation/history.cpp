#include "simulation/history.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::simulation {
namespace {

/// Slopes of the parabolas through each row and its neighbours; straight at the ends.
Eigen::MatrixXd slopes(const Eigen::VectorXd& time, const Eigen::MatrixXd& values) {
  const Eigen::Index last = time.size() - 1;
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(values.rows(), values.cols());
  for (Eigen::Index row = 0; row <= last && last > 0; ++row) {
    const Eigen::Index before = std::max<Eigen::Index>(row - 1, 0);
    const Eigen::Index after = std::min(row + 1, last);
    const double whole = time[after] - time[before];
    const double share = (time[row] - time[before]) / whole;
    slope.row(row) = (values.row(after) - values.row(before)) / whole;
    if (before < row && row < after) {
      slope.row(row) = (1 - share) * (values.row(row) - values.row(before)) / (share * whole) +
                       share * (values.row(after) - values.row(row)) / ((1 - share) * whole);
    }
  }
  return slope;
}

/// A signal between two rows: the cubic with its values and slopes there (Hermite). `Value`: a
/// number, or one for each column.
template <typename Value>
class Cubic {
 public:
  Cubic(const Value& first, const Value& last, const Value& slope, const Value& last_slope,
        double length)
      : first_(first),
        linear_(slope),
        square_(((last - first) / length * 3 - 2 * slope - last_slope) / length),
        cube_((slope + last_slope - 2 * (last - first) / length) / (length * length)) {}

  /// The signal at `s` after the first row.
  Value at(double s) const { return first_ + s * (linear_ + s * (square_ + s * cube_)); }

  /// Distance of a first-order lag behind the signal at `s` after the first row, once settled.
  Value lag(double s, double constant) const {
    const Value velocity = linear_ + s * (2 * square_ + s * 3 * cube_);
    const Value acceleration = 2 * square_ + s * 6 * cube_;
    return constant * (velocity - constant * (acceleration - constant * 6 * cube_));
  }

 private:
  Value first_, linear_, square_, cube_;
};

/// A signal (n×m) with its slopes at a share of the way from a row to the next.
Eigen::RowVectorXd between_rows(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                                const Eigen::MatrixXd& slope, Eigen::Index row, double share) {
  const double length = time[row + 1] - time[row];
  const Cubic<Eigen::RowVectorXd> piece(values.row(row), values.row(row + 1), slope.row(row),
                                        slope.row(row + 1), length);
  return piece.at(share * length);
}

/// Goes to the row at or before a time that the recording spans; of its last row to the one before.
void go_to(double wanted, const Eigen::VectorXd& time, Eigen::Index* row) {
  while (*row > 0 && time[*row] > wanted) {
    --*row;
  }
  while (*row + 2 < time.size() && time[*row + 1] <= wanted) {
    ++*row;
  }
}

/// A signal of so many columns, `delay` (s) late. `between` gives it at a share of the way from a
/// row to the next, `beyond` at a time before the first row or after the last.
template <typename Between, typename Beyond>
Eigen::MatrixXd late(const Eigen::VectorXd& time, Eigen::Index columns, double delay,
                     const Between& between, const Beyond& beyond) {
  Eigen::MatrixXd result(time.size(), columns);
  const Eigen::Index last = time.size() - 1;
  Eigen::Index at = 0;
  for (Eigen::Index row = 0; row <= last; ++row) {
    const double wanted = time[row] - delay;
    if (last == 0 || wanted < time[0] || wanted > time[last]) {
      result.row(row) = beyond(wanted);
      continue;
    }
    go_to(wanted, time, &at);
    result.row(row) = between(at, (wanted - time[at]) / (time[at + 1] - time[at]));
  }
  return result;
}

/// The first row for a time before it, else the last.
Eigen::Index edge_near(double wanted, const Eigen::VectorXd& time) {
  return wanted < time[0] ? 0 : time.size() - 1;
}

/// A signal (n×m), `delay` (s) late, which goes on beyond each end as it came there: turned by half
/// a turn about the last row.
template <typename Between>
Eigen::MatrixXd late_turned_at_ends(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                                    double delay, const Between& between) {
  const auto beyond = [&](double wanted) -> Eigen::RowVectorXd {
    const Eigen::Index last = time.size() - 1;
    if (last == 0) {
      return values.row(0);
    }
    const Eigen::Index edge = edge_near(wanted, time);
    const double inside = std::clamp(2 * time[edge] - wanted, time[0], time[last]);
    Eigen::Index at = std::min(edge, last - 1);
    go_to(inside, time, &at);
    return 2 * values.row(edge) - between(at, (inside - time[at]) / (time[at + 1] - time[at]));
  };
  return late(time, values.cols(), delay, between, beyond);
}

}  // namespace

Eigen::VectorXd play(const Eigen::VectorXd& input, double half_gap) {
  Eigen::VectorXd output(input.size());
  double now = input.size() > 0 ? input[0] : 0;
  for (Eigen::Index row = 0; row < input.size(); ++row) {
    now = std::min(std::max(now, input[row] - half_gap), input[row] + half_gap);
    output[row] = now;
  }
  return output;
}

Eigen::VectorXd flank(const Eigen::VectorXd& torque, double hold) {
  Eigen::VectorXd side(torque.size());
  double now = torque.size() > 0 && torque[0] < 0 ? -1 : 1;
  for (Eigen::Index row = 0; row < torque.size(); ++row) {
    if (std::abs(torque[row]) > hold) {
      now = torque[row] > 0 ? 1 : -1;
    }
    side[row] = now;
  }
  return side;
}

Eigen::VectorXd bouc_wen(const Eigen::VectorXd& torque, double yield) {
  Eigen::VectorXd loop(torque.size());
  double now = 0;
  for (Eigen::Index row = 0; row < torque.size(); ++row) {
    const double step = row == 0 ? 0 : torque[row] - torque[row - 1];
    const double limit = step < 0 ? -1 : 1;
    now = limit - (limit - now) * std::exp(-std::abs(step) / yield);
    loop[row] = now;
  }
  return loop;
}

Eigen::VectorXd prandtl_ishlinskii(const Eigen::VectorXd& torque, double yield) {
  constexpr int kElements = 10;  // chosen by judgement: the loop's corners are a tenth of it
  Eigen::VectorXd loop = Eigen::VectorXd::Zero(torque.size());
  const double first = torque.size() > 0 ? torque[0] : 0;
  const Eigen::VectorXd input = torque.array() - first;
  for (int element = 0; element < kElements; ++element) {
    const double slip = 4 * yield * (element + 0.5) / kElements;
    loop += (input - play(input, slip)) / (slip * kElements);
  }
  return loop;
}

Eigen::VectorXd mode(const Eigen::VectorXd& time, const Eigen::VectorXd& input, double frequency,
                     double damping) {
  return mode(time, input, Eigen::VectorXd::Constant(input.size(), frequency), damping);
}

Eigen::VectorXd mode(const Eigen::VectorXd& time, const Eigen::VectorXd& input,
                     const Eigen::VectorXd& frequency, double damping) {
  Eigen::VectorXd response(input.size());
  double x = input.size() > 0 ? input[0] : 0;
  double v = 0;
  double known_step = -1;
  double known_omega = -1;
  double cosine = 1;
  double sine = 0;
  for (Eigen::Index row = 0; row < input.size(); ++row) {
    if (row > 0) {
      const double step = time[row] - time[row - 1];
      const double omega = 2 * M_PI * frequency[row];
      const double decay = damping * omega;
      const double damped = omega * std::sqrt(1 - damping * damping);
      if (std::abs(step - known_step) > 1e-9 * step || omega != known_omega) {
        known_step = step;
        known_omega = omega;
        cosine = std::exp(-decay * step) * std::cos(damped * step);
        sine = std::exp(-decay * step) * std::sin(damped * step);
      }
      // Away from the particular solution p(t) = u(t) − 2·decay/ω²·u'.
      const double slope = (input[row] - input[row - 1]) / step;
      const double behind = 2 * decay / (omega * omega) * slope;
      const double away = x - (input[row - 1] - behind);
      const double speed = v - slope;
      x = input[row] - behind + away * cosine + (speed + decay * away) / damped * sine;
      v = slope + speed * cosine - (decay * speed + omega * omega * away) / damped * sine;
    }
    response[row] = x;
  }
  return response;
}

Eigen::VectorXd lag(const Eigen::VectorXd& time, const Eigen::VectorXd& input, double constant) {
  Eigen::VectorXd output = input;
  if (!(constant > 0) || input.size() < 2) {
    return output;
  }
  const Eigen::VectorXd slope = slopes(time, input);
  double behind = constant * slope[0];
  output[0] -= behind;
  for (Eigen::Index row = 1; row < input.size(); ++row) {
    const double step = time[row] - time[row - 1];
    const Cubic<double> piece(input[row - 1], input[row], slope[row - 1], slope[row], step);
    const double start = piece.lag(0, constant);
    const double end = piece.lag(step, constant);
    behind = end + (behind - start) * std::exp(-step / constant);
    output[row] = input[row] - behind;
  }
  return output;
}

Eigen::MatrixXd delayed(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, double delay) {
  return late_turned_at_ends(time, values, delay, [&](Eigen::Index row, double share) {
    return Eigen::RowVectorXd((1 - share) * values.row(row) + share * values.row(row + 1));
  });
}

Eigen::MatrixXd delayed_smoothly(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                                 double delay) {
  const Eigen::MatrixXd slope = slopes(time, values);
  return late_turned_at_ends(time, values, delay, [&](Eigen::Index row, double share) {
    return between_rows(time, values, slope, row, share);
  });
}

Eigen::MatrixXd delayed_motion(const Eigen::VectorXd& time, const Eigen::MatrixXd& position,
                               const Eigen::MatrixXd& velocity, double delay) {
  const auto between = [&](Eigen::Index row, double share) {
    return between_rows(time, position, velocity, row, share);
  };
  const auto beyond = [&](double wanted) -> Eigen::RowVectorXd {
    const Eigen::Index edge = edge_near(wanted, time);
    return position.row(edge) + (wanted - time[edge]) * velocity.row(edge);
  };
  return late(time, position.cols(), delay, between, beyond);
}

}  // namespace flexcomp::simulation
