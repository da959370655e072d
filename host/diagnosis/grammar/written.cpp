#include "diagnosis/grammar/written.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "diagnosis/grammar/causes.hpp"
#include "diagnosis/grammar/compose.hpp"
#include "effects/formula_law.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

/// Appends a factor to a product, unless it is 1.
void multiply(const std::string& factor, std::string* product) {
  if (!factor.empty() && factor != "1") {
    *product += "*" + factor;
  }
}

/// The terms of a law without their amplitudes, each empty or beginning with a sign of
/// multiplication.
std::vector<std::string> products_of(const Composed& law) {
  std::vector<std::string> terms = terms_of(*law.form.shape, *law.lead.driver);
  if (law.form.has_constant) {
    terms.emplace_back();
  }
  const Modulation& by = law.form.modulation;
  const std::vector<std::string> times =
      by.driver == nullptr ? std::vector<std::string>{""} : terms_of(*by.shape, *by.driver);
  std::vector<std::string> products;
  for (const std::string& term : terms) {
    for (const std::string& other : times) {
      products.emplace_back();
      multiply(term, &products.back());
      multiply(law.lead.factor.text, &products.back());
      multiply(other, &products.back());
    }
  }
  return products;
}

/// The formula's text, and its parameters: the amplitudes, then those of the shape.
std::string formula_of(const Composed& law, std::vector<std::string>* names) {
  constexpr std::array<const char*, kMostTerms> kAmplitudes = {"a", "b", "c", "e", "f", "g"};
  std::string text;
  for (const std::string& product : products_of(law)) {
    names->emplace_back(kAmplitudes.at(names->size()));
    text += (text.empty() ? "" : " + ") + names->back() + product;
  }
  for (const ShapeParameter& each : law.form.shape->parameters) {
    names->emplace_back(each.name);
  }
  return text;
}

/// An amplitude is sought through zero, and far beyond its reach: other numbers of the law may turn
/// one term into another.
Bounds bounds_of_amplitude(double reach) {
  constexpr double kFar = 50;     // times the reach: no bound that a fit would rest on
  constexpr double kStep = 0.05;  // of the reach
  const double size = std::max(reach, 1e-12);
  return {-kFar * size, kFar * size, kStep * size};
}

/// By how much what lags may begin above its input.
Bounds bounds_of_beginning(double span) {
  constexpr double kMost = 2;     // times as far as the input ranges
  constexpr double kStep = 0.05;  // of that
  return {-kMost * span, kMost * span, kStep * span};
}

/// A formula with the name of each of its parameters, bound to the robot.
effects::BoundFormula bound_of(const Composed& composed, const model::Robot& robot,
                               std::vector<std::string>* names) {
  model::WrittenLaw written;
  written.place = composed.lead.seat->name;
  written.axis = composed.lead.seat->axis;
  written.formula = formula_of(composed, names);
  effects::BoundFormula bound =
      effects::bind_law(written, robot, composed.lead.seat->place.joint, *names);
  if (!composed.beginning) {
    return bound;
  }
  const bool is_square = composed.form.shape->trait == ShapeTrait::heating;
  bound = effects::with_beginning(std::move(bound), is_square ? "" : composed.lead.driver->unit);
  names->push_back(bound.parameters.back().name);
  return bound;
}

/// A law that says besides what usually causes it.
effects::LawPointer with_cause(const effects::LawPointer& law, const std::string& cause) {
  if (cause.empty()) {
    return law;
  }
  effects::Law told = *law;
  told.statement = [law, cause](int joint) { return law->statement(joint) + ", " + cause; };
  return std::make_shared<const effects::Law>(std::move(told));
}

}  // namespace

Chosen chosen_of(const Observations& observations, const Composed& composed) {
  std::vector<std::string> names;
  const model::Robot& robot = observations.machine.robot;
  const int joint = composed.lead.seat->place.joint;
  const auto bound =
      std::make_shared<const effects::BoundFormula>(bound_of(composed, robot, &names));
  Hypothesis hypothesis(with_cause(effects::formula_law(bound, effects::Unvalued::not_a_number),
                                   usual_cause(composed.lead, *composed.form.shape)),
                        joint, robot);
  std::vector<Bounds> bounds;
  for (const double reach : composed.reach) {
    bounds.push_back(bounds_of_amplitude(reach));
  }
  for (const Bounds& each : bounds_of(*composed.form.shape, *composed.lead.driver, observations)) {
    bounds.push_back(each);
  }
  Values values(composed.amplitude.data(), composed.amplitude.data() + composed.amplitude.size());
  values.insert(values.end(), composed.parameters.begin(), composed.parameters.end());
  if (composed.beginning) {
    bounds.push_back(
        bounds_of_beginning(span_of_input(*composed.form.shape, *composed.lead.driver)));
    values.push_back(*composed.beginning);
  }
  std::vector<Bounds> ordered;
  Values begun;
  for (const Parameter& each : hypothesis.parameters) {
    const auto at = std::find(names.begin(), names.end(), each.name) - names.begin();
    ordered.push_back(bounds[static_cast<std::size_t>(at)]);
    begun.push_back(values[static_cast<std::size_t>(at)]);
  }
  hypothesis.set_bounds(ordered);
  for (std::size_t i = 0; i < hypothesis.linear; ++i) {
    hypothesis.parameters[i].is_of_each = composed.form.shape->trait == ShapeTrait::tone;
  }
  hypothesis.starts = {
      Values(begun.begin() + static_cast<std::ptrdiff_t>(hypothesis.linear), begun.end())};
  return {std::move(hypothesis), std::move(begun)};
}

}  // namespace flexcomp::diagnosis::grammar
