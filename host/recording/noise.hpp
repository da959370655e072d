#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexcomp::recording {

/// Standard deviation of the noise in a signal that is otherwise smooth from row to row, by the
/// median size of its third differences, which leave √20 of white noise. NaN rows are missing; of a
/// signal that is there every few rows only, the differences are between those. With a stride
/// (rows) beyond the memory of coloured noise, that noise counts too.
double white_noise(const Eigen::VectorXd& signal, Eigen::Index stride = 1);

/// Differences of each value that has three neighbours on either side from the polynomial through
/// these six at their true times (s), over the factor by which that amplifies white noise.
Eigen::VectorXd neighbour_misses(const Eigen::VectorXd& time, const Eigen::VectorXd& angle);

/// Standard deviation of the noise of an encoder, which is nearly noiseless, by its
/// `neighbour_misses`; of a quantised one no less than the error of rounding.
double encoder_noise(const Eigen::VectorXd& time, const Eigen::VectorXd& angle);

/// Step in which a quantised signal is given; 0 where it is not, or in steps so fine that hardly a
/// value comes twice.
double quantisation_step(const Eigen::VectorXd& signal);

/// 1.4826 times the median size: the standard deviation of a normal distribution, outliers or not.
double robust_deviation(const Eigen::VectorXd& values);

/// Does a row stand alone, far from the median of the three values before and after?
bool stands_alone(const Eigen::VectorXd& signal, Eigen::Index row, double noise);

/// How many independent samples so many correlated ones are worth: n(1−ρ)/(1+ρ), ρ the correlation
/// of neighbours (first-order autoregression; Bayley and Hammersley 1946).
double effective_samples(double count, double correlation);

}  // namespace flexcomp::recording
