#include "diagnosis/event.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {
namespace {

// Chosen by judgement.
constexpr Eigen::Index kBlocks = 400;   // of a recording: what is told in time
constexpr Eigen::Index kLongest = 8;    // blocks of one event: a fiftieth of the recording
constexpr std::size_t kMostEvents = 3;  // events: more of them are no exceptions
constexpr double kEventPower = 9;       // of squares over the noise's, on average over an event
constexpr double kEdgePower = 2;        // the same, of a block that belongs to it
constexpr double kLeastInEvents = 0.8;  // of what is left beyond the noise
constexpr double kLeastInOne = 0.1;     // of the largest excursion's squares, to be named

/// Squares of what is left over the noise, and how many samples they are of.
struct Power {
  double squares = 0;
  double count = 0;

  double mean() const { return count > 0 ? squares / count : 0; }
  double beyond_noise() const { return squares - count; }
};

Power operator+(const Power& a, const Power& b) {
  return {a.squares + b.squares, a.count + b.count};
}

/// What is left in blocks of each scene's time.
class Blocks {
 public:
  Blocks(const Observations& observations, const Eigen::VectorXd& remainder)
      : observations_(observations), remainder_(remainder), power_(observations.scenes.size()) {
    for (std::vector<Power>& each : power_) {
      each.resize(kBlocks);
    }
    for (Eigen::Index i = 0; i < observations.size(); ++i) {
      const Sample& at = observations.samples[static_cast<std::size_t>(i)];
      Power& power = power_[at.scene][block_of(at)];
      const double left = observations.over_floor(i, remainder[i]);
      power = power + Power{left * left, 1};
    }
  }

  Power all() const {
    Power sum;
    for (const std::vector<Power>& each : power_) {
      for (const Power& power : each) {
        sum = sum + power;
      }
    }
    return sum;
  }

  /// Takes the largest block, and those beside it that belong to it, out of the rest. Gives what
  /// they hold; nothing where they are too many.
  Power take(Event* event) {
    std::size_t first = 0;
    double most = 0;
    for (std::size_t scene = 0; scene < power_.size(); ++scene) {
      for (std::size_t block = 0; block < power_[scene].size(); ++block) {
        if (power_[scene][block].squares > most) {
          most = power_[scene][block].squares;
          event->scene = scene;
          first = block;
        }
      }
    }
    std::vector<Power>& power = power_[event->scene];
    std::size_t last = first + 1;
    while (first > 0 && power[first - 1].mean() > kEdgePower) {
      --first;
    }
    while (last < power.size() && power[last].mean() > kEdgePower) {
      ++last;
    }
    const Eigen::Index rows = observations_.scenes[event->scene].rows();
    event->rows = {row_of(first, rows), row_of(last, rows)};
    Power taken;
    for (std::size_t block = first; block < last; ++block) {
      taken = taken + std::exchange(power[block], {});
    }
    return static_cast<Eigen::Index>(last - first) <= kLongest ? taken : Power{};
  }

  void describe(Event* event) const {
    const Eigen::VectorXd& time = observations_.scenes[event->scene].time;
    event->begin = time[event->rows.first];
    event->end = time[event->rows.end - 1];
    std::map<std::pair<Channel, Eigen::Index>, std::pair<double, double>> parts;  // squares, most
    for (Eigen::Index i = 0; i < observations_.size(); ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      if (at.scene == event->scene && at.row >= event->rows.first && at.row < event->rows.end) {
        auto& [squares, most] = parts[{at.channel, at.component}];
        squares += std::pow(observations_.over_floor(i, remainder_[i]), 2);
        most = std::max(most, std::abs(remainder_[i] * observations_.noise[i]));
      }
    }
    std::vector<std::pair<double, Excursion>> all;
    for (const auto& [part, power] : parts) {
      all.push_back({power.first, {part.first, part.second, power.second}});
    }
    std::sort(all.begin(), all.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [squares, excursion] : all) {
      if (squares >= kLeastInOne * all.front().first) {
        event->excursions.push_back(excursion);
      }
    }
  }

 private:
  static Eigen::Index row_of(std::size_t block, Eigen::Index rows) {
    return (static_cast<Eigen::Index>(block) * rows + kBlocks - 1) / kBlocks;
  }

  std::size_t block_of(const Sample& at) const {
    return static_cast<std::size_t>(
        equal_part_of(at.row, observations_.scenes[at.scene].rows(), kBlocks));
  }

  const Observations& observations_;
  const Eigen::VectorXd& remainder_;
  std::vector<std::vector<Power>> power_;  ///< by scene and block
};

}  // namespace

std::vector<Event> find_events(const Observations& observations, const Eigen::VectorXd& remainder) {
  if (observations.is_static || observations.fewest_rows() < kBlocks) {
    return {};
  }
  Blocks blocks(observations, remainder);
  const double beyond = blocks.all().beyond_noise();
  std::vector<Event> events;
  Power taken;
  while (events.size() < kMostEvents) {
    Event event;
    const Power power = blocks.take(&event);
    if (power.mean() < kEventPower) {
      return {};
    }
    taken = taken + power;
    blocks.describe(&event);
    events.push_back(std::move(event));
    if (taken.beyond_noise() >= kLeastInEvents * beyond &&
        std::sqrt(blocks.all().mean()) < kLikeNoise) {
      return events;
    }
  }
  return {};
}

}  // namespace flexcomp::diagnosis
