#pragma once

#include <string>
#include <vector>

#include "flexcomp/table.hpp"
#include "geometry/circularity.hpp"

namespace flexcomp::report {

/// One recorded circle with its name.
struct NamedCircle {
  std::string name;
  geometry::Points points;  ///< m, in the plane of the circle
};

/// Content of the page.
struct CircleReport {
  std::string robot;
  std::string plane;                 ///< names of the two axes, for example "x, z"
  std::vector<NamedCircle> circles;  ///< the first is the one the others are compared with
  const Table* table = nullptr;      ///< whose certificate to print; may be null
};

/// One self-contained HTML page: what was gained in a sentence, circularity by four methods, the
/// polar plot with the deviations magnified, the deviation along the circle, the certificate.
std::string circle_report_html(const CircleReport& report);

}  // namespace flexcomp::report
