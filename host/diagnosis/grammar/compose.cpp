#include "diagnosis/grammar/compose.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "diagnosis/grammar/known.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

constexpr double kMostHalves = 0.8;          // in which a richer law must predict better: of halves
                                             // that say nothing one in two does
constexpr std::size_t kModulated = 3;        // leads of which a second driver is sought
constexpr std::size_t kMostModulations = 3;  // of each that are weighed
constexpr std::size_t kProved = 4;           // laws worth a fit, of those that are proved on halves
constexpr std::size_t kForeseeing = 4;       // and of the others that predict best
constexpr double kWorthwhile = 6;  // squares over the noise that it must gain for each number more

/// Does a law that says more predict better, and in most of the halves?
bool is_worth(const Composed& richer, const Composed& simpler) {
  int better = 0;
  for (std::size_t i = 0; i < richer.unseen.size(); ++i) {
    better += richer.unseen[i] > simpler.unseen[i] ? 1 : 0;
  }
  const double more = mean(richer.unseen) - mean(simpler.unseen);
  const auto numbers = static_cast<double>(richer.complexity() - simpler.complexity());
  return better >= kMostHalves * static_cast<double>(richer.unseen.size()) &&
         more > kWorthwhile * numbers;
}

/// Moves the best to the front: of laws that say as much the one that predicts best, of others the
/// simplest that no richer one is worth more than.
void best_first(std::vector<Composed>* laws) {
  std::stable_sort(laws->begin(), laws->end(), [](const Composed& a, const Composed& b) {
    return a.complexity() != b.complexity() ? a.complexity() < b.complexity()
                                            : mean(a.unseen) > mean(b.unseen);
  });
  std::size_t best = 0;
  if (laws->empty()) {
    return;
  }
  for (std::size_t i = 1; i < laws->size(); ++i) {
    if (is_worth((*laws)[i], (*laws)[best])) {
      best = i;
    }
  }
  std::rotate(laws->begin(), laws->begin() + static_cast<std::ptrdiff_t>(best),
              laws->begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

/// Would a shape say nothing that a plainer law does not? A factor by its own driver is a square.
bool is_redundant(const Lead& lead, const Shape& shape) {
  return lead.is_of_itself() && shape.parameters.empty();
}

/// Is a factor by itself an effect of the catalogue? Then it is no law's to say.
bool is_known(const Material& material, const Lead& lead, const std::set<std::string>& effects) {
  return effects.count(factor_as(material, lead)) > 0;
}

/// A lead with each of its shapes, those with a name in the catalogue among them.
std::vector<Composed> laws_of(const Material& material, const Lead& lead,
                              const std::set<std::string>& effects) {
  const bool may_have_constant = !is_known(material, lead, effects);
  std::vector<Composed> laws;
  for (const Shape& shape : shapes()) {
    if (!shape.fits(*lead.seat, *lead.driver) || is_redundant(lead, shape)) {
      continue;
    }
    const Values parameters = best_parameters(material, lead, {&shape, may_have_constant, {}});
    for (const bool has_constant : {false, true}) {
      if (has_constant && !may_have_constant) {
        continue;
      }
      Composed law = composed_of(material, lead, {&shape, has_constant, {}}, parameters);
      if (law.gain > 0) {
        laws.push_back(std::move(law));
      }
    }
  }
  return laws;
}

/// The law with each of the second drivers that gain most, and a good share of what the law leaves
/// beyond the noise. What is no function of what was recorded has none.
std::vector<Composed> modulated(const Material& material, const Composed& law) {
  if (law.lead.driver->kind == effects::SignalKind::time) {
    return {};
  }
  constexpr double kLeastOfRest = 0.1;
  const double rest = law.lead.seat->beyond_noise() - law.gain;
  std::vector<std::pair<double, Modulation>> by_gain;
  for (const Driver& driver : material.drivers) {
    for (const Shape& shape : modulations()) {
      const Modulation by{&driver, &shape};
      const bool is_able = !driver.is_product && driver.kind != effects::SignalKind::time &&
                           driver.name != law.lead.driver->name && shape.suits(driver) &&
                           law.form.shape->terms.size() * shape.terms.size() <= kMostTerms;
      if (is_able) {
        const double gain =
            gain_of(material, law.lead, {law.form.shape, false, by}, law.parameters);
        const auto numbers = static_cast<double>(law.form.shape->terms.size()) *
                             static_cast<double>(shape.terms.size() - 1);
        if (gain > law.gain + std::max(kWorthwhile * numbers, kLeastOfRest * rest)) {
          by_gain.emplace_back(gain, by);
        }
      }
    }
  }
  std::stable_sort(by_gain.begin(), by_gain.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  by_gain.resize(std::min(by_gain.size(), kMostModulations));
  std::vector<Composed> laws;
  for (const auto& [gain, by] : by_gain) {
    laws.push_back(composed_of(material, law.lead, {law.form.shape, false, by}, law.parameters));
  }
  return laws;
}

/// The twin of a law among others of its lead; null where it has none.
std::shared_ptr<const Composed> twin_of(const Composed& law, const std::vector<Composed>& others) {
  const Composed* twin = nullptr;
  for (const Composed& each : others) {
    if (each.complexity() == law.complexity() && each.gain > law.gain + kWorthwhile &&
        (twin == nullptr || each.gain > twin->gain)) {
      twin = &each;
    }
  }
  return twin == nullptr ? nullptr : std::make_shared<const Composed>(*twin);
}

/// Laws that are worth a fit: the best that is proved, and the one that predicts best, where that
/// is another. The second may follow what only a few stretches show. Each has its twin.
std::vector<Composed> worth_fitting(std::vector<Composed> laws) {
  best_first(&laws);
  const auto foreseeing = std::max_element(
      laws.begin(), laws.end(),
      [](const Composed& a, const Composed& b) { return mean(a.unseen) < mean(b.unseen); });
  for (const auto law : {laws.begin(), foreseeing}) {
    if (law != laws.end()) {
      law->twin = twin_of(*law, laws);
    }
  }
  std::vector<Composed> chosen;
  if (foreseeing != laws.begin() && foreseeing != laws.end()) {
    chosen.push_back(std::move(*foreseeing));
  }
  if (!laws.empty()) {
    chosen.insert(chosen.begin(), std::move(laws.front()));
  }
  return chosen;
}

bool has_name(const Composed& law, const std::set<std::string>& effects) {
  return effects.count(known_as(law.lead, *law.form.shape)) > 0;
}

/// A wave whose size follows a second driver, with each of those that gain most.
std::vector<Composed> swelling(const Material& material, const Lead& lead) {
  const Shape& wave = shape_named("wave of any order");
  return modulated(material, composed_of(material, lead, {&wave, false, {}}, {lead.wave}));
}

/// Laws of a lead that have no name in the catalogue and are worth a fit, of `count` without one.
std::vector<Composed> nameless_of(const Material& material, const Lead& lead, bool modulates,
                                  const std::set<std::string>& effects, std::size_t* count) {
  if (lead.swells) {  // what no effect is
    std::vector<Composed> waves = swelling(material, lead);
    *count = waves.size();
    return worth_fitting(std::move(waves));
  }
  std::vector<Composed> laws = laws_of(material, lead, effects);
  std::vector<Composed> more;
  if (modulates) {
    for (const Composed& plain : worth_fitting(laws)) {
      std::vector<Composed> by_second = modulated(material, plain);
      std::move(by_second.begin(), by_second.end(), std::back_inserter(more));
    }
  }
  laws.erase(std::remove_if(laws.begin(), laws.end(),
                            [&](const Composed& each) { return has_name(each, effects); }),
             laws.end());
  std::move(more.begin(), more.end(), std::back_inserter(laws));
  *count = laws.size();
  return worth_fitting(std::move(laws));
}

/// Is a factor by itself fitted already, as the zero of a torque is? A constant beside it serves
/// while laws are compared, where nothing is fitted anew, and says nothing then.
bool is_fitted(const Lead& lead) {
  const Seat& seat = *lead.seat;
  const Eigen::VectorXd course = lead.factor.course.size() > 0
                                     ? lead.factor.course
                                     : Eigen::VectorXd::Ones(seat.weight.size());
  return (seat.fitted.transpose() * course).squaredNorm() >
         (1 - kApart) * seat.weight.dot(course.cwiseAbs2());
}

/// A law without a constant that is fitted already.
Composed without_fitted_constant(const Material& material, Composed law) {
  return law.form.has_constant && is_fitted(law.lead) ? without_constant(material, law)
                                                      : std::move(law);
}

/// The line in the place of a law that bends by less than a hundredth of what it does, else
/// nothing.
std::optional<Composed> straight(const Material& material, const Composed& law) {
  constexpr double kLeastBend = 0.01;
  const Shape& line = shape_named("line");
  if (law.form.shape == &line || law.form.modulation.driver != nullptr ||
      !line.fits(*law.lead.seat, *law.lead.driver) || is_redundant(law.lead, line)) {
    return std::nullopt;
  }
  Composed plain = composed_of(material, law.lead, {&line, law.form.has_constant, {}}, {});
  return plain.gain > (1 - kLeastBend) * law.gain ? std::optional(std::move(plain)) : std::nullopt;
}

/// After each law its twin.
std::vector<Composed> with_twins(std::vector<Composed> laws) {
  std::vector<Composed> all;
  for (Composed& law : laws) {
    const std::shared_ptr<const Composed> twin = std::move(law.twin);
    all.push_back(std::move(law));
    if (twin != nullptr) {
      all.push_back(*twin);
    }
  }
  return all;
}

/// Before each law with a second driver the law without, to whose better values the whole fit may
/// give what it gains. Before each that hardly bends the line: noise cut off looks like a limit.
std::vector<Composed> after_plain(const Material& material, std::vector<Composed> laws,
                                  const std::set<std::string>& effects) {
  std::vector<Composed> all;
  for (Composed& law : laws) {
    if (law.form.modulation.driver != nullptr && !has_name(law, effects)) {
      all.push_back(without_constant(material, law));
    }
    if (std::optional<Composed> line = straight(material, law); line && !has_name(*line, effects)) {
      all.push_back(without_fitted_constant(material, std::move(*line)));
    }
    all.push_back(without_fitted_constant(material, std::move(law)));
  }
  return all;
}

}  // namespace

std::vector<Composed> compose(const Material& material, const std::vector<Lead>& leads,
                              const std::set<std::string>& effects, std::size_t* looked_at) {
  std::vector<std::vector<Composed>> by_lead(leads.size());
  std::vector<std::size_t> counts(leads.size());
  in_parallel(
      leads.size(), [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        by_lead[i] = nameless_of(material, leads[i], i < kModulated, effects, &counts[i]);
      });
  std::vector<Composed> all;
  *looked_at += std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  for (std::vector<Composed>& each : by_lead) {
    std::move(each.begin(), each.end(), std::back_inserter(all));
  }
  std::vector<Composed> chosen;
  for (std::size_t i = 0; i < kProved && !all.empty(); ++i) {
    best_first(&all);
    chosen.push_back(std::move(all.front()));
    all.erase(all.begin());
  }
  std::stable_sort(all.begin(), all.end(), [](const Composed& a, const Composed& b) {
    return mean(a.unseen) > mean(b.unseen);
  });
  all.resize(std::min(all.size(), kForeseeing));
  std::move(all.begin(), all.end(), std::back_inserter(chosen));
  return after_plain(material, with_twins(std::move(chosen)), effects);
}

}  // namespace flexcomp::diagnosis::grammar
