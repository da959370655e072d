#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/dictionary.hpp"
#include "effects/learned.hpp"

namespace flexcomp::diagnosis {

/// Times the noise: single samples beyond are gross errors, which count no more than that where no
/// fit told their deviation.
constexpr double kGross = 30;

/// A hypothesis with values for its parameters.
struct Chosen {
  Hypothesis hypothesis;
  Values values;
};

/// Is the same effect at the same place among those that were chosen, in whatever form?
bool is_chosen(const std::vector<Chosen>& chosen, const Hypothesis& hypothesis);

/// Hypotheses fitted together to the samples to fit to.
struct Fit {
  std::vector<Chosen> chosen;
  Machine machine;             ///< the model with them, as it was left (`as_left`)
  Eigen::VectorXd remainder;   ///< all samples: measured less predicted, over the noise
  Eigen::MatrixXd derivative;  ///< samples × parameters, of the prediction over the noise
  /// Parameters × parameters; zero where nothing depends on one. Wider than for independent errors
  /// where they hang together over time.
  Eigen::MatrixXd covariance;
  double train_sum = 0;  ///< robust sum of squares of the remainder
  double told = 0;       ///< parameters that the samples tell, rather than what holds them

  std::size_t parameters() const;
  /// Column of `derivative` and of `covariance` where those of one that was chosen begin.
  Eigen::Index first_parameter(std::size_t index) const;
  /// Covariance of the values of one that was chosen.
  Eigen::MatrixXd covariance_of(std::size_t index) const;
  /// The chosen hypotheses as laws of the machine, as it was left, for recordings to come: without
  /// what is another in each (`is_of_each`).
  std::vector<effects::Placed> placed(const Observations& observations) const;
};

/// Weights by Huber's function of a remainder over the noise: one within three deviations of what
/// remains, less beyond, so that single samples do not decide.
Eigen::VectorXd huber_weights(const Eigen::VectorXd& remainder);
/// Huber's weights by a known deviation of the remainder.
Eigen::VectorXd huber_weights(const Eigen::VectorXd& remainder, double deviation);

/// Deviations of a remainder, beyond which a sample is an outlier: of normally distributed samples
/// one in 500 million is, and any other effect shows in many.
constexpr double kFarOff = 6;

/// A remainder over the noise, with outliers cut down to the largest value that is none.
Eigen::VectorXd clipped(const Eigen::VectorXd& remainder);

/// Those of them that always act, and all of them as if they did: the machine while what comes and
/// goes is away, and while it is there.
std::vector<Chosen> steady(const std::vector<Chosen>& chosen);
std::vector<Chosen> acting(std::vector<Chosen> chosen);

/// Has a hypothesis numbers that are others in each recording, as a tone's phase, and was another
/// one held out? Then a model of the machine cannot have it.
bool is_of_each(const Observations& observations, const Hypothesis& hypothesis);

/// Those of them that act when the recordings end: what comes and goes may not.
std::vector<Chosen> as_left(const Observations& observations, std::vector<Chosen> chosen);

/// The machine with hypotheses added to the observations' model, as it was left.
Machine machine_with(const Observations& observations, const std::vector<Chosen>& chosen);

/// Fits parameters within their bounds (least_squares.hpp) from given values on, with weights by
/// Huber's function (3 deviations) so that single samples do not decide. Predictions are simulated
/// anew for every step, not linearised.
///
/// Parameters with a tolerance are held to zero by it, as by one sample more.
///
/// Parameters without a derivative, which act in steps, are scanned in the end, by five per cent up
/// to a factor of 2.7 either way. With a dictionary they are not, and the derivatives by parameters
/// that alter the model are those that it holds, of the model as it was: quicker, and close enough
/// to find the same minimum.
Fit fit(const Observations& observations, std::vector<Chosen> start, int most_steps,
        const Dictionary* dictionary = nullptr);

/// Power of the findings' shares one by one over that of their sum. Real effects add up (about 1).
/// A sum of effects that imitates another one consists of large parts that cancel each other.
double cancellation(const Observations& observations, const Fit& fit);

/// Above this cancellation effects imitate something else.
constexpr double kMostCancellation = 10;

}  // namespace flexcomp::diagnosis
