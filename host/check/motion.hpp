#pragma once

#include "recording/recording.hpp"

/// How the joints of a recording move, before anything is known of units.
namespace flexcomp::check {

/// Does any joint move from row to row as a sampled motion does, rather than from pose to pose?
bool moves_smoothly(const recording::Samples& q);

/// Speed that each joint comes up to in a twentieth of the rows, over windows that are long enough
/// for encoders' steps not to matter.
Eigen::RowVectorXd usual_top_speed(const Eigen::VectorXd& time, const recording::Samples& q);

/// Largest less smallest value of each column; zero without any.
Eigen::RowVectorXd ranges(const recording::Samples& samples);

}  // namespace flexcomp::check
