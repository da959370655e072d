#pragma once

#include "effects/law.hpp"
#include "effects/law_place.hpp"
#include "effects/signals.hpp"
#include "formula/course.hpp"
#include "model/written_law.hpp"

/// Laws that a person writes as a formula: signals and parameters in, what acts at a place out.
namespace flexcomp::effects {

/// A formula bound to a robot: what its names stand for, and where its value acts.
struct BoundFormula {
  model::WrittenLaw written;
  LawPlace place;
  formula::Formula formula;
  /// For each name of the formula the signal that it is; nothing where it is a parameter.
  std::vector<std::optional<Signal>> signals;
  /// For each name its parameter's place among the law's; zero where it is a signal.
  std::vector<std::size_t> parameter;
  /// The parameters, those that act in proportion first.
  std::vector<Parameter> parameters;
  std::size_t in_proportion = 0;
  /// Is the last parameter by how much what lags began above its input? Else it had caught up.
  bool has_beginning = false;

  /// Does it name a signal of this kind?
  bool follows(SignalKind kind) const;
  /// Does it need to know where the TCP is, or the loads at rest?
  bool needs_levers() const;
};

/// Checks a written law and binds it to a robot. `parameters`: the names that are no signals, as
/// the file lists them. Throws InputError with file, line, key and column for a place or name that
/// is unknown, a formula that cannot be read, and units that disagree.
BoundFormula bind_law(const model::WrittenLaw& written, const model::Robot& robot, int joint,
                      const std::vector<std::string>& parameters);

/// The same with one parameter more: how far ahead of its input (in this unit) what lags begins.
BoundFormula with_beginning(BoundFormula bound, const std::string& unit);

/// How a formula is taken that has no value somewhere (a division by zero): a machine that is
/// believed to have it cannot be simulated, and one that is only tried is not like the recording.
enum class Unvalued { refuse, not_a_number };

/// The law of a bound formula: effect `law`. With `refuse` its terms throw InputError, in one line
/// with the time and the values of the signals, where the formula has no finite value.
LawPointer formula_law(std::shared_ptr<const BoundFormula> bound, Unvalued unvalued);

/// Says that a formula has no value where its names have these; throws InputError.
[[noreturn]] void refuse_unvalued(const BoundFormula& bound, const std::vector<double>& values,
                                  const std::string& file, double time);

}  // namespace flexcomp::effects
