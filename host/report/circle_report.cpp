#include "report/circle_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/gnuplot.hpp"
#include "report/html.hpp"

namespace flexcomp::report {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr const char* kColors[] = {"#c0392b", "#1f6fb4", "#7f8c8d", "#b9770e", "#6c3483"};

/// Name for gnuplot: no quotes, no markup.
std::string plain(const std::string& text) {
  std::string name = text;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\'' || c == '"' || c == '\n'; }, ' ');
  return name;
}

/// Radial deviation of each point from the circle's least-squares circle.
struct Deviation {
  std::vector<double> angle;   ///< degrees from the first axis, 0 to 360
  std::vector<double> radial;  ///< µm
};

Deviation deviation(const geometry::Points& points) {
  const geometry::Circularity fit = geometry::least_squares_circularity(points);
  double radius = 0;
  for (const Eigen::Vector2d& point : points) {
    radius += (point - fit.center).norm() / static_cast<double>(points.size());
  }
  std::vector<std::pair<double, double>> pairs;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d arm = point - fit.center;
    const double angle = std::atan2(arm.y(), arm.x()) * 180 / kPi;
    pairs.emplace_back(angle < 0 ? angle + 360 : angle, 1e6 * (arm.norm() - radius));
  }
  std::sort(pairs.begin(), pairs.end());
  Deviation result;
  for (const auto& [angle, radial] : pairs) {
    result.angle.push_back(angle);
    result.radial.push_back(radial);
  }
  return result;
}

std::string data_block(std::size_t index, const Deviation& deviation, bool closed) {
  std::string block = fmt::format("$circle{} << EOD\n", index);
  for (std::size_t i = 0; i < deviation.angle.size(); ++i) {
    block += fmt::format("{} {}\n", deviation.angle[i], deviation.radial[i]);
  }
  if (closed) {
    block += fmt::format("{} {}\n", deviation.angle.front() + 360, deviation.radial.front());
  }
  return block + "EOD\n";
}

/// A round number not below a value: 1, 2 or 5 times a power of ten.
double round_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(std::max(value, 1e-9))));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value) {
      return digit * power;
    }
  }
  return 10 * power;
}

std::string curves(const CircleReport& report) {
  std::string plots;
  for (std::size_t i = 0; i < report.circles.size(); ++i) {
    plots += fmt::format("{}$circle{} using 1:2 with lines lw {} lc rgb '{}' title '{}'",
                         i == 0 ? "plot " : ", ", i, i < 2 ? 2.5 : 1.5,
                         kColors[i % std::size(kColors)], plain(report.circles[i].name));
  }
  return plots + "\n";
}

/// The circle as a ballbar prints it: the zero line is the mean circle, deviations stand out from
/// it.
std::string polar_plot(const CircleReport& report, const std::vector<Deviation>& deviations,
                       double largest) {
  const double scale = round_up(largest);
  std::string script = fmt::format(
      "set polar\nset angles degrees\nunset border\nunset xtics\nunset ytics\nunset raxis\n"
      "set size square\nset rrange [{}:{}]\nset rtics {} format '%g' font ',10'\n"
      "set grid polar 30 lc rgb '#dddddd'\nset ttics 0,30 font ',10' offset 0,0\n"
      "set key below horizontal\n"
      "set title 'Radial deviation, µm, from the mean circle'\n",
      -3 * scale, scale * 1.2, scale);
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    script += data_block(i, deviations[i], true);
  }
  script += curves(report);
  script.pop_back();
  script += fmt::format(", 0 with lines lw 1 dt 2 lc rgb '#444444' title 'mean circle'\n");
  return plot_svg(script, 640, 680);
}

std::string line_plot(const CircleReport& report, const std::vector<Deviation>& deviations) {
  std::string script =
      "set xrange [0:360]\nset xtics 45\nset grid lc rgb '#dddddd'\n"
      "set key above horizontal\n";
  script += fmt::format("set xlabel 'angle along the circle from {}, degrees'\n",
                        report.plane.substr(0, 1));
  script += "set ylabel 'radial deviation, µm'\n";
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    script += data_block(i, deviations[i], false);
  }
  return plot_svg(script + curves(report), 900, 360);
}

std::string circularity_rows(const CircleReport& report) {
  std::string rows;
  for (const NamedCircle& circle : report.circles) {
    const std::array<geometry::Circularity, 4> results = {
        geometry::least_squares_circularity(circle.points),
        geometry::minimum_zone_circularity(circle.points),
        geometry::maximum_inscribed_circularity(circle.points),
        geometry::minimum_circumscribed_circularity(circle.points)};
    rows += fmt::format("<tr><th>{}</th>", escaped(circle.name));
    for (const geometry::Circularity& result : results) {
      rows += fmt::format("<td>{:.4f}</td>", 1e3 * result.value());
    }
    const geometry::Circularity& fit = results[0];
    rows +=
        fmt::format("<td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td></tr>\n", 1e3 * fit.center.x(),
                    1e3 * fit.center.y(), 1e3 * (fit.r_min + fit.r_max) / 2);
  }
  return rows;
}

std::string certificate(const Table& table) {
  const TableHeader& header = table.header();
  return fmt::format(
      "<h2>The table's certificate</h2>\n"
      "<p>{} nodes, {} bytes, robot fingerprint <code>{:016x}</code>. For any force up to {:.6g} N "
      "and "
      "moment up to {:.6g} N·m, anywhere on its path, neither the predicted deflection nor the "
      "corrected TCP is further than <b>{:.3g} µm</b> and <b>{:.3g} µrad</b> from what the model "
      "says. "
      "This is a bound, not a sample: between the points that were computed, the curvature of the "
      "error is bounded from the robot's link lengths and springs.</p>\n",
      header.node_count, header.size, table.model_hash(), static_cast<double>(header.force_bound),
      static_cast<double>(header.moment_bound), 1e6 * static_cast<double>(header.position_error),
      1e6 * static_cast<double>(header.orientation_error));
}

std::string headline(const CircleReport& report) {
  const auto lsc = [&](std::size_t i) {
    return 1e3 * geometry::least_squares_circularity(report.circles[i].points).value();
  };
  const double first = lsc(0);
  if (report.circles.size() < 2) {
    return fmt::format("{}: circularity {:.3f} mm", report.robot, first);
  }
  const double second = lsc(1);
  return fmt::format("{}: circularity {:.3f} mm {}, {:.4f} mm {} ({:.2g} %)", report.robot, first,
                     report.circles[0].name, second, report.circles[1].name, 100 * second / first);
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:940px;margin:2em auto;padding:0 1em;color:#222}"
    "h1{font-size:1.35em}h2{font-size:1.1em;margin-top:2em}"
    "table{border-collapse:collapse}th,td{padding:.25em .8em;border-bottom:1px solid #ddd;"
    "text-align:right}th:first-child{text-align:left}svg{max-width:100%;height:auto}";

}  // namespace

std::string circle_report_html(const CircleReport& report) {
  std::vector<Deviation> deviations;
  double largest = 0;
  for (const NamedCircle& circle : report.circles) {
    deviations.push_back(deviation(circle.points));
    for (const double radial : deviations.back().radial) {
      largest = std::max(largest, std::abs(radial));
    }
  }
  const std::string title = escaped(headline(report));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>"
      "<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
      "<h2>Circularity, mm (ISO 12181-1, plane {2}, no filter)</h2>\n"
      "<table><tr><th></th><th>LSC</th><th>MZC</th><th>MIC</th><th>MCC</th>"
      "<th>center 1</th><th>center 2</th><th>radius</th></tr>\n{3}</table>\n"
      "<p>LSC least squares, MZC minimum zone, MIC maximum inscribed, MCC minimum circumscribed "
      "circle. Center and radius: of the least-squares circle and half way between its nearest and "
      "farthest point.</p>\n"
      "<h2>The circle, deviations magnified</h2>\n{4}\n"
      "<h2>Along the circle</h2>\n{5}\n{6}</body></html>\n",
      title, kStyle, escaped(report.plane), circularity_rows(report),
      polar_plot(report, deviations, largest), line_plot(report, deviations),
      report.table != nullptr ? certificate(*report.table) : "");
}

}  // namespace flexcomp::report
