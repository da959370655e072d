#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/grammar/shape.hpp"

namespace flexcomp::diagnosis::grammar {

/// A second driver, and the shape by which it multiplies each term of a law; null where there is
/// none.
struct Modulation {
  const Driver* driver = nullptr;
  const Shape* shape = nullptr;
};

/// A law without its numbers.
struct Form {
  const Shape* shape = nullptr;
  bool has_constant = false;  ///< one more term: the factor by itself
  Modulation modulation;
};

/// A law made of parts, with values by least squares.
struct Composed {
  Lead lead;
  Form form;
  Values parameters;          ///< of the shape
  Eigen::VectorXd amplitude;  ///< of the terms
  /// By how much what lags begins above its input; nothing where nothing lags, or nobody knows of
  /// which recording.
  std::optional<double> beginning;
  Eigen::VectorXd reach;  ///< amplitude by which each term does as much as the one that does most
  double gain = 0;        ///< in squares
  std::vector<double> unseen;  ///< gains where it was not fitted to (normal.hpp)
  /// Of the other laws of its lead with as many numbers the one that fits best, if that fits better
  /// though it predicts worse; else null. Halves without the few rows where a law does something
  /// tell nothing of it.
  std::shared_ptr<const Composed> twin;

  std::size_t numbers() const {
    return parameters.size() + static_cast<std::size_t>(amplitude.size()) + (beginning ? 1 : 0);
  }
  /// Numbers, factor and second driver that the law's formula needs.
  std::size_t complexity() const {
    return numbers() + (lead.factor.text.empty() ? 0 : 1) +
           (form.modulation.driver == nullptr ? 0 : 1);
  }
};

/// The parameters by which a form of a lead fits best.
Values best_parameters(const Material& material, const Lead& lead, const Form& form);

/// By how many squares it fits better than nothing, with these parameters.
double gain_of(const Material& material, const Lead& lead, const Form& form,
               const Values& parameters);

/// The law of these parameters. Its gain is 0 where its formula has no value.
Composed composed_of(const Material& material, const Lead& lead, const Form& form,
                     Values parameters);

/// A law with its other terms alone.
Composed without_constant(const Material& material, const Composed& law);

}  // namespace flexcomp::diagnosis::grammar
