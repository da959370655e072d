#include "control/path_gain.hpp"

#include <algorithm>

#include "flexcomp/compliance.hpp"

namespace flexcomp::control {

double largest_safe_gain_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                               const simulation::Process& process, const CorrectionLoop& loop) {
  constexpr double kNone = 1e-6;
  const simulation::Contour contour(model, path, process.side);
  double gain = 1;
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    const simulation::Contour::Point point = contour.at(path.time[row] - path.time[0]);
    const Compliance<double> compliance =
        tcp_compliance<double, 6>(model, forward_kinematics<double, 6>(model, point.q));
    const double feedback =
        cut_feedback(compliance, point.wrench, point.normal, process.depth_of_cut);
    gain = std::min(gain, largest_safe_gain(feedback, loop));
  }
  return std::max(gain, kNone);
}

}  // namespace flexcomp::control
