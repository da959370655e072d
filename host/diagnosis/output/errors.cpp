#include "diagnosis/output/errors.hpp"

#include <fmt/format.h>

#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {
namespace {

Eigen::VectorXd ones(const Observations& observations) {
  return Eigen::VectorXd::Ones(observations.size());
}

bool has_holdout(const Observations& observations) {
  return observations.train < observations.size();
}

}  // namespace

std::string channel_table(const Observations& observations, const Diagnosis& diagnosis) {
  const bool held_out = has_holdout(observations);
  const bool stands_in = !diagnosis.retuned.chosen.empty();
  std::string rows;
  for (const Channel channel : observations.channels()) {
    const auto rms = [&](const Eigen::VectorXd& values) {
      return observations.rms(values, channel, held_out);
    };
    const Scale scale = scale_of(unit_of(observations, channel), rms(observations.residual));
    rows += fmt::format(
        "<tr><td>{}, {}</td><td>{}</td><td>{}</td><td>{}</td>{}</tr>\n", in_words(channel),
        scale.unit, three_digits(scale.factor * rms(ones(observations))),
        three_digits(scale.factor * rms(observations.residual)),
        three_digits(scale.factor * rms(diagnosis.choice.fit.remainder)),
        stands_in ? fmt::format("<td>{}</td>",
                                three_digits(scale.factor * rms(diagnosis.retuned.remainder)))
                  : "");
  }
  return fmt::format(
      "<table class=\"numbers\"><tr><th>error, rms{}</th><th>noise</th><th>model as it was</th>"
      "<th>with the findings</th>{}</tr>\n{}</table>\n",
      held_out ? ", held out" : "", stands_in ? "<th>with stand-ins too</th>" : "", rows);
}

std::string component_table(const Observations& observations, const Diagnosis& diagnosis,
                            Channel channel) {
  const bool held_out = has_holdout(observations);
  const Eigen::VectorXd& after = diagnosis.updated().remainder;
  const Scale scale = scale_of(unit_of(observations, channel),
                               observations.rms(observations.residual, channel, held_out));
  std::string rows;
  for (Eigen::Index component = 0; component < observations.scenes.front().measured[channel].cols();
       ++component) {
    const auto rms = [&](const Eigen::VectorXd& values) {
      return observations.rms(values, channel, held_out, component);
    };
    const double noise = rms(ones(observations));
    if (noise == 0) {  // without samples
      continue;
    }
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td></tr>\n",
        component_in_words(channel, component), three_digits(scale.factor * noise),
        three_digits(scale.factor * rms(observations.residual)),
        three_digits(scale.factor * rms(after)), rms(observations.residual) / noise,
        rms(after) / noise);
  }
  return fmt::format(
      "<table class=\"numbers\"><tr><th>{}, {}{}</th><th>noise</th><th>before</th><th>after</th>"
      "<th>before, times the noise</th><th>after, times the noise</th></tr>\n{}</table>\n",
      in_words(channel), scale.unit, held_out ? ", held out" : "", rows);
}

double rms_without(const Observations& observations, const Fit& fit, std::size_t index,
                   Channel channel) {
  const Values& values = fit.chosen[index].values;
  const Eigen::Index first = fit.first_parameter(index);
  Eigen::VectorXd left = fit.remainder;
  for (std::size_t i = 0; i < values.size(); ++i) {
    left += values[i] * fit.derivative.col(first + static_cast<Eigen::Index>(i));
  }
  return observations.rms(left, channel, has_holdout(observations));
}

}  // namespace flexcomp::diagnosis
