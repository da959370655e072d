#include "control/arc_picture.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flexcomp::control {

std::string cost_script(const GainCost& link, const GainCost& motor, const std::string& title) {
  constexpr int kSteps = 120;
  constexpr double kDecades = 1;  // on either side of the optimum
  const double link_best = link.best();
  const double motor_best = motor.best();
  // Each part against its own least, or the larger part would hide the other.
  const auto excess = [](const GainCost& cost, double best, double gain) {
    const double least = cost(best);
    const double scale = std::abs(least) > 0 ? std::abs(least) : 1;
    return (cost(gain) - least) / scale;
  };
  std::string text = "$cost << EOD\n";
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double one = link_best * std::pow(10, kDecades * (2.0 * i / kSteps - 1));
      const double two = motor_best * std::pow(10, kDecades * (2.0 * j / kSteps - 1));
      text += fmt::format(
          "{:.6g} {:.6g} {:.6g}\n", one, two,
          std::log10(1 + 100 * (excess(link, link_best, one) + excess(motor, motor_best, two))));
    }
    text += "\n";
  }
  const double reach = std::pow(10, kDecades);
  return text +
         fmt::format(
             "EOD\n$best << EOD\n{0:.6g} {1:.6g}\nEOD\nset title \"{2}\" noenhanced\n"
             "set contour base\nunset surface\nset cntrparam levels 14\nset cntrlabel onecolor\n"
             "set table $contours\nsplot $cost using 1:2:3 with lines\nunset table\n"
             "set logscale xy\nset size square\nset format xy '%.1e'\n"
             "set xtics rotate by -30\n"
             "set xlabel 'gain of the link side, 1/W' offset 0,-0.6\n"
             "set ylabel 'gain of the motor side, 1/W' offset -1,0\n"
             "set cblabel 'cost above its least, percent of it (log scale)'\n"
             "set cbtics ('0' 0, '1' log10(2), '10' log10(11), '100' log10(101), '1000' "
             "log10(1001), '10^4' 4, '10^5' 5, '10^6' 6)\n"
             "set palette defined (0 '#2c7bb6', 1 '#abd9e9', 2 '#ffffbf', 3 '#fdae61', 4 "
             "'#d7191c')\nset xrange [{3:.6g}:{4:.6g}]\nset yrange [{5:.6g}:{6:.6g}]\n"
             "set key outside bottom center\nset pm3d map\n"
             "plot $cost using 1:2:3 with pm3d notitle, $contours with lines lw 1 lc rgb '#444444' "
             "notitle, $best with points pt 2 ps 2 lw 3 lc rgb 'black' title 'least cost: {0:.3g} "
             "and {1:.3g} 1/W, roots of the two quartics'\n",
             link_best, motor_best, title, link_best / reach, link_best * reach, motor_best / reach,
             motor_best * reach);
}

}  // namespace flexcomp::control
