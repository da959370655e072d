#pragma once

#include <optional>

#include "recording/recording.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::simulation {

/// The side of a contour on which the material is.
enum class MaterialSide { outside, inside };

/// How the cutting force answers the depth of the cut.
struct Process {
  double depth_of_cut = 0.002;  ///< m, nominal, along the surface normal
  MaterialSide side = MaterialSide::outside;
};

/// Unit normals into the material, one a row, along a path of the TCP (one row each, m). Nothing
/// where the path encloses no area, so that it has no sides: less than 10⁻⁶ of its length squared.
std::optional<recording::Samples> surface_normals(const recording::Samples& position,
                                                  MaterialSide side);

/// A contour to be milled, as a function of time: what is commanded, what cutting at the nominal
/// depth gives, and where the material is. Between the rows of the recording everything runs
/// straight.
class Contour {
 public:
  /// The recording needs q_cmd and the wrench. Throws InputError if they are missing, there are
  /// fewer than three rows, or the path encloses no area so that it has no sides.
  Contour(const RobotModel<double, 6>& model, const recording::Recording& path, MaterialSide side);

  struct Point {
    JointVector<double, 6> q;  ///< rad, commanded
    Wrench<double> wrench;     ///< at the nominal depth
    Vector3<double> position;  ///< m, of the unbent TCP
    Vector3<double> normal;    ///< unit, into the material
  };

  double duration() const { return time_[time_.size() - 1] - time_[0]; }

  /// The point at a time (s) since the beginning, held at the ends.
  Point at(double time) const;

 private:
  RobotModel<double, 6> model_;
  Eigen::VectorXd time_;
  recording::Samples q_;
  recording::Samples wrench_;
  recording::Samples normal_;
};

/// A flexible robot in the cut: a tool that stands deeper sees more force, and more force bends the
/// robot more.
class RobotInCut {
 public:
  RobotInCut() = default;
  virtual ~RobotInCut() = default;
  RobotInCut(const RobotInCut&) = delete;
  RobotInCut& operator=(const RobotInCut&) = delete;

  struct State {
    Vector3<double> position;  ///< m, of the TCP
    Wrench<double> wrench;     ///< on the tool
    double engagement;         ///< depth of the cut over the nominal one, 0 to kMostEngagement
  };

  /// Where it is one period later, its motors commanded to `q_motor` (rad) at a point of the
  /// contour, the nominal wrench scaled by `load` (0: in the air).
  virtual State stand(const JointVector<double, 6>& q_motor, const Contour::Point& point,
                      double load) = 0;

  /// Where a tool that digs in is stopped, as a spindle would stall.
  static constexpr double kMostEngagement = 10;
};

/// The robot in the cut, at rest at every moment.
class MillingRobot : public RobotInCut {
 public:
  MillingRobot(model::Chain chain, const Process& process)
      : chain_(std::move(chain)), process_(process) {}

  State stand(const JointVector<double, 6>& q_motor, const Contour::Point& point,
              double load) override;

 private:
  model::Chain chain_;
  Process process_;
  double engagement_ = 1;
};

}  // namespace flexcomp::simulation
