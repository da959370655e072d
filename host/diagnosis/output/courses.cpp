#include "diagnosis/output/courses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/output/shown_time.hpp"
#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"
#include "report/gnuplot.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr std::size_t kMostCoursePoints = 1200;  // more than the picture is wide in pixels

/// One component at one time, SI.
struct CoursePoint {
  double time, measured, nominal, updated;
};

using Course = std::vector<CoursePoint>;

Course course_of(const Observations& observations, const Eigen::VectorXd& updated, Channel channel,
                 Eigen::Index component) {
  const Scene& scene = observations.scenes.front();
  const Eigen::VectorXd time = shown_time(scene);
  Course course;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.scene == 0 && at.channel == channel && at.component == component) {
      const double measured = scene.measured[channel](at.row, component);
      const double noise = observations.noise[i];
      course.push_back({time[at.row], measured, measured - noise * observations.residual[i],
                        measured - noise * updated[i]});
    }
  }
  std::sort(course.begin(), course.end(),
            [](const CoursePoint& a, const CoursePoint& b) { return a.time < b.time; });
  return course;
}

/// A block of gnuplot's data; an empty line where rows are missing, so that no line bridges them.
std::string course_block(const std::string& name, const Course& course, double scale) {
  std::string text = fmt::format("${} << EOD\n", name);
  const std::size_t each = std::max<std::size_t>(1, course.size() / kMostCoursePoints);
  const double span = course.back().time - course.front().time;
  const double usual = span / static_cast<double>(std::max<std::size_t>(course.size(), 2) - 1);
  double last = course.front().time;
  for (std::size_t i = 0; i < course.size(); i += each) {
    const CoursePoint& at = course[i];
    text += at.time - last > 8 * static_cast<double>(each) * usual ? "\n" : "";
    text += fmt::format("{:.6g} {:.9g} {:.9g} {:.9g}\n", at.time, scale * at.measured,
                        scale * at.nominal, scale * at.updated);
    last = at.time;
  }
  return text + "EOD\n";
}

/// A unit in which the course's own size is easy to read.
Scale course_scale(Channel channel, const std::string& unit, const Course& course) {
  double most = 0;
  for (const CoursePoint& at : course) {
    most = std::max(most, std::abs(at.measured));
  }
  if (channel == simulation::tcp_position && most > 0.1) {
    return {1, "m"};
  }
  return scale_of(unit, most);
}

constexpr const char* kMeasured = "#222222";
constexpr const char* kNominal = "#c0392b";
constexpr const char* kUpdated = "#1f6fb4";

/// A component: its data, and the scripts that draw its course and its error.
struct Panel {
  std::string data, course, error;
};

std::vector<Panel> panels_of(const Observations& observations, const Eigen::VectorXd& updated,
                             Channel channel) {
  const Scene& scene = observations.scenes.front();
  const std::string with = scene.is_static ? "points pt 7 ps 0.4" : "lines lw 1.2";
  std::vector<Panel> panels;
  for (Eigen::Index component = 0; component < scene.measured[channel].cols(); ++component) {
    const Course course = course_of(observations, updated, channel, component);
    if (course.size() < 2) {
      continue;
    }
    double largest = 0;
    for (const CoursePoint& at : course) {
      largest = std::max(largest, std::abs(at.measured - at.nominal));
    }
    const std::string unit = unit_of(observations, channel, component);
    const Scale size = course_scale(channel, unit, course);
    const Scale error = scale_of(unit, largest);
    const std::string name = fmt::format("course{}", component);
    const double times = error.factor / size.factor;
    panels.push_back(
        {course_block(name, course, size.factor),
         fmt::format(
             "set ylabel '{}, {}'\nplot ${} using 1:2 with {} lc rgb '{}' title 'measured', "
             "'' using 1:3 with {} lc rgb '{}' title 'model', '' using 1:4 with {} lc rgb "
             "'{}' title 'updated'\n",
             component_in_words(channel, component), size.unit, name, with, kMeasured, with,
             kNominal, with, kUpdated),
         fmt::format(
             "set ylabel 'error, {}'\nplot ${} using 1:({:g}*($2-$3)) with {} lc rgb '{}' "
             "title 'before', '' using 1:({:g}*($2-$4)) with {} lc rgb '{}' title 'after'\n",
             error.unit, name, times, with, kNominal, times, with, kUpdated)});
  }
  return panels;
}

}  // namespace

std::string course_picture(const Observations& observations, const Eigen::VectorXd& updated,
                           Channel channel) {
  constexpr int kPanelHeight = 140;  // pixels
  constexpr double kGap = 9;         // above and below a panel
  constexpr int kTop = 30;           // above all panels, for the title
  constexpr int kBottom = 60;        // below them, for the scale of time
  const Scene& scene = observations.scenes.front();
  const std::vector<Panel> panels = panels_of(observations, updated, channel);
  if (panels.empty()) {
    return "";
  }
  const int height = kTop + kPanelHeight * static_cast<int>(panels.size()) + kBottom;
  std::string script;
  for (const Panel& panel : panels) {
    script += panel.data;
  }
  script += fmt::format(
      "set grid lc rgb '#dddddd'\n{}set ytics nomirror\n"
      "set format x ''\nset xtics nomirror\nset multiplot\n",
      range_of(shown_time(scene)));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int upper = height - kTop - kPanelHeight * static_cast<int>(i);
    script += fmt::format("set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
                          (upper - kGap) / height, (upper - kPanelHeight + kGap) / height);
    if (i + 1 == panels.size()) {
      script += fmt::format("set format x '%g'\nset xlabel '{}'\n",
                            scene.is_static ? "row of the load test" : "time, s");
    }
    const char* key =
        i == 0 ? "set key at screen {},screen 0.995 right top horizontal maxrows 1 samplen 2\n"
               : "unset key\n";
    script += fmt::format(fmt::runtime(key), 0.55) +
              "set lmargin at screen 0.085\nset rmargin at screen 0.5\n" + panels[i].course;
    script += fmt::format(fmt::runtime(key), 0.98) +
              "set lmargin at screen 0.59\nset rmargin at screen 0.98\n" + panels[i].error;
  }
  return report::plot_svg(script + "unset multiplot\n", 940, height);
}

}  // namespace flexcomp::diagnosis
