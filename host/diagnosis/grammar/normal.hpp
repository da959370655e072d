#pragma once

#include <vector>

#include "diagnosis/grammar/seat.hpp"

namespace flexcomp::diagnosis::grammar {

/// Part of a course's square by which it must be apart from what is fitted: a hundredth of the
/// course, less is rounding.
constexpr double kApart = 1e-4;

/// Normal equations of courses (rows × terms) at a seat.
struct Normal {
  Eigen::MatrixXd gram;    ///< terms × terms
  Eigen::VectorXd moment;  ///< terms

  /// Amplitudes of least squares; terms that others make up have none.
  Eigen::VectorXd amplitude() const;
  /// Fall of the sum of squares by amplitudes.
  double gain(const Eigen::VectorXd& amplitude) const;
};

/// Normal equations of courses beside what is fitted: `gram` and `moment` by themselves, `shown`
/// the products of an orthonormal base of the fit with the courses. Courses that the fit makes up
/// have next to no gain.
Normal beside(Eigen::MatrixXd gram, const Eigen::MatrixXd& shown, Eigen::VectorXd moment);

/// Normal equations of all samples to fit to, beside the fit that there is.
Normal normal_of(const Seat& seat, const Eigen::MatrixXd& courses);

/// Normal equations of each stretch by itself, as if nothing were fitted.
std::vector<Normal> normals_by_stretch(const Seat& seat, const Rows& rows,
                                       const Eigen::MatrixXd& courses);

/// Fall of the sum of squares by courses where they were not fitted: for each of several random
/// halves of the stretches the gain on the other half (Meinshausen and Bühlmann 2010,
/// "Stability selection", whose subsamples are single samples). The halves are the same for all
/// courses.
std::vector<double> unseen_gains(const std::vector<Normal>& by_stretch);

double mean(const std::vector<double>& values);

}  // namespace flexcomp::diagnosis::grammar
