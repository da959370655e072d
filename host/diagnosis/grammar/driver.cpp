#include "diagnosis/grammar/driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexcomp::diagnosis::grammar {
namespace {

using effects::SignalKind;

constexpr double kAboveNoise = 4;  // times the noise of a speed or an acceleration: it is a
                                   // sixteenth of the power then, and flattens a slope by as much

std::vector<std::string> names_of(const Observations& observations) {
  std::vector<std::string> names;
  const bool shows_inertia =
      observations.has(simulation::joint_torque) || observations.has(simulation::joint_deflection);
  for (int joint = 1; joint <= observations.machine.robot.joints(); ++joint) {
    names.push_back(fmt::format("q{}", joint));
    if (!observations.is_static) {
      names.push_back(fmt::format("v{}", joint));
      names.push_back(fmt::format("a{}", joint));
    }
    if (shows_inertia) {
      names.push_back(fmt::format("tau{}", joint));
    }
    if (observations.has(simulation::tcp_position)) {
      names.push_back(fmt::format("load{}", joint));
    }
  }
  if (observations.has_wrench()) {
    for (const char* each : {"fx", "fy", "fz", "mx", "my", "mz"}) {
      names.emplace_back(each);
      names.push_back(fmt::format("{}_tool", each));
    }
  }
  for (const char* each : {"x", "y", "z"}) {
    names.emplace_back(each);
  }
  if (observations.scenes.front().temperature.size() > 0) {
    names.emplace_back("temp_c");
  }
  names.emplace_back("t");
  return names;
}

Eigen::VectorXd course_of(const effects::Signal& signal, const Observations& observations,
                          const Rows& rows) {
  Eigen::VectorXd course(rows.count);
  for (std::size_t s = 0; s < observations.scenes.size(); ++s) {
    const Scene& scene = observations.scenes[s];
    course.segment(rows.first[s], rows.rows(s)) =
        rows.of(values_of(signal, scene, observations.simulations[s], observations.predictions[s],
                          effects::Loads::with_inertia, scene.time[0]));
  }
  return course;
}

/// Noise of a signal that comes by differentiation.
double noise_of(const effects::Signal& signal, const Observations& observations) {
  const Scene& scene = observations.scenes.front();
  const bool is_speed = signal.kind == SignalKind::speed;
  if (!is_speed && signal.kind != SignalKind::acceleration) {
    return 0;
  }
  const Eigen::RowVectorXd& noise = is_speed ? scene.velocity_noise : scene.acceleration_noise;
  return noise.size() >= signal.index ? noise[signal.index - 1] : 0;
}

bool is_of_joint(SignalKind kind) {
  return kind == SignalKind::angle || kind == SignalKind::speed ||
         kind == SignalKind::acceleration || kind == SignalKind::torque || kind == SignalKind::load;
}

/// Is the least variation worth looking at, in the signal's own unit?
double least_span(SignalKind kind) {
  switch (kind) {
    case SignalKind::angle:
    case SignalKind::position:
      return 0.01;
    case SignalKind::speed:
    case SignalKind::acceleration:
      return 0.005;
    default:
      return 0.5;
  }
}

/// Adds the product of two signals that are there, of the second one's kind; `joint`: 0 where it
/// belongs to none.
void add_product(const std::string& first, const std::string& second, int joint,
                 std::vector<Driver>* drivers) {
  const Driver* one = find_driver(*drivers, first);
  const Driver* other = find_driver(*drivers, second);
  if (one == nullptr || other == nullptr) {
    return;
  }
  Driver product = *other;
  product.name = fmt::format("({}*{})", first, second);
  product.is_product = true;
  product.joint = joint;
  product.course = one->course.cwiseProduct(other->course);
  product.low = product.course.minCoeff();
  product.high = product.course.maxCoeff();
  drivers->push_back(std::move(product));
}

/// Speed times acceleration, and speed times torque: of what a joint accelerates, and of all.
void add_powers(int joints, std::vector<Driver>* drivers) {
  for (int joint = 1; joint <= joints; ++joint) {
    for (const char* push : {"a", "tau"}) {
      add_product(fmt::format("v{}", joint), fmt::format("{}{}", push, joint), joint, drivers);
    }
  }
}

/// The speeds of any two joints.
void add_products_of_speeds(int joints, std::vector<Driver>* drivers) {
  for (int joint = 1; joint <= joints; ++joint) {
    for (int other = joint + 1; other <= joints; ++other) {
      add_product(fmt::format("v{}", joint), fmt::format("v{}", other), 0, drivers);
    }
  }
}

}  // namespace

double Driver::size() const { return std::max(std::abs(low), std::abs(high)); }

const Driver* find_driver(const std::vector<Driver>& drivers, const std::string& name) {
  const auto found = std::find_if(drivers.begin(), drivers.end(),
                                  [&](const Driver& each) { return each.name == name; });
  return found == drivers.end() ? nullptr : &*found;
}

std::vector<Driver> drivers_of(const Observations& observations, const Rows& rows) {
  std::vector<Driver> drivers;
  for (const std::string& name : names_of(observations)) {
    const auto signal = effects::find_signal(observations.machine.robot, name);
    if (!signal) {
      continue;
    }
    Driver driver{name,
                  false,
                  signal->kind,
                  is_of_joint(signal->kind) ? signal->index : 0,
                  signal->unit,
                  course_of(*signal, observations, rows),
                  0,
                  0};
    if (driver.course.size() == 0 || !driver.course.allFinite()) {
      continue;
    }
    driver.low = driver.course.minCoeff();
    driver.high = driver.course.maxCoeff();
    const double spread = std::sqrt((driver.course.array() - driver.course.mean()).square().mean());
    if (driver.span() > least_span(driver.kind) &&
        spread > kAboveNoise * noise_of(*signal, observations)) {
      drivers.push_back(std::move(driver));
    }
  }
  add_powers(observations.machine.robot.joints(), &drivers);
  add_products_of_speeds(observations.machine.robot.joints(), &drivers);
  return drivers;
}

}  // namespace flexcomp::diagnosis::grammar
