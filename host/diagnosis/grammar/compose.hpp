#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/grammar/shape.hpp"

namespace flexcomp::diagnosis::grammar {

constexpr std::size_t kMostTerms = 6;  ///< of a law with a second driver: more is no physics

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

  std::size_t numbers() const {
    return parameters.size() + static_cast<std::size_t>(amplitude.size()) + (beginning ? 1 : 0);
  }
  /// Numbers, factor and second driver that the law's formula needs.
  std::size_t complexity() const {
    return numbers() + (lead.factor.text.empty() ? 0 : 1) +
           (form.modulation.driver == nullptr ? 0 : 1);
  }
};

/// Fits every shape to each lead, except shapes that have the name of one of these effects of the
/// catalogue, and second drivers to the best shape of the first leads. Returns the laws that are
/// worth a fit by simulation: of each lead its best at most, and the one that predicts best. First
/// come those that are proved, the best first: a richer law stands before a simpler one only if it
/// predicts better in most of the halves. Then come those of the others that predict best. Before
/// each that has a second driver stands the same without, and before each that bends next to
/// nothing the line.
std::vector<Composed> compose(const Material& material, const std::vector<Lead>& leads,
                              const std::set<std::string>& effects, std::size_t* looked_at);

/// A law with its other terms alone.
Composed without_constant(const Material& material, const Composed& law);

}  // namespace flexcomp::diagnosis::grammar
