#include "diagnosis/locate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "diagnosis/cues.hpp"
#include "diagnosis/evidence.hpp"
#include "statistics/distributions.hpp"
#include "statistics/median.hpp"

namespace flexcomp::diagnosis {
namespace {

using simulation::tcp_position;

constexpr double kSignificance = 0.01;      // of all places that are looked at, together
constexpr Eigen::Index kStretches = 24;     // of a recording, in each of which time is told
constexpr std::size_t kMostCorrelates = 6;  // that are told: a reader looks at no more

double chance_above(double value, double freedom) {
  if (!(value > 0)) {
    return 1;
  }
  return statistics::chi_squared_above(std::min(value, 1e6), freedom);
}

/// Power (sum of squares over the noise) per independent sample, tested against that of noise,
/// which `known_from` samples told. Their third differences give its square with a relative
/// variance of 12 over their number: a median of absolute values takes 5.4 over the number of
/// independent ones (Rousseeuw and Croux 1993), and these are correlated.
bool exceeds_noise(double sum, double count, double independent_share, double known_from,
                   double places) {
  constexpr double kNoiseOfNoise = 6;  // 12 over it, of squares that have 2
  const double independent = std::max(count * independent_share, 1.0);
  const double freedom = 1 / (1 / independent + kNoiseOfNoise / known_from);
  return chance_above(sum / count * freedom, freedom) * places < kSignificance;
}

/// Power of the class means of each joint's residual, and its chance.
class Locator {
 public:
  Locator(const Observations& observations, const Eigen::VectorXd& residual)
      : observations_(observations), residual_(residual) {
    independent_share_ = independent_samples(observations, residual) /
                         static_cast<double>(std::max<Eigen::Index>(observations.train, 1));
    total_ = residual.head(observations.train).squaredNorm();
    for (std::size_t s = 0; s < observations.scenes.size(); ++s) {
      cues_.push_back(cues_of(observations.scenes[s], observations.predictions[s],
                              observations.simulations[s]));
    }
    location_.places = cues_.front().size() + 3 + kStretches;
  }

  Location run() {
    if (total_ > 0) {
      find_correlates();
      if (observations_.noise_is_known) {
        find_axes();
        find_time();
      }
      find_frequencies();
    }
    return location_;
  }

 private:
  /// Rows of samples that a joint's angle or torque moves, with its lever over the noise.
  double lever(const Sample& at, Eigen::Index i, int joint) const {
    if (at.channel == tcp_position) {
      return observations_.simulations[at.scene].jacobian[static_cast<std::size_t>(at.row)](
                 at.component, joint - 1) /
             observations_.noise[i];
    }
    return at.component == joint - 1 ? 1 / observations_.noise[i] : 0;
  }

  Correlate correlate(std::size_t number) const {
    const Cue& cue = cues_.front()[number];
    // Torque and angle have means of their own: a cue of the machine has one for every component.
    const Eigen::Index joints = observations_.machine.robot.joints();
    const Eigen::Index groups = cue.joint > 0 ? 2 : 3 + 2 * joints;
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(groups, cue.classes);
    Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(groups, cue.classes);
    for (Eigen::Index i = 0; i < observations_.train; ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      const double l = cue.joint > 0 ? lever(at, i, cue.joint) : 1;
      const auto channel = static_cast<Eigen::Index>(at.channel);
      const Eigen::Index own =
          at.channel == tcp_position ? at.component : 3 + joints * (channel - 1) + at.component;
      const Eigen::Index group =
          cue.joint == 0 ? own : (at.channel == simulation::joint_torque ? 1 : 0);
      const int kind = cues_[at.scene][number].kind[at.row];
      product(group, kind) += l * residual_[i];
      weight(group, kind) += l * l;
    }
    double power = 0;
    double freedom = 0;
    for (Eigen::Index g = 0; g < groups; ++g) {
      for (int k = 0; k < cue.classes; ++k) {
        if (weight(g, k) > 0) {
          power += product(g, k) * product(g, k) / weight(g, k);
          ++freedom;
        }
      }
    }
    Correlate found{cue.name, cue.joint, power / total_, 1};
    found.p_value = std::min(1.0, chance_above(power * independent_share_, std::max(freedom, 1.0)) *
                                      static_cast<double>(location_.places));
    return found;
  }

  void find_correlates() {
    for (std::size_t number = 0; number < cues_.front().size(); ++number) {
      const Correlate found = correlate(number);
      if (found.p_value < kSignificance) {
        location_.correlates_with.push_back(found);
      }
    }
    std::vector<Correlate>& all = location_.correlates_with;
    std::sort(all.begin(), all.end(),
              [](const Correlate& a, const Correlate& b) { return a.share > b.share; });
    for (const Correlate& each : all) {
      const bool is_new = std::find(location_.joints.begin(), location_.joints.end(), each.joint) ==
                          location_.joints.end();
      if (each.joint > 0 && is_new && each.share > 0.7 * all.front().share) {
        location_.joints.push_back(each.joint);
      }
    }
    all.resize(std::min(all.size(), kMostCorrelates));
  }

  void find_axes() {
    std::array<double, 3> sums{};
    std::array<double, 3> counts{};
    for (Eigen::Index i = 0; i < observations_.train; ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      if (at.channel == tcp_position) {
        sums[static_cast<std::size_t>(at.component)] += residual_[i] * residual_[i];
        counts[static_cast<std::size_t>(at.component)] += 1;
      }
    }
    const double largest = *std::max_element(sums.begin(), sums.end());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (counts[axis] > 0 && sums[axis] > 0.25 * largest &&
          exceeds_noise(sums[axis], counts[axis], independent_share_, counts[axis],
                        static_cast<double>(location_.places))) {
        location_.axes.emplace_back(1, "xyz"[axis]);
      }
    }
  }

  static Eigen::Index first_row_of(Eigen::Index stretch, Eigen::Index rows) {
    return (stretch * rows + kStretches - 1) / kStretches;
  }

  void find_time() {
    const Scene& scene = observations_.scenes.front();
    std::vector<double> sums(kStretches, 0);
    std::vector<double> counts(kStretches, 0);
    for (Eigen::Index i = 0; i < observations_.size(); ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      if (at.scene == 0) {
        const auto stretch = static_cast<std::size_t>(at.row * kStretches / scene.rows());
        sums[stretch] += residual_[i] * residual_[i];
        counts[stretch] += 1;
      }
    }
    const double whole = std::max(std::accumulate(counts.begin(), counts.end(), 0.0), 1.0);
    const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / whole;
    bool follows = false;
    for (Eigen::Index i = 0; i < kStretches; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const bool stands_out = counts[at] > 0 && sums[at] / counts[at] > 1.5 * mean &&
                              exceeds_noise(sums[at], counts[at], independent_share_, whole,
                                            static_cast<double>(location_.places));
      if (stands_out) {
        const double from = scene.time[first_row_of(i, scene.rows())];
        const double to = scene.time[first_row_of(i + 1, scene.rows()) - 1];
        if (follows) {
          location_.time.back().second = to;
        } else {
          location_.time.emplace_back(from, to);
        }
      }
      follows = stands_out;
    }
  }

  /// Lines of the spectrum of the first recording that stand out of their neighbourhood and hold a
  /// tenth of a component's power.
  void find_frequencies() {
    const Scene& scene = observations_.scenes.front();
    const Eigen::Index n = scene.rows();
    if (scene.is_static || n < 64) {
      return;
    }
    std::map<std::pair<int, Eigen::Index>, std::vector<double>> series;
    for (Eigen::Index i = 0; i < observations_.size(); ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      if (at.scene == 0) {
        auto& values = series[{at.channel, at.component}];
        values.resize(static_cast<std::size_t>(n), 0.0);
        values[static_cast<std::size_t>(at.row)] = residual_[i];
      }
    }
    const double duration = scene.time[n - 1] - scene.time[0];
    for (const auto& [component, values] : series) {
      add_lines(values, duration, static_cast<double>(series.size()));
    }
    std::sort(location_.frequency_hz.begin(), location_.frequency_hz.end());
  }

  void add_lines(const std::vector<double>& values, double duration, double components) {
    constexpr std::size_t kFewestPeriods = 12;  // below it is the motion itself
    constexpr std::size_t kNeighbours = 30;     // on either side: their median is told to a fifth
    Eigen::FFT<double> transform;
    std::vector<std::complex<double>> spectrum;
    transform.fwd(spectrum, values);
    const std::size_t half = values.size() / 2;
    std::vector<double> power(half, 0);
    double whole = 0;
    for (std::size_t k = 1; k < half; ++k) {
      power[k] = std::norm(spectrum[k]);
      whole += power[k];
    }
    for (std::size_t k = kFewestPeriods; k + 1 < half; ++k) {
      if (power[k] < power[k - 1] || power[k] < power[k + 1] || power[k] < 0.1 * whole) {
        continue;
      }
      const std::size_t first = k > kNeighbours ? k - kNeighbours : 1;
      const std::vector<double> near(
          power.begin() + static_cast<std::ptrdiff_t>(first),
          power.begin() + static_cast<std::ptrdiff_t>(std::min(half, k + kNeighbours)));
      // The median of exponentially distributed power is ln 2 of its mean.
      const double mean = statistics::median(near) / std::log(2.0);
      const double chance =
          std::exp(-power[k] / std::max(mean, 1e-300)) * static_cast<double>(half) * components;
      const double frequency = static_cast<double>(k) / duration;
      const bool is_new =
          std::none_of(location_.frequency_hz.begin(), location_.frequency_hz.end(),
                       [&](double other) { return std::abs(other - frequency) < 3 / duration; });
      if (chance < kSignificance && is_new) {
        location_.frequency_hz.push_back(frequency);
      }
    }
  }

  const Observations& observations_;
  const Eigen::VectorXd& residual_;
  double independent_share_ = 1;
  double total_ = 0;
  std::vector<std::vector<Cue>> cues_;
  Location location_;
};

}  // namespace

Location locate(const Observations& observations, const Eigen::VectorXd& residual) {
  return Locator(observations, residual).run();
}

}  // namespace flexcomp::diagnosis
