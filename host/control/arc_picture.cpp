#include "control/arc_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexcomp::control {

std::string cost_script(const ArcPart<3>& link_part, const ArcPart<4>& motor_part,
                        const std::string& title) {
  const GainCost& link = link_part.cost;
  const GainCost& motor = motor_part.cost;
  constexpr int kSteps = 120;
  const double link_best = link_part.root;
  const double motor_best = motor_part.root;
  // On either side of the optimum, as far as the gains in use.
  const double decades = std::max({1.0, 1.1 * std::log10(link_best / link_part.gain),
                                   1.1 * std::log10(motor_best / motor_part.gain)});
  // Each part in units of its own terms, or the larger part would hide the other.
  const auto excess = [](const GainCost& cost, double best, double gain) {
    const double scale =
        std::abs(cost.linear) / best + cost.square / (best * best) + cost.effort * best * best;
    return (cost(gain) - cost(best)) / scale;
  };
  std::string text = "$cost << EOD\n";
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double one = link_best * std::pow(10, decades * (2.0 * i / kSteps - 1));
      const double two = motor_best * std::pow(10, decades * (2.0 * j / kSteps - 1));
      text += fmt::format(
          "{:.6g} {:.6g} {:.6g}\n", std::log10(one), std::log10(two),
          std::log10(1 + 100 * (excess(link, link_best, one) + excess(motor, motor_best, two))));
    }
    text += "\n";
  }
  return text +
         fmt::format(
             "EOD\n$best << EOD\n{0:.6g} {1:.6g}\nEOD\n$used << EOD\n{6:.6g} {7:.6g}\nEOD\n"
             "set title \"{2}\" noenhanced\n"
             "set contour base\nunset surface\nset cntrparam levels 14\nset cntrlabel onecolor\n"
             "set table $contours\nsplot $cost using 1:2:3 with lines\nunset table\n"
             "set size square\nset format xy '10^{{%.1f}}'\n"
             "set xlabel 'gain of the link side, 1/W'\nset ylabel 'gain of the motor side, 1/W'\n"
             "set cblabel 'cost above its least, per cent of its terms there' offset 2,0\n"
             "set cbtics ('0' 0, '1' log10(2), '10' log10(11), '100' log10(101), '1000' "
             "log10(1001), '10^4' 4, '10^5' 5, '10^6' 6)\n"
             "set palette defined (0 '#2c7bb6', 1 '#abd9e9', 2 '#ffffbf', 3 '#fdae61', 4 "
             "'#d7191c')\nset xrange [{0}-{3}:{0}+{3}]\nset yrange [{1}-{3}:{1}+{3}]\n"
             "set bmargin at screen 0.19\nset key at screen 0.5,0.02 center bottom\n"
             "plot $cost with image notitle, $contours with lines lw 1 lc rgb '#444444' "
             "notitle, $best with points pt 2 ps 2 lw 3 lc rgb 'black' title 'least cost: {4:.3g} "
             "and {5:.3g} 1/W, roots of the two quartics', $used with points pt 6 ps 3 lw 3 lc rgb "
             "'black' title 'used, within the limits of the slopes: {8:.3g} and {9:.3g} 1/W'\n",
             std::log10(link_best), std::log10(motor_best), title, decades, link_best, motor_best,
             std::log10(link_part.gain), std::log10(motor_part.gain), link_part.gain,
             motor_part.gain);
}

}  // namespace flexcomp::control
