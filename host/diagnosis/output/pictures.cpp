#include "diagnosis/output/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/cues.hpp"
#include "diagnosis/output/shown_time.hpp"
#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"
#include "report/gnuplot.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr const char* kBefore = "#c0392b";
constexpr const char* kAfter = "#1f6fb4";
constexpr Eigen::Index kMostPoints = 2500;  // some times what the picture is wide in pixels

/// Length of the residual's vector in each row of the first recording, SI; NaN where it is missing.
Eigen::VectorXd length_by_row(const Observations& observations, const Eigen::VectorXd& values,
                              Channel channel) {
  const Eigen::Index rows = observations.scenes.front().rows();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.scene == 0 && at.channel == channel) {
      sum[at.row] += std::pow(values[i] * observations.noise[i], 2);
      count[at.row] += 1;
    }
  }
  return (count.array() > 0)
      .select(sum.array().sqrt(), Eigen::ArrayXd::Constant(rows, std::nan("")))
      .matrix();
}

std::string block(const std::string& name, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  std::string text = fmt::format("${} << EOD\n", name);
  const Eigen::Index each = std::max<Eigen::Index>(1, x.size() / kMostPoints);
  for (Eigen::Index i = 0; i < x.size(); i += each) {
    if (std::isfinite(y[i])) {
      text += fmt::format("{:.6g} {:.6g}\n", x[i], y[i]);
    }
  }
  return text + "EOD\n";
}

double largest_of(const Eigen::VectorXd& values) {
  return values.array().isFinite().select(values.array(), 0.0).maxCoeff();
}

}  // namespace

std::string time_picture(const Observations& observations, const Eigen::VectorXd& after,
                         Channel channel) {
  const Scene& scene = observations.scenes.front();
  const Eigen::VectorXd lengths = length_by_row(observations, observations.residual, channel);
  if (!lengths.array().isFinite().any()) {
    return "";  // the columns hold no sample
  }
  const Scale scale = scale_of(unit_of(observations, channel), largest_of(lengths));
  const Eigen::VectorXd time = shown_time(scene);
  const Eigen::VectorXd first = scale.factor * lengths;
  const Eigen::VectorXd second = scale.factor * length_by_row(observations, after, channel);
  const std::string style = scene.is_static ? "points pt 7 ps 0.7" : "points pt 7 ps 0.15";
  std::string script = block("before", time, first) + block("after", time, second);
  script += fmt::format(
      "set grid lc rgb '#dddddd'\nset key outside above horizontal\nset yrange [0:*]\n"
      "{}set xlabel '{}'\nset ylabel 'residual, {}'\n"
      "plot $before using 1:2 with {} lc rgb '{}' notitle, $after using 1:2 with {} lc rgb '{}' "
      "notitle, NaN with points pt 7 lc rgb '{}' title 'before', "
      "NaN with points pt 7 lc rgb '{}' title 'after'\n",
      range_of(time), scene.is_static ? "row of the load test" : "time, s", scale.unit, style,
      kBefore, style, kAfter, kBefore, kAfter);
  return report::plot_svg(script, 900, 330);
}

std::string path_picture(const Observations& observations, const Eigen::VectorXd& after) {
  const std::vector<Cue> cues =
      cues_of(observations.scenes.front(), observations.predictions.front(),
              observations.simulations.front());
  const auto path = std::find_if(cues.begin(), cues.end(),
                                 [](const Cue& cue) { return cue.name == "path angle"; });
  if (path == cues.end()) {
    return "";
  }
  const auto classes = static_cast<Eigen::Index>(path->classes);
  Eigen::VectorXd at(classes);
  std::array<Eigen::VectorXd, 2> rms = {Eigen::VectorXd::Zero(classes),
                                        Eigen::VectorXd::Zero(classes)};
  Eigen::VectorXd count = Eigen::VectorXd::Zero(classes);
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& sample = observations.samples[static_cast<std::size_t>(i)];
    if (sample.scene == 0 && sample.channel == simulation::tcp_position) {
      const int k = path->kind[sample.row];
      rms[0][k] += std::pow(observations.residual[i] * observations.noise[i], 2);
      rms[1][k] += std::pow(after[i] * observations.noise[i], 2);
      count[k] += 1;
    }
  }
  for (Eigen::Index k = 0; k < classes; ++k) {
    at[k] = static_cast<double>(k + 1);
    for (Eigen::VectorXd& values : rms) {
      values[k] = std::sqrt(values[k] / std::max(count[k], 1.0));
    }
  }
  const Scale scale = scale_of("m", rms[0].maxCoeff());
  for (Eigen::VectorXd& values : rms) {
    values *= scale.factor;
  }
  return report::plot_svg(
      block("before", at, rms[0]) + block("after", at, rms[1]) +
          fmt::format(
              "set grid lc rgb '#dddddd'\nset key outside above horizontal\nset yrange [0:*]\n"
              "set xrange [0.5:{}]\nset xtics 1\n"
              "set xlabel 'twelfth of the way around the middle of the path'\n"
              "set ylabel 'rms a component, {}'\n"
              "plot $before using 1:2 with linespoints pt 7 lw 2 lc rgb '{}' title 'before', "
              "$after using 1:2 with linespoints pt 7 lw 2 lc rgb '{}' title 'after'\n",
              static_cast<double>(classes) + 0.5, scale.unit, kBefore, kAfter),
      900, 300);
}

std::string ranking_picture(const std::vector<Ranked>& ranking) {
  constexpr std::size_t kMost = 10;  // bars that are read
  const std::size_t count = std::min(kMost, ranking.size());
  if (count == 0) {
    return "";
  }
  std::string script = "$bars << EOD\n";
  for (std::size_t i = 0; i < count; ++i) {
    script += fmt::format("{} {:.6g} \"{}\"\n", count - i, ranking[i].gain,
                          place_in_words(ranking[i].effect, ranking[i].joint));
  }
  script += fmt::format(
      "EOD\nset style fill solid\nset boxwidth 0.7\nset grid x lc rgb '#dddddd'\nunset key\n"
      "set xrange [0:*]\nset yrange [0.4:{}]\nset format x '%.0f'\n"
      "set xlabel 'gain in evidence if it were alone (BIC)'\n"
      "plot $bars using ($2/2):1:($2/2):(0.35):ytic(3) with boxxyerror lc rgb '{}'\n",
      static_cast<double>(count) + 0.6, kAfter);
  return report::plot_svg(script, 900, 90 + 24 * static_cast<int>(count));
}

}  // namespace flexcomp::diagnosis
