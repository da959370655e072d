#include "diagnosis/families/settle.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/bodies.hpp"
#include "diagnosis/families/elimination.hpp"
#include "diagnosis/families/possible_bodies.hpp"
#include "diagnosis/families/regression.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr int kHoldingRounds = 4;   // of holding closer, before a body is left out after all
constexpr int kPossibleRounds = 8;  // without what cannot be, others may become impossible

/// Fits where nothing but tolerances and bounds holds the numbers. The edges of what bodies can be
/// are steep, and would end the search where products of numbers are still far off.
Fit fit_without_edges(const Observations& observations, const std::vector<Chosen>& chosen,
                      const Dictionary& dictionary) {
  std::vector<Chosen> free = chosen;
  for (Chosen& each : free) {
    each.hypothesis.edge = std::numeric_limits<double>::infinity();
  }
  Fit whole = fit(observations, std::move(free), kSimulatedSteps, &dictionary);
  for (std::size_t i = 0; i < whole.chosen.size(); ++i) {
    whole.chosen[i].hypothesis.edge = chosen[i].hypothesis.edge;
  }
  return whole;
}

/// Holds the numbers as what they leave asks for. Their tolerances were scaled to what a linear
/// choice left, which is more where gains multiply and motors are coupled. Does nothing, and gives
/// false, where hardly less is left now: a tolerance matters by its size alone, and a fit takes
/// time.
bool hold_as_fitted(const Observations& observations, const Start& start, std::size_t findings,
                    Fit* whole) {
  constexpr double kMuchLess = 0.8;
  const double less = deviation_of(observations, whole->remainder) / start.deviation;
  if (less > kMuchLess) {
    return false;
  }
  for (std::size_t i = findings; i < whole->chosen.size(); ++i) {
    for (Parameter& parameter : whole->chosen[i].hypothesis.parameters) {
      parameter.tolerance /= less;
    }
  }
  return true;
}

/// What a fit makes small: robust squares of the remainder, and of each number over its tolerance.
double cost_of(const Fit& fit) {
  double cost = fit.train_sum;
  for (const Chosen& each : fit.chosen) {
    for (std::size_t i = 0; i < each.values.size(); ++i) {
      cost += std::pow(each.values[i] / each.hypothesis.parameters[i].tolerance, 2);
    }
  }
  return cost;
}

/// Choices part of the way from one fit's to others.
std::vector<Chosen> part_of_way(const Fit& from, std::vector<Chosen> to, double part) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    for (std::size_t k = 0; k < to[i].values.size(); ++k) {
      const double begin = from.chosen[i].values[k];
      to[i].values[k] = begin + part * (to[i].values[k] - begin);
    }
  }
  return to;
}

/// The optimum by a fit's tangent within what bodies can be; less of the way where the tangent
/// errs. A start that `is_inside` is left for nothing that costs more.
Fit step_within_edges(const Observations& observations, const Fit& from, bool is_inside,
                      const Dictionary& dictionary) {
  constexpr double kLeastPart = 0.1;
  const std::vector<Chosen> aim = with_possible_bodies(observations, from);
  double part = 1;
  Fit next = fit(observations, aim, 0, &dictionary);
  while (is_inside && cost_of(next) > cost_of(from) && part > kLeastPart) {
    part /= 2;
    next = fit(observations, part_of_way(from, aim, part), 0, &dictionary);
  }
  return next;
}

void set_edges(const std::vector<Chosen>& as, Fit* fit) {
  for (std::size_t i = 0; i < as.size(); ++i) {
    fit->chosen[i].hypothesis.edge = as[i].hypothesis.edge;
  }
}

/// Fits within what bodies can be, a tangent at a time: each step's own search for an optimum
/// within the edges simulates nothing (sequential quadratic programming, Nocedal and Wright 2006,
/// ch. 18).
Fit fit_within_edges(const Observations& observations, Fit best, const Dictionary& dictionary) {
  constexpr double kSettled = 1e-3;  // of the cost
  const std::vector<Chosen> edges = best.chosen;
  for (int step = 0; step < kSimulatedSteps; ++step) {
    const bool was_inside = bodies_can_be(observations, best);
    set_edges(edges, &best);
    Fit next = step_within_edges(observations, best, was_inside, dictionary);
    const double gain = 1 - cost_of(next) / cost_of(best);
    if (was_inside && gain <= 0) {
      break;
    }
    best = std::move(next);
    if (was_inside && gain < kSettled) {
      break;
    }
  }
  return best;
}

Fit fit_possible(const Observations& observations, const std::vector<Chosen>& chosen,
                 const Dictionary& dictionary) {
  return Bodies(observations, chosen).size() > 0
             ? fit_within_edges(observations, fit(observations, chosen, 0, &dictionary), dictionary)
             : fit(observations, chosen, kSimulatedSteps, &dictionary);
}

}  // namespace

Fit settle(const Observations& observations, const Start& start, std::size_t findings,
           const Dictionary& dictionary) {
  Fit whole = fit_without_edges(observations, start.chosen, dictionary);
  if (hold_as_fitted(observations, start, findings, &whole)) {
    whole = fit_without_edges(observations, whole.chosen, dictionary);
  }
  if (!bodies_can_be(observations, whole)) {
    whole = fit_within_edges(observations, std::move(whole), dictionary);
  }
  for (int round = 0; round < kPossibleRounds; ++round) {
    const auto possible = without_impossible(observations, whole, findings, round < kHoldingRounds);
    if (!possible) {
      break;
    }
    whole = fit_possible(observations, *possible, dictionary);
  }
  return whole;
}

}  // namespace flexcomp::diagnosis
