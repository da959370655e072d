#include "diagnosis/grammar/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/grammar/shape.hpp"
#include "diagnosis/grammar/wave.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

using effects::PlaceKind;
using effects::SignalKind;

/// Hat functions of a conditional mean: they show a wave, and take up little noise.
constexpr Eigen::Index kHats = 9;
constexpr std::size_t kMostLeads = 40;  // from which laws are composed: time
/// Share of the best lead's gain that another needs: time against shapes that gain more than their
/// lead shows.
constexpr double kLeastOfBest = 0.4;

/// Adds factors of a driver that is there: itself, and its sign.
void add_factor(const std::vector<Driver>& drivers, const std::string& name, bool by_sign,
                std::vector<Factor>* factors) {
  const Driver* driver = find_driver(drivers, name);
  if (driver != nullptr) {
    factors->push_back(by_sign
                           ? Factor{fmt::format("sign({})", name), name, driver->course.cwiseSign()}
                           : Factor{name, name, driver->course});
  }
}

/// Factors of laws at a place: friction and gains of a drive, springs, forces.
std::vector<Factor> factors_at(const effects::LawPlace& place, const std::vector<Driver>& drivers) {
  std::vector<Factor> factors = {{}};
  const std::string joint = std::to_string(place.joint);
  if (place.kind == PlaceKind::joint_torque) {
    add_factor(drivers, "v" + joint, true, &factors);
    add_factor(drivers, "v" + joint, false, &factors);
    add_factor(drivers, "tau" + joint, false, &factors);
    add_factor(drivers, "load" + joint, false, &factors);
    add_factor(drivers, "a" + joint, false, &factors);
  } else if (place.kind == PlaceKind::joint_angle) {
    add_factor(drivers, "load" + joint, false, &factors);
    add_factor(drivers, "tau" + joint, false, &factors);
    add_factor(drivers, "v" + joint, true, &factors);
  } else if (place.kind == PlaceKind::tcp_base || place.kind == PlaceKind::tcp_tool) {
    for (const char* force : {"fx", "fy", "fz"}) {
      add_factor(drivers, force, false, &factors);
    }
  }
  return factors;
}

/// Piecewise linear functions over a driver whose sum is one: in each row two of them.
class Hats {
 public:
  explicit Hats(const Driver& driver) : at_(driver.course.size()), share_(driver.course.size()) {
    const double spacing = driver.span() / static_cast<double>(kHats - 1);
    for (Eigen::Index row = 0; row < at_.size(); ++row) {
      const double place = (driver.course[row] - driver.low) / spacing;
      at_[row] = std::min(static_cast<Eigen::Index>(place), kHats - 2);
      share_[row] = place - static_cast<double>(at_[row]);
    }
  }

  Normal normal(const Seat& seat, const Factor& factor) const {
    Normal sum{Eigen::MatrixXd::Zero(kHats, kHats), Eigen::VectorXd::Zero(kHats)};
    Eigen::MatrixXd shown = Eigen::MatrixXd::Zero(seat.fitted.cols(), kHats);
    for (Eigen::Index row = 0; row < at_.size(); ++row) {
      if (!(seat.weight[row] > 0)) {
        continue;
      }
      const double size = factor.course.size() > 0 ? factor.course[row] : 1;
      const double values[] = {size * (1 - share_[row]), size * share_[row]};
      for (Eigen::Index i = 0; i < 2; ++i) {
        sum.moment[at_[row] + i] += values[i] * seat.product[row];
        for (Eigen::Index k = 0; k < 2; ++k) {
          sum.gram(at_[row] + i, at_[row] + k) += seat.weight[row] * values[i] * values[k];
        }
        shown.col(at_[row] + i) += values[i] * seat.fitted.row(row).transpose();
      }
    }
    return beside(std::move(sum.gram), shown, std::move(sum.moment));
  }

 private:
  Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1> at_;
  Eigen::VectorXd share_;
};

/// Would a law of a driver and a factor mean something at a seat? Errors of sensors follow time
/// alone, a joint's power is felt by its own drive, and two speeds by any.
bool means_something(const Seat& seat, const Driver& driver, const Factor& factor) {
  if (seat.is_sensor()) {
    return driver.kind == SignalKind::time && factor.text.empty();
  }
  return !driver.is_product ||
         (seat.place.kind == PlaceKind::joint_torque &&
          (driver.joint == 0 ? factor.text.empty() : seat.place.joint == driver.joint));
}

/// Gain of the best shape with a memory, which a conditional mean does not show: of what a joint
/// carries, and of its angle, at that joint.
double gain_of_memory(const Material& material, const Seat& seat, const Driver& driver,
                      const Factor& factor) {
  const bool is_own = !driver.is_product && driver.joint != 0 && driver.joint == seat.place.joint;
  const bool is_held = driver.kind == SignalKind::torque || driver.kind == SignalKind::load ||
                       (driver.kind == SignalKind::angle && factor.text.empty());
  if (!is_own || !is_held) {
    return 0;
  }
  double most = 0;
  for (const Shape& shape : shapes()) {
    const bool lags =
        !shape.parameters.empty() && shape.parameters.front().sought == Sought::constant;
    if (!shape.remembers() || !shape.fits(seat, driver) ||
        (lags && material.observations.is_static)) {
      continue;
    }
    for (const Values& start : starts_of(shape, driver, material.observations, 1)) {
      Eigen::MatrixXd courses(material.rows.count, 2);
      courses << courses_of(shape, driver, material.rows, material.observations, start),
          Eigen::VectorXd::Ones(material.rows.count);
      if (factor.course.size() > 0) {
        courses.array().colwise() *= factor.course.array();
      }
      const Normal normal = normal_of(seat, courses);
      most = std::max(most, normal.gain(normal.amplitude()));
    }
  }
  return most;
}

/// The lead of a factor and a driver at a seat; none where a law of them would mean nothing.
std::optional<Lead> lead_of(const Material& material, const Seat& seat, const Driver& driver,
                            const Hats& hats, const Factor& factor) {
  if (!means_something(seat, driver, factor)) {
    return std::nullopt;
  }
  const bool is_time = driver.kind == SignalKind::time;
  const Normal normal = hats.normal(seat, factor);
  Lead lead{&seat, &driver, factor, seat.is_sensor() ? 0 : normal.gain(normal.amplitude()), 1};
  if (factor.text.empty() && is_time && seat.is_sensor()) {
    lead.gain = std::max(lead.gain, best_step(seat));
  }
  const bool may_wave = is_time ? seat.is_sensor() && !material.observations.is_static
                                : driver.kind == SignalKind::angle;
  if (factor.text.empty() && may_wave) {
    const Wave wave = best_wave(seat, driver);
    lead.wave = wave.order;
    lead.gain = std::max(lead.gain, wave.gain);
  }
  lead.gain = std::max(lead.gain, gain_of_memory(material, seat, driver, factor));
  return lead;
}

/// May the size of a wave at a joint follow this driver, beside the joint's own angle? Another
/// angle loads its gear otherwise, and so does what the joint carries.
bool may_swell(const Driver& by, int joint) {
  return !by.is_product && (by.joint == joint ? by.kind != SignalKind::angle
                                              : by.kind == SignalKind::angle && by.joint > 0);
}

/// The wave over a joint's angle that does most at that joint, where its size follows another
/// driver, for each seat; none where it does no more than what its seat shows already.
std::vector<Lead> swelling_waves(const Material& material, const std::vector<Seat>& seats,
                                 double most, std::size_t* looked_at) {
  std::vector<Lead> best;
  for (const Seat& seat : seats) {
    const Driver* own = find_driver(material.drivers, fmt::format("q{}", seat.place.joint));
    if (own == nullptr || seat.is_sensor()) {
      continue;
    }
    Lead lead{&seat, own, {}, most, 1, true};
    for (const Driver& by : material.drivers) {
      if (may_swell(by, seat.place.joint)) {
        ++*looked_at;
        const Wave wave = best_swelling_wave(seat, *own, by);
        if (wave.gain > lead.gain) {
          lead.gain = wave.gain;
          lead.wave = wave.order;
        }
      }
    }
    if (lead.gain > most) {
      best.push_back(std::move(lead));
    }
  }
  return best;
}

}  // namespace

std::vector<Lead> screen(const Material& material, const std::vector<Seat>& seats,
                         std::size_t* looked_at) {
  const std::vector<Driver>& drivers = material.drivers;
  std::vector<Hats> hats(drivers.begin(), drivers.end());
  std::vector<std::vector<Lead>> by_seat(seats.size());
  in_parallel(
      seats.size(), [](std::size_t, std::size_t) {},
      [&](std::size_t s) {
        for (const Factor& factor : factors_at(seats[s].place, drivers)) {
          for (std::size_t d = 0; d < drivers.size(); ++d) {
            if (const auto lead = lead_of(material, seats[s], drivers[d], hats[d], factor)) {
              by_seat[s].push_back(*lead);
            }
          }
        }
      });
  std::vector<Lead> leads;
  for (std::vector<Lead>& each : by_seat) {
    leads.insert(leads.end(), each.begin(), each.end());
  }
  *looked_at += leads.size();
  std::stable_sort(leads.begin(), leads.end(),
                   [](const Lead& a, const Lead& b) { return a.gain > b.gain; });
  const double least = leads.empty() ? 0 : kLeastOfBest * leads.front().gain;
  const auto end = std::find_if(leads.begin(), leads.end(),
                                [&](const Lead& each) { return !(each.gain > least); });
  leads.erase(end, leads.end());
  leads.resize(std::min(leads.size(), kMostLeads), Lead{nullptr, nullptr, {}, 0, 0});
  const double most = leads.empty() ? 0 : leads.front().gain;
  const std::vector<Lead> waves = swelling_waves(material, seats, most, looked_at);
  leads.insert(leads.end(), waves.begin(), waves.end());
  return leads;
}

}  // namespace flexcomp::diagnosis::grammar
