#include "simulation/history.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::simulation {

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
  constexpr int kElements = 10;
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
  double behind = 0;
  for (Eigen::Index row = 1; row < input.size(); ++row) {
    const double step = time[row] - time[row - 1];
    const double follow = constant * (input[row] - input[row - 1]) / step;
    behind = row == 1 ? follow : behind;
    behind = follow + (behind - follow) * std::exp(-step / constant);
    output[row] = input[row] - behind;
    output[0] = row == 1 ? input[0] - follow : output[0];
  }
  return output;
}

Eigen::MatrixXd delayed(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, double delay) {
  Eigen::MatrixXd result(values.rows(), values.cols());
  const Eigen::Index last = time.size() - 1;
  Eigen::Index before = 0;
  for (Eigen::Index row = 0; row <= last; ++row) {
    const double end = std::clamp(time[row] - delay, time[0], time[last]);
    const double wanted = std::clamp(2 * end - (time[row] - delay), time[0], time[last]);
    const bool is_beyond = wanted != time[row] - delay;
    while (before > 0 && time[before] > wanted) {
      --before;
    }
    while (before + 1 < last && time[before + 1] < wanted) {
      ++before;
    }
    const Eigen::Index after = std::min(before + 1, last);
    const double length = time[after] - time[before];
    const double share = length > 0 ? (wanted - time[before]) / length : 0;
    result.row(row) = (1 - share) * values.row(before) + share * values.row(after);
    if (is_beyond) {
      const Eigen::Index edge = end > time[0] ? last : 0;
      result.row(row) = 2 * values.row(edge) - result.row(row);
    }
  }
  return result;
}

Eigen::MatrixXd moved_before(const Eigen::VectorXd& time, const Eigen::MatrixXd& position,
                             const Eigen::MatrixXd& velocity, double delay) {
  Eigen::MatrixXd result(position.rows(), position.cols());
  const Eigen::Index last = time.size() - 1;
  Eigen::Index before = 0;
  for (Eigen::Index row = 0; row <= last; ++row) {
    const double wanted = time[row] - delay;
    while (before > 0 && time[before] > wanted) {
      --before;
    }
    while (before + 1 < last && time[before + 1] <= wanted) {
      ++before;
    }
    const bool is_within = last > 0 && wanted >= time[0] && wanted <= time[last];
    if (!is_within) {
      const Eigen::Index edge = wanted < time[0] ? 0 : last;
      result.row(row) =
          position.row(edge) + (wanted - time[edge]) * velocity.row(edge) - position.row(row);
      continue;
    }
    const double length = time[before + 1] - time[before];
    const double s = (wanted - time[before]) / length;
    const double to_end = s * s * (3 - 2 * s);
    result.row(row) =
        (1 - to_end) * position.row(before) + to_end * position.row(before + 1) +
        length * s * (1 - s) * ((1 - s) * velocity.row(before) - s * velocity.row(before + 1)) -
        position.row(row);
  }
  return result;
}

}  // namespace flexcomp::simulation
