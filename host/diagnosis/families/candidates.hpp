#pragma once

#include <string>

#include "diagnosis/fit.hpp"
#include "diagnosis/observations.hpp"
#include "diagnosis/search/hypothesis.hpp"

namespace flexcomp::diagnosis {

/// Is a hypothesis one of a family's numbers here? Positions alone show masses only by what they
/// bend, which numbers of springs and frames do nearly as well: both together fit what neither is,
/// and predict poses elsewhere worse.
bool is_candidate(const Observations& observations, const Hypothesis& hypothesis);

/// Could a hypothesis, within its bounds, change a noticeable part of `target`? What could not, as
/// masses on stiff springs, only fits what other numbers do to it. `columns`: its derivatives, a
/// parameter each, samples as in `target`. A gain matters however little its joint bears: where it
/// is left out, all others are told in its joint's unit of torque.
bool could_matter(const Hypothesis& hypothesis, const Eigen::MatrixXd& columns,
                  const Eigen::VectorXd& target);

/// Orthonormal columns that hold all that the first `findings` of a fit can do to the samples to
/// fit to, to first order.
Eigen::MatrixXd what_is_said(const Fit& fit, std::size_t findings, Eigen::Index train);

/// Do findings say already what a hypothesis would, as a payload says what a heavier last link
/// does? Beside it neither would be told. `columns`: its derivatives, a parameter each.
bool is_said(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& said);

/// Standard deviation of a number of machines as they are: what models are usually off by, or a
/// part of its plausible range where that is not known.
double usual_width(const Observations& observations, const Hypothesis& hypothesis,
                   std::size_t parameter);

/// Numbers that are alike in size: those of one unit at joints and links, or of one law elsewhere.
std::string kind_of(const Hypothesis& hypothesis, std::size_t parameter);

}  // namespace flexcomp::diagnosis
