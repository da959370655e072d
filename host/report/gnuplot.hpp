#pragma once

#include <string>

namespace flexcomp::report {

/// Runs a gnuplot script and returns the picture as SVG markup. The script must not set terminal or
/// output. Throws InputError where gnuplot is not installed or does not like the script.
std::string plot_svg(const std::string& script, int width, int height);

/// The same as the bytes of a PNG file.
std::string plot_png(const std::string& script, int width, int height);

}  // namespace flexcomp::report
