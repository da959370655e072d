#include "diagnosis/select/forms.hpp"

#include <algorithm>

#include "diagnosis/select/standards.hpp"

namespace flexcomp::diagnosis {
namespace {

bool is_other_form(const Hypothesis& one, const Hypothesis& other) {
  return one.effect() == other.effect() && one.joint == other.joint &&
         one.law->form != other.law->form && !one.law->written &&
         std::equal(one.parameters.begin(), one.parameters.end(), other.parameters.begin(),
                    other.parameters.end(), [](const Parameter& a, const Parameter& b) {
                      return a.name == b.name && a.unit == b.unit;
                    });
}

/// The fit of all findings, one of them in each of its other forms.
std::vector<Fit> in_other_forms(const Inquiry& inquiry, const Fit& whole, std::size_t index) {
  std::vector<Fit> all;
  for (const Hypothesis& other : inquiry.dictionary.hypotheses) {
    if (!is_other_form(whole.chosen[index].hypothesis, other)) {
      continue;
    }
    std::vector<Chosen> chosen = whole.chosen;
    Values values = chosen[index].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::clamp(values[i], other.parameters[i].lower, other.parameters[i].upper);
    }
    chosen[index] = {other, std::move(values)};
    all.push_back(fit(inquiry.observations, std::move(chosen), kSteps));
  }
  return all;
}

double held_out_sum(const Observations& observations, const Fit& fit) {
  return fit.remainder.tail(observations.size() - observations.train).squaredNorm();
}

/// Replaces a finding by the best of its forms, and leaves the others in `forms`.
void take_best(const Inquiry& inquiry, std::size_t index, std::vector<Fit>* forms, Choice* choice) {
  constexpr double kBetter = 1 - 1e-6;  // by more than rounding: two forms may do the same
  const auto best = std::min_element(forms->begin(), forms->end(), [](const Fit& a, const Fit& b) {
    return a.train_sum < b.train_sum;
  });
  const Observations& observations = inquiry.observations;
  if (best == forms->end() || !(best->train_sum < kBetter * choice->fit.train_sum) ||
      !(held_out_sum(observations, *best) < held_out_sum(observations, choice->fit))) {
    return;
  }
  std::swap(choice->fit, *best);
  for (std::size_t i = 0; i < choice->findings.size(); ++i) {
    choice->findings[i].chosen = choice->fit.chosen[i];
    choice->findings[i].covariance = choice->fit.covariance_of(i);
  }
  choice->findings[index].evidence = judge(inquiry, choice->fit, index).evidence;
}

/// Squared distances, from the form that is taken, of the forms that fit nearly as well or predict
/// better.
Eigen::VectorXd doubt(const Observations& observations, const Fit& whole, std::size_t index,
                      const std::vector<Fit>& forms) {
  const auto values = [index](const Fit& fit) {
    const Values& all = fit.chosen[index].values;
    return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
  };
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(values(whole).size());
  for (const Fit& form : forms) {
    if (form.train_sum < kNearlyAsGood * whole.train_sum ||
        held_out_sum(observations, form) < held_out_sum(observations, whole)) {
      squares = squares.cwiseMax((values(form) - values(whole)).cwiseAbs2());
    }
  }
  return squares;
}

}  // namespace

void settle_forms(const Inquiry& inquiry, Choice* choice) {
  for (std::size_t index = 0; index < choice->findings.size(); ++index) {
    std::vector<Fit> forms = in_other_forms(inquiry, choice->fit, index);
    take_best(inquiry, index, &forms, choice);
    choice->findings[index].covariance.diagonal() +=
        doubt(inquiry.observations, choice->fit, index, forms);
  }
}

}  // namespace flexcomp::diagnosis
