#include "diagnosis/output/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/output/courses.hpp"
#include "diagnosis/output/errors.hpp"
#include "diagnosis/output/law_picture.hpp"
#include "diagnosis/output/pictures.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"
#include "report/html.hpp"

namespace flexcomp::diagnosis {
namespace {

using report::escaped;

constexpr const char* kStyle =
    "body{font-family:sans-serif;max-width:960px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.8em 0}td,th{padding:.3em .8em;text-align:left;"
    "vertical-align:top;border-bottom:1px solid #ddd}"
    ".numbers td:not(:first-child),.numbers th:not(:first-child){text-align:right}"
    "svg{max-width:100%;height:auto}.lead{font-size:1.2em}h2{margin-top:1.6em}"
    ".error,.warning{border-left:4px solid #c0392b;padding:.3em .8em;margin:.6em 0}"
    ".warning{border-color:#d68910}.origin{color:#666;font-size:.85em}"
    "code{overflow-wrap:anywhere}"
    "@media print{body{max-width:none;margin:0;font-size:10pt}h2,h3{break-after:avoid}"
    "svg,tr,.error,.warning{break-inside:avoid}a{color:inherit}@page{margin:15mm}}";

/// The 95 % interval of an estimate to either side, in one digit; tens and thousands are written
/// out.
std::string margin(double deviation) {
  const double side = kTold * deviation;
  return side < 9.5 || side >= 1e6 ? fmt::format("{:.1g}", side) : fmt::format("{:.0f}", side);
}

std::string chance(double p_value) {
  return p_value > 1e-300 ? fmt::format("{:.1g}", p_value) : "&lt; 1e-300";
}

std::string parameters(const std::vector<Estimate>& all) {
  std::string values;
  for (const Estimate& each : all) {
    const bool is_told = std::isfinite(each.deviation);
    const auto [factor, unit] = readable_scale(
        is_told ? std::max(std::abs(each.value), kTold * each.deviation) : std::abs(each.value),
        each.unit);
    // A number that rests on zero from below is zero.
    values += fmt::format("{} = {:.4g}{}{}{}<br>", each.name, factor * each.value + 0.0,
                          is_told ? " ± " + margin(factor * each.deviation) : "",
                          unit == "1" ? "" : " " + unit, is_told ? "" : ", ± not known");
  }
  return values;
}

/// A finding's parameters; where confounders make them less certain, what they would be without.
std::string parameters(const Observations& observations, const Finding& finding) {
  std::string html =
      parameters(estimates(observations, finding.chosen, finding.whole_covariance()));
  if (!finding.confounders.empty()) {
    std::vector<std::string> names;
    for (const Place& each : finding.confounders) {
      names.push_back(place_in_words(each.effect, each.joint));
    }
    html += fmt::format(
        "<small>These recordings do not rule out, beside it: {}. Were nothing else "
        "off:<br>{}</small>",
        fmt::join(names, ", "),
        parameters(estimates(observations, finding.chosen, finding.covariance)));
  }
  return html;
}

/// "law of joint 5: a*sin(q4)", "payload, at times"
std::string named(const Hypothesis& hypothesis) {
  const std::string place =
      place_in_words(hypothesis.effect(), hypothesis.joint) + (hypothesis.when ? ", at times" : "");
  return hypothesis.law->written ? place + ": " + escaped(hypothesis.law->written->formula) : place;
}

/// "dry friction that builds up of joint 3 (slider)"
std::string with_form(const Hypothesis& hypothesis) {
  const std::string& form = hypothesis.law->form;
  return named(hypothesis) + (form.empty() ? "" : fmt::format(" ({})", in_words(form)));
}

std::string finding_rows(const Observations& observations, const Diagnosis& diagnosis) {
  std::string rows;
  for (std::size_t i = 0; i < diagnosis.choice.findings.size(); ++i) {
    const Finding& finding = diagnosis.choice.findings[i];
    const Hypothesis& hypothesis = finding.chosen.hypothesis;
    std::string others;
    std::set<std::string> told;
    for (const Alternative& other : finding.alternatives) {
      const std::string name = with_form(other.chosen.hypothesis);
      if (told.insert(name).second) {  // else the same from another start, and worse
        others += fmt::format("{}: {:.0f} worse<br>", name, other.delta_bic);
      }
    }
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{}</td><td>{}</td></tr>\n",
                        named(hypothesis), parameters(observations, finding),
                        finding.evidence.delta_bic, chance(finding.evidence.p_value),
                        others.empty() ? "none comes near" : others);
  }
  std::string events;
  for (const Event& event : diagnosis.events) {
    events += fmt::format("<p>{}</p>\n", escaped(statement_of_event(observations, event)));
  }
  if (rows.empty()) {
    return "<p>No effect is proved.</p>\n" + events;
  }
  return "<table><tr><th>finding</th><th>parameters, ± 95 %</th><th>evidence, BIC</th>"
         "<th>by chance</th><th>next best, BIC</th></tr>\n" +
         rows + "</table>\n" + events;
}

template <typename List, typename Text>
std::string joined(const List& list, const Text& text) {
  std::string all;
  for (const auto& each : list) {
    all += (all.empty() ? "" : ", ") + text(each);
  }
  return all.empty() ? "none stands out" : all;
}

constexpr const char* kPathAngle =
    " The path angle is the angle about the middle of the TCP's path.";

std::string location_table(const Observations& observations, const Location& location) {
  const auto number = [](auto value) { return fmt::format("{:.4g}", static_cast<double>(value)); };
  const std::string unit = observations.is_static ? "" : " s";
  std::string rows = fmt::format(
      "<tr><th>joints</th><td>{}</td></tr>\n<tr><th>axes</th><td>{}</td></tr>\n"
      "<tr><th>{}</th><td>{}</td></tr>\n<tr><th>frequency</th><td>{}</td></tr>\n",
      joined(location.joints, number),
      joined(location.axes, [](const std::string& axis) { return axis; }),
      observations.is_static ? "rows" : "stretches of time",
      joined(location.time,
             [&](const auto& stretch) {
               return three_digits(stretch.first) + " to " + three_digits(stretch.second) + unit;
             }),
      joined(location.frequency_hz, [&](double hertz) { return three_digits(hertz) + " Hz"; }));
  bool has_path_angle = false;
  for (const Correlate& each : location.correlates_with) {
    has_path_angle = has_path_angle || each.cue == "path angle";
    rows += fmt::format("<tr><th>goes with</th><td>{}: {:.0f} % of the error's power</td></tr>\n",
                        each.cue, 100 * each.share);
  }
  return fmt::format(
      "<table>\n{}</table>\n<p>{} places were looked at; what stands here is "
      "significant at 1 % with that counted. Shares do not add up, since quantities go together "
      "along a recording.{}</p>\n",
      rows, location.places, has_path_angle ? kPathAngle : "");
}

std::string quality_table(const Observations& observations, const Diagnosis& diagnosis,
                          const std::vector<Quality>& qualities) {
  std::string html =
      "<table><tr><th>recording</th><th>rows</th><th>incomplete</th><th>repeated</th><th>used</th>"
      "<th>median step, s</th><th>largest gap, s</th></tr>\n";
  for (const Quality& each : qualities) {
    const simulation::Preparation& done = each.preparation;
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.4g}</td>"
        "<td>{:.4g}</td></tr>\n",
        escaped(each.file), done.rows, done.incomplete, done.repeats.size(),
        done.kept_each > 1 ? fmt::format("one in {}", done.kept_each) : "all", done.median_step,
        done.largest_gap);
  }
  html += "</table>\n";
  for (const Quality& each : qualities) {
    if (each.preparation.period > 0) {
      html += fmt::format(
          "<p>{}: the angles are smooth over evenly spaced times, {:.4g} ms apart, and not over "
          "those given; these were evened.</p>\n",
          escaped(each.file), 1e3 * each.preparation.period);
    }
  }
  html += fmt::format(
      "<p>{} samples stood alone, far from their neighbours, and were "
      "left out.</p>\n",
      observations.outliers);
  for (const ClockCheck& clock : diagnosis.clocks) {
    html += fmt::format("<p>{}</p>\n", statement_of_clock(clock));
  }
  const model::Chain& chain = observations.machine.robot.elastic;
  html += fmt::format(
      "<table><tr><th>joint</th><th>moves over, {}</th><th>up to, {}</th>"
      "<th>load up to, {}</th><th>what can be told of it</th></tr>\n",
      unit_of(chain, "rad"), unit_of(chain, "rad/s"), unit_of(chain, "N·m"));
  for (const Excitation& each : diagnosis.excitation) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        each.joint, three_digits(each.range), three_digits(each.largest_speed),
                        three_digits(each.largest_load), verdict(each));
  }
  return html + "</table>\n<p>What can be told: ± 95 %, were it the only change.</p>\n";
}

std::string groups(const Diagnosis& diagnosis) {
  std::string html;
  for (const std::vector<Place>& group : diagnosis.indistinguishable) {
    html += "<p>" +
            joined(group, [](const Place& p) { return place_in_words(p.effect, p.joint); }) +
            "</p>\n";
  }
  return html.empty() ? "<p>Nothing that matters.</p>\n" : html;
}

std::string proposal(const std::vector<ProposedTerm>& terms) {
  if (terms.empty()) {
    return "";
  }
  std::string rows;
  for (const ProposedTerm& term : terms) {
    rows += fmt::format("<tr><td>{}</td><td>{:.4g} ± {} {}</td><td>{:.0f} %</td></tr>\n",
                        escaped(term.text), term.coefficient, margin(term.deviation),
                        escaped(term.unit), 100 * term.share);
  }
  return "<p>A form is proposed for it, not a finding: it says what the error goes with, not what "
         "causes it.</p>\n<table><tr><th>proposed term</th><th>coefficient, ± 95 %</th>"
         "<th>of what was left</th></tr>\n" +
         rows + "</table>\n";
}

std::string retuned(const Observations& observations, const Diagnosis& diagnosis) {
  const Fit& fit = diagnosis.retuned;
  if (fit.chosen.empty()) {
    return "";
  }
  const bool held_out = observations.train < observations.size();
  const Channel channel = main_channel(observations, diagnosis.choice.fit, fit);
  const double with = observations.rms(fit.remainder, channel, held_out);
  const Scale scale = scale_of(unit_of(observations, channel),
                               observations.rms(observations.residual, channel, held_out));
  std::string rows;
  for (std::size_t i = diagnosis.choice.findings.size(); i < fit.chosen.size(); ++i) {
    const Hypothesis& hypothesis = fit.chosen[i].hypothesis;
    const Values& values = fit.chosen[i].values;
    if (std::all_of(values.begin(), values.end(), [](double value) { return value == 0; })) {
      continue;  // the model's own number stays
    }
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        place_in_words(hypothesis.effect(), hypothesis.joint),
        parameters(estimates(observations, fit.chosen[i], fit.covariance_of(i))),
        three_digits(scale.factor * (rms_without(observations, fit, i, channel) - with)));
  }
  return fmt::format(
      "<h2>Stand-ins</h2>\n<p>{}</p>\n<table><tr><th>number of the model</th><th>± 95 %</th>"
      "<th>without it the error of {} grows by, {}</th></tr>\n{}</table>\n",
      escaped(statement_of_retuned(observations, diagnosis)), in_words(channel), scale.unit, rows);
}

std::string trials_html(const Observations& observations, const Diagnosis& diagnosis) {
  std::string html;
  for (const Trial& trial : diagnosis.trials) {
    html += fmt::format("<p>{}</p>\n", escaped(statement_of_trial(observations, trial)));
  }
  return html.empty() ? "" : "<h2>Laws that you suspected</h2>\n" + html;
}

std::string checks_html(const check::Checks& checks) {
  std::string html;
  for (const check::Check& each : checks) {
    if (each.severity != check::Severity::note) {
      html +=
          fmt::format("<p class=\"{0}\"><b>{0}</b> ({1}): {2}. {3}.</p>\n",
                      check::word(each.severity), each.name, escaped(each.what), escaped(each.fix));
    }
  }
  return html.empty() ? "" : "<h2>Asked first: is the input right?</h2>\n" + html;
}

std::string notes_html(const check::Checks& checks) {
  std::string html;
  for (const check::Check& each : checks) {
    if (each.severity == check::Severity::note) {
      html += fmt::format("<p>{}. {}.</p>\n", escaped(each.what), escaped(each.fix));
    }
  }
  return html;
}

/// Errors in all, then of each joint or axis with the courses behind them.
std::string errors_html(const Observations& observations, const Diagnosis& diagnosis) {
  const Eigen::VectorXd& after = diagnosis.updated().remainder;
  std::string html = "<h2>Errors</h2>\n" + channel_table(observations, diagnosis) +
                     fmt::format("<p>{}</p>\n", statement_of_band(observations, diagnosis));
  for (const Channel channel : observations.channels()) {
    html += fmt::format("<h3>In the {}</h3>\n{}{}\n{}\n", in_words(channel),
                        component_table(observations, diagnosis, channel),
                        time_picture(observations, after, channel),
                        course_picture(observations, after, channel));
  }
  if (observations.has(simulation::tcp_position) && !observations.is_static) {
    html += "<h3>Along the path</h3>\n" + path_picture(observations, after);
  }
  return html;
}

std::string origin_html(const Origin& origin) {
  return fmt::format("<p class=\"origin\">{}, {}<br><code>{}</code></p>\n", escaped(origin.date),
                     escaped(origin.version), escaped(origin.command));
}

}  // namespace

std::string to_html(const Observations& observations, const Diagnosis& diagnosis,
                    const Origin& origin) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Diagnosis of {0}"
      "</title>\n<style>{1}</style></head><body>\n<h1>Diagnosis of {0}</h1>\n{2}",
      escaped(observations.machine.robot.name), kStyle, checks_html(origin.checks));
  html +=
      fmt::format("<p class=\"lead\">{}</p>\n<p>Verdict: <b>{}</b>{}</p>\n",
                  escaped(headline(observations, diagnosis)), in_words(name_of(diagnosis.verdict)),
                  diagnosis.reason.empty() ? "" : " (" + escaped(diagnosis.reason) + ")");
  html += "<h2>Findings</h2>\n" + finding_rows(observations, diagnosis);
  html += law_pictures(observations, diagnosis) +
          (diagnosis.laws_stopped ? fmt::format("<p>{}</p>\n", kLawsStopped) : "");
  html += trials_html(observations, diagnosis) + retuned(observations, diagnosis);
  html += errors_html(observations, diagnosis);
  html += "<h2>Where the mismatch is</h2>\n" + location_table(observations, diagnosis.location);
  if (!diagnosis.reason.empty()) {
    html += "<h2>Where what is left is</h2>\n" + location_table(observations, diagnosis.left);
  }
  if (!diagnosis.nearest.empty()) {
    html += "<p>Nearest to it, without proof: " +
            joined(diagnosis.nearest,
                   [](const Place& place) { return place_in_words(place.effect, place.joint); }) +
            ".</p>\n";
  }
  html += proposal(diagnosis.proposal);
  html += "<h2>Hypotheses</h2>\n" + ranking_picture(diagnosis.choice.ranking);
  if (!diagnosis.choice.ranking.empty()) {
    html +=
        "<p>A first look, each alone and in proportion, before any was chosen. An error that "
        "hangs together counts as few samples here, so these numbers are on another scale than "
        "the evidence of the findings.</p>\n";
  }
  html += "<h2>What cannot be told apart</h2>\n" + groups(diagnosis);
  const std::string none = diagnosis.reason.empty()
                               ? "Nothing is open that a recording would settle."
                               : "No recording is known that would settle what is left.";
  html +=
      "<h2>What to record next</h2>\n<p>" +
      (diagnosis.suggested_experiment.empty() ? none : escaped(diagnosis.suggested_experiment)) +
      "</p>\n";
  html += "<h2>Data</h2>\n" + quality_table(observations, diagnosis, origin.qualities) +
          notes_html(origin.checks) + origin_html(origin);
  return html + "</body></html>\n";
}

}  // namespace flexcomp::diagnosis
