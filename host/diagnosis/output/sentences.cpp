#include "diagnosis/output/sentences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "diagnosis/output/torque_band.hpp"
#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"
#include "diagnosis/verdict.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kTellingShare = 0.2;  // of what is left, that goes with a cue: less of it misleads

/// Deviations from zero.
double sureness(const Estimate& each) {
  return each.deviation > 0 ? std::abs(each.value) / each.deviation : 0;
}

/// The numbers that a sentence bears, in their order: the surest of those that are told from zero,
/// and of a change and the whole that follows from it the surer.
std::vector<Estimate> told_of(const std::vector<Estimate>& all) {
  constexpr std::size_t kFew = 6;  // a frame has as many
  std::vector<std::size_t> surest(all.size());
  std::iota(surest.begin(), surest.end(), 0);
  std::stable_sort(surest.begin(), surest.end(), [&](std::size_t a, std::size_t b) {
    return sureness(all[a]) > sureness(all[b]);
  });
  std::set<std::size_t> told;
  std::set<std::size_t> parameters;
  for (const std::size_t i : surest) {
    if (sureness(all[i]) >= kTold && told.size() < kFew &&
        parameters.insert(all[i].parameter).second) {
      told.insert(i);
    }
  }
  std::vector<Estimate> numbers;
  for (const std::size_t i : told) {
    numbers.push_back(all[i]);
  }
  return numbers;
}

/// " (x 0.4 m, y 2 N)"; empty without any. Parameters that only fit together, as a balancer's, say
/// nothing one by one.
std::string in_brackets(const std::vector<Estimate>& numbers) {
  std::vector<std::string> words;
  for (const Estimate& each : numbers) {
    words.push_back(fmt::format("{} {}", each.name, readable(each.value, each.unit)));
  }
  return words.empty() ? "" : fmt::format(" ({})", fmt::join(words, ", "));
}

/// "held-out error of … falls from … to …, noise …", in the channel where it falls most.
std::string fall(const Observations& observations, const Fit& before, const Fit& after) {
  const Channel channel = main_channel(observations, before, after);
  const auto written = [&](const Eigen::VectorXd& values, bool held_out) {
    return readable(observations.rms(values, channel, held_out), unit_of(observations, channel));
  };
  return fmt::format("held-out error of {} falls from {} to {}, noise {}", in_words(channel),
                     written(before.remainder, true), written(after.remainder, true),
                     written(Eigen::VectorXd::Ones(observations.size()), true));
}

/// The first three, and how many more there are.
std::string first_few(const std::vector<std::string>& all) {
  constexpr std::size_t kFew = 3;  // that a sentence bears
  const std::size_t told = std::min(kFew, all.size());
  const std::vector<std::string> few(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(told));
  const std::size_t more = all.size() - told;
  return fmt::format("{}{}", fmt::join(few, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : std::string());
}

/// The model as it was given.
Fit as_given(const Observations& observations) {
  Fit nothing;
  nothing.remainder = observations.residual;
  return nothing;
}

std::string file_name(const Observations& observations, std::size_t scene) {
  return std::filesystem::path(observations.scenes[scene].file).filename().string();
}

/// "from 3.34 to 6.66 s, from 29.90 s on"
std::string in_time(const Observations& observations, std::size_t scene,
                    const std::vector<Spell>& spells) {
  const Eigen::VectorXd& time = observations.scenes[scene].time;
  std::vector<std::string> times;
  for (const Spell& spell : spells) {
    if (spell.scene != scene) {
      continue;
    }
    const bool begins = spell.rows.first > 0;
    const bool ends = spell.rows.end < time.size();
    const double end = time[spell.rows.end - 1];
    times.push_back(begins && ends
                        ? fmt::format("from {:.2f} to {:.2f} s", time[spell.rows.first], end)
                    : begins ? fmt::format("from {:.2f} s on", time[spell.rows.first])
                    : ends   ? fmt::format("until {:.2f} s", end)
                             : "all along");
  }
  return times.empty() ? "never" : first_few(times);
}

constexpr const char* kOfEach =
    " updated_model.yaml does not have it, since its phase is another in each recording.";

/// One sentence about when a finding acts that comes and goes, and one about the model.
std::string statement_of_spells(const Observations& observations, const Spells& spells) {
  const std::vector<Spell> all = spells.all();
  std::vector<std::string> recordings;
  for (std::size_t scene = 0; scene < observations.scenes.size(); ++scene) {
    recordings.push_back(
        fmt::format("in {} {}", file_name(observations, scene), in_time(observations, scene, all)));
  }
  return fmt::format(
      " It does not always act: {}. updated_model.yaml has it {}.", first_few(recordings),
      spells.lasts(observations) ? "as the last of them left it" : "not, since it had ceased");
}

}  // namespace

std::string statement(const Observations& observations, const Diagnosis& diagnosis,
                      std::size_t finding) {
  const Finding& found = diagnosis.choice.findings[finding];
  std::string clause = found.chosen.hypothesis.statement();
  clause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(clause.front())));
  const std::string number =
      in_brackets(told_of(estimates(observations, found.chosen, found.covariance)));
  const auto& when = found.chosen.hypothesis.when;
  const bool is_passing = is_of_each(observations, found.chosen.hypothesis);
  return fmt::format("{}{}, which the model lacks: {}.{}{}", clause, number,
                     fall(observations, found.without, diagnosis.weighed()),
                     when ? statement_of_spells(observations, *when) : "",
                     is_passing ? kOfEach : "");
}

std::string statement_of_trial(const Observations& observations, const Trial& trial) {
  std::string values;
  for (const Chosen& chosen : trial.chosen) {
    for (const Estimate& each : estimates(observations, chosen, trial.covariance)) {
      values += fmt::format("{}{} {}", values.empty() ? " (by itself " : ", ", each.name,
                            readable(each.value, each.unit));
    }
    values += ")";
  }
  return fmt::format("Your law, {}{}: {}.", trial.hypothesis.statement(), values,
                     trial.stands ? "it stands" : "it does not stand, since " + trial.why);
}

std::string statement_of_retuned(const Observations& observations, const Diagnosis& diagnosis) {
  const Fit& fit = diagnosis.retuned;
  if (fit.chosen.empty()) {
    return "";
  }
  const std::size_t found = diagnosis.choice.findings.size();
  std::vector<std::string> numbers;
  for (std::size_t i = found; i < fit.chosen.size(); ++i) {
    const Hypothesis& number = fit.chosen[i].hypothesis;
    numbers.push_back(place_in_words(number.effect(), number.joint));
  }
  const bool is_regression =
      std::any_of(fit.chosen.begin(), fit.chosen.end(),
                  [](const Chosen& each) { return each.hypothesis.is_regression; });
  // Numbers that were fitted together mean little without each other.
  const bool is_whole = found > 0 && diagnosis.is_weighed_whole;
  return fmt::format(
      "No finding, but a stand-in until one is made{}: with other numbers in updated_model.yaml "
      "({}) {}{}.{}",
      found == 0 ? "" : " of what is left", first_few(numbers),
      is_whole ? "beside the findings " : "",
      fall(observations, is_whole ? as_given(observations) : diagnosis.choice.fit, fit),
      is_regression ? " Its masses are numbers of a regression, which predict better than those of "
                      "any bodies."
                    : "");
}

std::string statement_of_band(const Observations& observations, const Diagnosis& diagnosis) {
  const std::optional<TorqueBand> band = torque_band(observations);
  if (!band) {
    return "";
  }
  const std::string unit = unit_of(observations, simulation::joint_torque);
  const double error = rms_in_band(observations, *band, observations.residual, true);
  if (!std::isfinite(error)) {  // nothing was held out
    return "";
  }
  const std::string before = readable(error, unit);
  const std::string after =
      readable(rms_in_band(observations, *band, diagnosis.updated().remainder, true), unit);
  return fmt::format(
      "Below {:.0f} Hz, which is as fast as these angles can tell a motion (polynomials over "
      "{:.0f} "
      "ms), held-out error of joint torque {}.",
      band->frequency, 2e3 * band->half_window,
      after == before ? "is " + before : fmt::format("falls from {} to {}", before, after));
}

std::string statement_of_event(const Observations& observations, const Event& event) {
  std::vector<std::string> places;
  for (const Excursion& each : event.excursions) {
    places.push_back(fmt::format("{} of {} is off by up to {}", in_words(each.channel),
                                 component_in_words(each.channel, each.component),
                                 readable(each.most, unit_of(observations, each.channel))));
  }
  return fmt::format(
      "Something happened once, from {:.2f} to {:.2f} s of {}: {}. It is left out of all else.",
      event.begin, event.end, file_name(observations, event.scene), first_few(places));
}

std::string statement_of_left(const Diagnosis& diagnosis) {
  const Location& left = diagnosis.left;
  std::vector<std::string> parts;
  if (!left.joints.empty()) {
    parts.push_back(fmt::format("at {} {}", left.joints.size() > 1 ? "joints" : "joint",
                                fmt::join(left.joints, ", ")));
  }
  if (!left.axes.empty()) {
    parts.push_back(fmt::format("along {}", fmt::join(left.axes, ", ")));
  }
  std::vector<std::string> times;
  for (const auto& [begin, end] : left.time) {
    times.push_back(fmt::format("from {:.2f} to {:.2f} s", begin, end));
  }
  if (!times.empty()) {
    parts.push_back(first_few(times));
  }
  if (!left.frequency_hz.empty()) {
    parts.push_back(fmt::format("at {:.3g} Hz", left.frequency_hz.front()));
  }
  if (!left.correlates_with.empty() && left.correlates_with.front().share > kTellingShare) {
    const Correlate& most = left.correlates_with.front();
    parts.push_back(fmt::format("{:.0f} % of it with the {}", 100 * most.share, most.cue));
  }
  return is_open(diagnosis) && !parts.empty()
             ? fmt::format("What is left stands {}.", fmt::join(parts, ", "))
             : "";
}

std::string statement_of_clock(const ClockCheck& clock) {
  constexpr double kSure = 3.5;    // deviations: of several clocks in every recording one is beyond
                                   // two now and then
  constexpr double kShown = 1e-5;  // s
  const double side = kTold * clock.deviation;
  const double delay = std::round(clock.delay / kShown) * kShown + 0.0;  // no -0.00
  const char* verdict = std::abs(clock.delay) < side                      ? ", which is nothing"
                        : std::abs(clock.delay) < kSure * clock.deviation ? ", which may be chance"
                                                                          : "";
  return fmt::format("Clock of {}: late by {:.2f} ± {:.2f} ms (95 %){}.", in_words(clock.group),
                     1e3 * delay, 1e3 * side, verdict);
}

std::string headline(const Observations& observations, const Diagnosis& diagnosis) {
  const std::vector<Finding>& findings = diagnosis.choice.findings;
  if (findings.size() == 1) {
    return statement(observations, diagnosis, 0);
  }
  if (!findings.empty()) {
    std::vector<std::string> places;
    for (const Finding& finding : findings) {
      const Hypothesis& found = finding.chosen.hypothesis;
      places.push_back(place_in_words(found.effect(), found.joint));
    }
    const bool has_others = diagnosis.weighed().chosen.size() > findings.size();
    return fmt::format("The model lacks: {}. With all of it{} the {}.", first_few(places),
                       has_others ? " and what stands in for the rest" : "",
                       fall(observations, as_given(observations), diagnosis.weighed()));
  }
  if (diagnosis.verdict == Verdict::no_mismatch) {
    return "Model and recording agree within the noise.";
  }
  if (diagnosis.verdict == Verdict::explained) {
    return "Model and recording agree within the noise, but for what happened once.";
  }
  const std::string form =
      diagnosis.proposal.empty()
          ? ""
          : fmt::format(" A form proposed for it: {}.", diagnosis.proposal.front().text);
  return "Model and recording differ: " + diagnosis.reason + "." + form;
}

}  // namespace flexcomp::diagnosis
