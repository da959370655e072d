#include "effects/formula_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "error.hpp"
#include "files/one_line.hpp"
#include "formula/dimensions.hpp"
#include "formula/proportion.hpp"

namespace flexcomp::effects {
namespace {

/// Chosen by judgement: with more a formula fits whatever there is.
constexpr std::size_t kMostParameters = 12;

[[noreturn]] void refuse(const model::WrittenLaw& written, const std::string& why,
                         const std::string& key = "formula") {
  const auto where = written.where.find(key);
  throw InputError(fmt::format("{}: {}", where == written.where.end() ? key : where->second, why));
}

[[noreturn]] void refuse_at(const model::WrittenLaw& written, std::size_t column,
                            const std::string& why) {
  refuse(written, fmt::format("column {}: {}", column, why));
}

formula::Formula read_formula(const model::WrittenLaw& written) {
  try {
    return formula::Formula(written.formula);
  } catch (const formula::FormulaError& error) {
    refuse_at(written, error.column(), error.what());
  }
}

LawPlace read_place_of(const model::WrittenLaw& written, int joint) {
  try {
    return read_place(written.place, written.axis, joint);
  } catch (const std::invalid_argument& error) {
    refuse(written, error.what(), "place");
  }
}

bool is_among(const std::vector<std::string>& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

void refuse_wrong_names(const model::WrittenLaw& written, const formula::Formula& formula,
                        const model::Robot& robot, const std::vector<std::string>& parameters) {
  for (std::size_t i = 0; i < formula.names().size(); ++i) {
    const std::string& name = formula.names()[i];
    if (!find_signal(robot, name) && !is_among(parameters, name)) {
      refuse_at(written, formula.column_of(i),
                fmt::format("'{}' is neither a parameter with a value beside the formula nor a "
                            "signal; expected one of: {}",
                            files::one_line(name), signal_names(robot)));
    }
  }
  for (const std::string& name : parameters) {
    if (find_signal(robot, name) || name == "pi") {
      refuse(written, fmt::format("'{}' is a signal or pi; expected another name for a parameter",
                                  files::one_line(name)));
    }
    if (!is_among(formula.names(), name)) {
      refuse(written, fmt::format("'{}' is not in the formula", files::one_line(name)));
    }
  }
  for (const auto& [name, unit] : written.units) {
    if (!is_among(parameters, name)) {
      refuse(written, fmt::format("'{}' is no parameter", files::one_line(name)), "units");
    }
  }
  if (parameters.size() > kMostParameters) {
    refuse(written, fmt::format("expected at most {} parameters", kMostParameters));
  }
}

formula::Dimension read_unit(const model::WrittenLaw& written, const std::string& name,
                             const std::string& unit) {
  try {
    return formula::dimension_of(unit);
  } catch (const formula::FormulaError& error) {
    refuse(written,
           fmt::format("{}: '{}': {}", files::one_line(name), files::one_line(unit), error.what()),
           "units");
  }
}

/// Units of the formula's names: as given, else as they follow from the others; empty where open.
std::vector<std::string> units_of(const BoundFormula& bound, const model::Robot& robot) {
  const model::WrittenLaw& written = bound.written;
  std::vector<std::optional<formula::Dimension>> known;
  for (std::size_t i = 0; i < bound.signals.size(); ++i) {
    const auto given = written.units.find(bound.formula.names()[i]);
    if (bound.signals[i]) {
      known.emplace_back(formula::dimension_of(bound.signals[i]->unit));
    } else if (given != written.units.end()) {
      known.emplace_back(read_unit(written, given->first, given->second));
    } else {
      known.emplace_back();
    }
  }
  const std::string wanted = unit_at(bound.place, robot);
  std::vector<std::optional<formula::Dimension>> found;
  try {
    found = formula::check_dimensions(bound.formula, known, formula::dimension_of(wanted),
                                      written.place);
  } catch (const formula::FormulaError& error) {
    refuse_at(written, error.column(), error.what());
  }
  std::vector<std::string> units;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto given = written.units.find(bound.formula.names()[i]);
    units.push_back(given != written.units.end()
                        ? given->second
                        : (found[i] ? formula::unit_text(*found[i]) : std::string()));
  }
  return units;
}

/// Lists the parameters, those that act in proportion first, and where each name finds its own.
void list_parameters(const std::vector<std::string>& units, BoundFormula* bound) {
  std::vector<std::size_t> names;
  for (std::size_t i = 0; i < bound->signals.size(); ++i) {
    if (!bound->signals[i]) {
      names.push_back(i);
    }
  }
  const std::vector<std::size_t> first = formula::in_proportion(bound->formula, names);
  std::stable_partition(names.begin(), names.end(), [&](std::size_t name) {
    return std::find(first.begin(), first.end(), name) != first.end();
  });
  bound->in_proportion = first.size();
  bound->parameter.assign(bound->signals.size(), 0);
  for (const std::size_t name : names) {
    bound->parameter[name] = bound->parameters.size();
    bound->parameters.push_back({bound->formula.names()[name], units[name]});
  }
}

/// A formula with values of its parameters, along scenes.
class Along {
 public:
  Along(const BoundFormula& bound, const Values& parameters, Unvalued unvalued)
      : bound_(bound),
        unvalued_(unvalued),
        ahead_(bound.has_beginning ? parameters.back() : 0),
        values_(bound.signals.size(), 0) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (!bound_.signals[i]) {
        values_[i] = parameters[bound_.parameter[i]];
      }
    }
  }

  Eigen::VectorXd over(const Scene& scene, const Simulation& at, const Prediction& prediction,
                       Loads loads) const {
    const auto names = static_cast<Eigen::Index>(values_.size());
    Eigen::MatrixXd signals(scene.rows(), names);
    for (Eigen::Index i = 0; i < names; ++i) {
      const std::optional<Signal>& signal = bound_.signals[static_cast<std::size_t>(i)];
      if (signal) {
        signals.col(i) = values_of(*signal, scene, at, prediction, loads, scene.time[0]);
      } else {
        signals.col(i).setConstant(values_[static_cast<std::size_t>(i)]);
      }
    }
    return computed(scene, signals);
  }

 private:
  Eigen::VectorXd computed(const Scene& scene, const Eigen::MatrixXd& signals) const {
    formula::Course course(bound_.formula, ahead_);
    Eigen::VectorXd all(scene.rows());
    std::vector<double> row(values_.size());
    for (Eigen::Index i = 0; i < all.size(); ++i) {
      Eigen::Map<Eigen::RowVectorXd>(row.data(), signals.cols()) = signals.row(i);
      const bool is_timed = i > 0 && !scene.is_static;
      all[i] = course.next(row, is_timed ? scene.time[i] - scene.time[i - 1] : 0);
      if (!std::isfinite(all[i]) && unvalued_ == Unvalued::refuse) {
        refuse_unvalued(bound_, row, scene.file, scene.time[i]);
      }
    }
    return all;
  }

  const BoundFormula& bound_;
  Unvalued unvalued_;
  double ahead_;                ///< by how much what lags begins above its input
  std::vector<double> values_;  ///< of the names; zero where they are signals
};

/// Only what a link encoder sees of a wind-up is driven by inertia besides.
bool has_two_loads(const BoundFormula& bound, const Prediction& prediction) {
  return bound.place.kind == PlaceKind::joint_windup && bound.follows(SignalKind::torque) &&
         prediction.channel[simulation::joint_deflection].cols() > 0;
}

Term term_of(const std::shared_ptr<const BoundFormula>& bound, const Values& values,
             Unvalued unvalued) {
  return {stage_at(bound->place),
          [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            const Along along(*bound, values, unvalued);
            const bool is_of_wrench = bound->place.kind == PlaceKind::sensor_wrench;
            const Prediction& loads = is_of_wrench ? at.prediction : *prediction;
            const bool at_rest = bound->place.kind == PlaceKind::joint_windup;
            const Eigen::VectorXd plain =
                along.over(scene, at, loads, at_rest ? Loads::at_rest : Loads::with_inertia);
            add_at(bound->place, plain,
                   has_two_loads(*bound, loads) ? along.over(scene, at, loads, Loads::with_inertia)
                                                : plain,
                   at, prediction);
          }};
}

/// "joint 5 has a torque that follows the angle of joint 4, by a*sin(q4)"
std::string clause_of(const BoundFormula& bound) {
  constexpr std::size_t kFew = 3;  // that a clause bears
  std::vector<std::string> drivers;
  for (const std::optional<Signal>& signal : bound.signals) {
    if (signal) {
      drivers.push_back(signal->words);
    }
  }
  std::string text =
      in_words(bound.place) + (drivers.empty() ? " that is constant" : " that follows ");
  for (std::size_t i = 0; i < std::min(drivers.size(), kFew); ++i) {
    text +=
        fmt::format("{}{}", i == 0 ? "" : (i + 1 == drivers.size() ? " and " : ", "), drivers[i]);
  }
  return text + (drivers.size() > kFew ? " and more" : "") + ", by " + bound.formula.text();
}

}  // namespace

bool BoundFormula::follows(SignalKind kind) const {
  return std::any_of(signals.begin(), signals.end(),
                     [kind](const auto& signal) { return signal && signal->kind == kind; });
}

bool BoundFormula::needs_levers() const {
  return follows(SignalKind::torque) || follows(SignalKind::load) ||
         follows(SignalKind::tool_wrench) || follows(SignalKind::position);
}

BoundFormula bind_law(const model::WrittenLaw& written, const model::Robot& robot, int joint,
                      const std::vector<std::string>& parameters) {
  BoundFormula bound{written, read_place_of(written, joint), read_formula(written), {}, {}, {}, 0};
  refuse_wrong_names(written, bound.formula, robot, parameters);
  for (const std::string& name : bound.formula.names()) {
    bound.signals.push_back(find_signal(robot, name));
  }
  list_parameters(units_of(bound, robot), &bound);
  return bound;
}

BoundFormula with_beginning(BoundFormula bound, const std::string& unit) {
  bound.parameters.push_back({"beginning", unit, true});
  bound.has_beginning = true;
  return bound;
}

LawPointer formula_law(std::shared_ptr<const BoundFormula> bound, Unvalued unvalued) {
  Law law;
  law.effect = model::kLaw;
  law.traits.linear_in = bound->in_proportion;
  law.traits.is_curve_only = true;
  law.traits.can_be_undone = moves_the_robot(bound->place);
  law.traits.needs_temperature = bound->follows(SignalKind::temperature);
  law.parameters = [bound](const model::Robot&, int) { return bound->parameters; };
  law.statement = [bound](int) { return clause_of(*bound); };
  law.written = std::shared_ptr<const model::WrittenLaw>(bound, &bound->written);
  law.bound = bound;
  law.apply = [bound, unvalued](const Values& values, int, Machine* machine) {
    machine->terms.push_back(term_of(bound, values, unvalued));
    machine->needs_levers = machine->needs_levers || bound->needs_levers();
  };
  return std::make_shared<const Law>(std::move(law));
}

void refuse_unvalued(const BoundFormula& bound, const std::vector<double>& values,
                     const std::string& file, double time) {
  std::string names;
  for (std::size_t i = 0; i < values.size(); ++i) {
    names +=
        fmt::format("{}{} = {:g}", names.empty() ? "" : ", ", bound.formula.names()[i], values[i]);
  }
  refuse(bound.written, fmt::format("has no value for {} at t = {:g} s, where {}",
                                    files::one_line(file, 200), time, names));
}

}  // namespace flexcomp::effects
