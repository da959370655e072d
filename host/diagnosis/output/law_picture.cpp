#include "diagnosis/output/law_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/grammar/seat.hpp"
#include "diagnosis/output/words.hpp"
#include "effects/formula_law.hpp"
#include "error.hpp"
#include "report/gnuplot.hpp"
#include "report/html.hpp"
#include "statistics/median.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr Eigen::Index kBins = 30;   // points along a driver
constexpr double kFewestInMean = 4;  // samples of a mean that is drawn
constexpr std::array<const char*, 3> kDots = {"#c0392b", "#1f6fb4", "#222222"};

/// A text between gnuplot's single quotes, where an apostrophe is written twice.
std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char each : text) {
    all += each == '\'' ? "''" : std::string(1, each);
  }
  return all + "'";
}

/// Sums over the samples of a class: errors by levers, and levers squared.
struct Means {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(kBins);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(kBins);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(kBins);
};

/// A law's place, the signals that it follows along the samples, and what is left there.
class Portrait {
 public:
  Portrait(const Observations& observations, const Chosen& law, const Eigen::VectorXd& after)
      : observations_(observations),
        bound_(*law.hypothesis.law->bound),
        lever_(grammar::levers_of(observations, bound_.place)),
        after_(after),
        change_(change_by(law)) {
    for (std::size_t i = 0; i < bound_.signals.size(); ++i) {
      if (bound_.signals[i]) {
        drivers_.push_back(along_samples(*bound_.signals[i]));
        words_.push_back(fmt::format("{}, {}", bound_.signals[i]->words, bound_.signals[i]->unit));
      }
    }
  }

  bool is_drawn() const { return !drivers_.empty() && lever_.squaredNorm() > 0; }

  std::string picture() const {
    const std::string unit = effects::unit_at(bound_.place, observations_.machine.robot);
    const Scale scale = scale_of(unit, largest());
    std::string data;
    std::string plots;
    for (const bool held_out : {false, true}) {
      std::string parts;
      for (int side = 0; side < sides(); ++side) {
        add_side(held_out, side, scale.factor, &data, &parts);
      }
      plots += fmt::format("set title '{}'\nplot {}\n", held_out ? "held out" : "fitted to", parts);
    }
    return report::plot_svg(
        data +
            fmt::format("set multiplot layout 1,2\nset grid lc rgb '#dddddd'\nset xlabel {}\n"
                        "set ylabel 'error at the place, {}'\n"
                        "set key below\nset xrange [{:.6g}:{:.6g}]\n",
                        quoted(words_.front()), scale.unit, low(), high()) +
            plots + "unset multiplot\n",
        900, 340);
  }

 private:
  double low() const { return drivers_.front().minCoeff(); }
  double high() const { return drivers_.front().maxCoeff(); }
  int sides() const { return drivers_.size() > 1 ? 2 : 1; }

  double largest() const {
    return std::sqrt(change_.squaredNorm() / std::max(lever_.squaredNorm(), 1e-300));
  }

  /// The change of all samples by the law alone, over the noise.
  Eigen::VectorXd change_by(const Chosen& law) const {
    Machine alone = observations_.machine;
    alone.terms.clear();
    law.hypothesis.apply(law.values, &alone);
    const auto predicted = [&](const std::vector<simulation::Term>& terms) {
      return observations_.stacked(
          with_terms(terms, observations_.scenes, observations_.simulations));
    };
    return predicted(alone.terms) - predicted({});
  }

  Eigen::VectorXd along_samples(const effects::Signal& signal) const {
    std::vector<Eigen::VectorXd> by_scene;
    for (std::size_t s = 0; s < observations_.scenes.size(); ++s) {
      const Scene& scene = observations_.scenes[s];
      by_scene.push_back(values_of(signal, scene, observations_.simulations[s],
                                   observations_.predictions[s], effects::Loads::with_inertia,
                                   scene.time[0]));
    }
    Eigen::VectorXd all(observations_.size());
    for (Eigen::Index i = 0; i < all.size(); ++i) {
      const Sample& at = observations_.samples[static_cast<std::size_t>(i)];
      all[i] = by_scene[at.scene][at.row];
    }
    return all;
  }

  /// Means over the first driver of values of the samples, on one side of the second's median.
  Means means_of(const Eigen::VectorXd& values, bool held_out, int side) const {
    Means means;
    const double middle =
        sides() > 1 ? statistics::median({drivers_[1].begin(), drivers_[1].end()}) : 0;
    const Part part = observations_.part(held_out);
    for (Eigen::Index i = part.first; i < part.end; ++i) {
      if (lever_[i] == 0 || (sides() > 1 && (drivers_[1][i] > middle) != (side == 0))) {
        continue;
      }
      const double place = (drivers_.front()[i] - low()) / std::max(high() - low(), 1e-300);
      const auto k = std::min(static_cast<Eigen::Index>(place * kBins), kBins - 1);
      means.product[k] += lever_[i] * values[i];
      means.weight[k] += lever_[i] * lever_[i];
      means.count[k] += 1;
    }
    return means;
  }

  std::string block(const std::string& name, const Means& means, double scale) const {
    std::string text = fmt::format("${} << EOD\n", name);
    for (Eigen::Index k = 0; k < kBins; ++k) {
      if (means.count[k] >= kFewestInMean) {
        const double at = low() + (static_cast<double>(k) + 0.5) * (high() - low()) / kBins;
        text += fmt::format("{:.6g} {:.6g}\n", at, scale * means.product[k] / means.weight[k]);
      }
    }
    return text + "EOD\n";
  }

  void add_side(bool held_out, int side, double scale, std::string* data,
                std::string* plots) const {
    const std::array<std::pair<const char*, Eigen::VectorXd>, 3> courses = {
        {{"before", after_ + change_}, {"after", after_}, {"law", change_}}};
    for (std::size_t i = 0; i < courses.size(); ++i) {
      const std::string name =
          fmt::format("{}{}{}", courses[i].first, held_out ? "Held" : "Fitted", side);
      const Means means = means_of(courses[i].second, held_out, side);
      if (means.count.maxCoeff() < kFewestInMean) {
        continue;
      }
      *data += block(name, means, scale);
      const std::string style = i == 2 ? std::string("lines lw 2")
                                       : fmt::format("points pt {} ps 0.6", side == 0 ? 7 : 6);
      *plots += fmt::format("{}${} using 1:2 with {} lc rgb '{}' {}", plots->empty() ? "" : ", ",
                            name, style, kDots[i],
                            side == 0 ? fmt::format("title '{}'", courses[i].first) : "notitle");
    }
    if (plots->empty()) {
      *plots = "NaN notitle";
    }
  }

  const Observations& observations_;
  const effects::BoundFormula& bound_;
  Eigen::VectorXd lever_;
  const Eigen::VectorXd& after_;
  Eigen::VectorXd change_;
  std::vector<Eigen::VectorXd> drivers_;
  std::vector<std::string> words_;
};

/// The picture of a law, or a sentence where it cannot be drawn: it is no reason to lose a
/// diagnosis.
std::string drawn(const Observations& observations, const Chosen& law,
                  const Eigen::VectorXd& after) {
  const Portrait portrait(observations, law, after);
  if (!portrait.is_drawn()) {
    return "";
  }
  try {
    return portrait.picture() + "\n";
  } catch (const InputError& error) {
    return fmt::format("<p>No picture of {}: {}.</p>\n",
                       report::escaped(law.hypothesis.law->written->formula), error.what());
  }
}

}  // namespace

std::string law_pictures(const Observations& observations, const Diagnosis& diagnosis) {
  std::string html;
  for (const Chosen& each : diagnosis.weighed().chosen) {
    if (each.hypothesis.law->bound) {
      html += drawn(observations, each, diagnosis.weighed().remainder);
    }
  }
  return html.empty() ? ""
                      : "<h2>Laws</h2>\n<p>Means of the error over what drives the law, before it "
                        "and after it; open points, where a second signal is below its "
                        "median.</p>\n" +
                            html;
}

}  // namespace flexcomp::diagnosis
