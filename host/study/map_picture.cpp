#include "study/map_picture.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flexcomp::study {
namespace {

constexpr double kMillimetres = 1e3;

/// Contours a round number apart, some ten of them.
double contour_spacing(double range) {
  const double raw = range / 12;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power) {
      return factor * power;
    }
  }
  return 10 * power;
}

std::string nodes(const CircularityMap& map) {
  std::string text = "$map << EOD\n";
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double value = map.at(column, row);
      text += std::isnan(value) ? fmt::format("{:.6g} {:.6g} NaN\n", map.x(column), map.z(row))
                                : fmt::format("{:.6g} {:.6g} {:.6g}\n", map.x(column), map.z(row),
                                              kMillimetres * value);
    }
    text += "\n";
  }
  return text + "EOD\n";
}

/// The squares as outlines, each with its size and worst circularity in the key.
std::string outlines(const std::vector<BestSquare>& squares) {
  std::string text;
  constexpr const char* kColours[] = {"#c0392b", "#8e44ad", "#0b5345", "#1a1a1a"};
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const BestSquare& square = squares[i];
    if (!square.fits) {
      continue;
    }
    const double half = square.size / 2;
    text += fmt::format("$square{} << EOD\n{} {}\n{} {}\n{} {}\n{} {}\n{} {}\nEOD\n", i,
                        square.x - half, square.z - half, square.x + half, square.z - half,
                        square.x + half, square.z + half, square.x - half, square.z + half,
                        square.x - half, square.z - half);
    text += fmt::format(
        "plots = plots . \", $square{0} with lines lw 2.5 lc rgb '{1}' title "
        "'best {2:g} × {2:g} mm: at most {3:.2f} mm'\"\n",
        i, kColours[i % 4], kMillimetres * square.size, kMillimetres * square.worst);
  }
  return text;
}

/// How far the arm reaches, and from where.
std::string reach(const PlanarArm& arm) {
  return fmt::format(
      "plots = plots . \", {0}+{2}*cos(t), {1}+{2}*sin(t) with lines dt 2 lc rgb '#666666' title "
      "'reach without joint limits'\"\n"
      "$joint << EOD\n{0} {1}\nEOD\nplots = plots . \", $joint with points pt 7 ps 1.3 lc rgb "
      "'black' title 'axis of joint 2'\"\n",
      arm.shoulder.real(), arm.shoulder.imag(), std::abs(arm.upper_arm) + std::abs(arm.forearm));
}

}  // namespace

std::string map_script(const CircularityMap& map, const std::optional<PlanarArm>& arm,
                       const std::vector<BestSquare>& squares, const std::string& title) {
  const MapSummary summary = summarize(map);
  const double spacing = contour_spacing(kMillimetres * (summary.max - summary.min));
  return nodes(map) + fmt::format("set title \"{}\" noenhanced\n", title) +
         fmt::format(
             "set contour base\nunset surface\nset cntrparam levels incremental 0,{0:g},{1:g}\n"
             "set cntrlabel onecolor\nset table $contours\nsplot $map using 1:2:3 with "
             "lines\nunset table\n",
             spacing, kMillimetres * summary.max) +
         fmt::format(
             "set size ratio -1\nset xlabel 'x, m'\nset ylabel 'z, m'\nset cblabel 'circularity, "
             "mm (contours every {:g} mm)'\nset palette defined (0 '#2c7bb6', 1 '#abd9e9', 2 "
             "'#ffffbf', 3 '#fdae61', 4 '#d7191c')\n"
             "set bmargin at screen 0.22\nset key at screen 0.5,0.01 center bottom maxcols 2\n"
             "set grid lc rgb '#dddddd'\nset parametric\nset trange [0:2*pi]\nset samples 400\n"
             "set xrange [{}:{}]\nset yrange [{}:{}]\nset cbrange [{}:{}]\n",
             spacing, map.x(0), map.x(map.columns - 1), map.z(0), map.z(map.rows - 1),
             kMillimetres * summary.min, kMillimetres * summary.max) +
         "plots = \"$map using 1:2:3 with image notitle\"\n"
         "plots = plots . \", $contours with lines lw 1 lc rgb '#444444' notitle\"\n" +
         outlines(squares) + (arm ? reach(*arm) : "") + "eval 'plot ' . plots\n";
}

}  // namespace flexcomp::study
