#include "diagnosis/output/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "diagnosis/output/pictures.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/parameters.hpp"
#include "report/html.hpp"

namespace flexcomp::diagnosis {
namespace {

using report::escaped;

constexpr const char* kStyle =
    "body{font-family:sans-serif;max-width:960px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.8em 0}td,th{padding:.3em "
    ".8em;text-align:left;vertical-align:top;"
    "border-bottom:1px solid #ddd}svg{max-width:100%;height:auto}.lead{font-size:1.2em}"
    "h2{margin-top:1.6em}";

/// The 95 % interval of an estimate to either side, in one digit; tens and thousands are written
/// out.
std::string margin(double deviation) {
  const double side = 1.96 * deviation;
  return side < 9.5 || side >= 1e6 ? fmt::format("{:.1g}", side) : fmt::format("{:.0f}", side);
}

std::string chance(double p_value) {
  return p_value > 1e-300 ? fmt::format("{:.1g}", p_value) : "&lt; 1e-300";
}

std::string channel_rows(const Observations& observations, const Eigen::VectorXd& after) {
  std::string rows;
  for (const Channel channel : observations.channels()) {
    const auto rms = [&](const Eigen::VectorXd& values, bool held_out) {
      return three_digits(shown(channel, observations.rms(values, channel, held_out)));
    };
    rows += fmt::format(
        "<tr><td>{}, {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        simulation::kChannels[channel], shown_unit(channel),
        rms(Eigen::VectorXd::Ones(observations.size()), false), rms(observations.residual, false),
        rms(after, false), rms(observations.residual, true), rms(after, true));
  }
  return "<table><tr><th>channel</th><th>noise</th><th>before, fitted</th><th>after, fitted</th>"
         "<th>before, held out</th><th>after, held out</th></tr>\n" +
         rows + "</table>\n";
}

std::string parameters(const Observations& observations, const Chosen& chosen,
                       const Eigen::MatrixXd& covariance) {
  std::string values;
  for (const Estimate& each : estimates(observations, chosen, covariance)) {
    const bool is_told = std::isfinite(each.deviation);
    const std::string unit = each.unit == "1" ? "" : " " + each.unit;
    values += fmt::format("{} = {:.4g}{}{}{}<br>", each.name, each.value,
                          is_told ? " ± " + margin(each.deviation) : "", unit,
                          is_told ? "" : ", ± not known");
  }
  return values;
}

std::string finding_rows(const Observations& observations, const Diagnosis& diagnosis) {
  std::string rows;
  for (std::size_t i = 0; i < diagnosis.choice.findings.size(); ++i) {
    const Finding& finding = diagnosis.choice.findings[i];
    const Hypothesis& hypothesis = finding.chosen.hypothesis;
    std::string others;
    for (const Alternative& other : finding.alternatives) {
      others += fmt::format("{}: {:.0f} worse<br>", place_name(other.effect, other.joint),
                            other.delta_bic);
    }
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{}</td><td>{}</td></tr>\n",
                        place_name(hypothesis.effect(), hypothesis.joint),
                        parameters(observations, finding.chosen, finding.covariance),
                        finding.evidence.delta_bic, chance(finding.evidence.p_value),
                        others.empty() ? "none comes near" : others);
  }
  if (rows.empty()) {
    return "<p>No effect is proved.</p>\n";
  }
  return "<table><tr><th>finding</th><th>parameters, ± 95 %</th><th>evidence, BIC</th>"
         "<th>by chance</th><th>next best</th></tr>\n" +
         rows + "</table>\n";
}

template <typename List, typename Text>
std::string joined(const List& list, const Text& text) {
  std::string all;
  for (const auto& each : list) {
    all += (all.empty() ? "" : ", ") + text(each);
  }
  return all.empty() ? "none stands out" : all;
}

std::string location_table(const Location& location) {
  const auto number = [](auto value) { return fmt::format("{:.4g}", static_cast<double>(value)); };
  std::string rows = fmt::format(
      "<tr><th>joints</th><td>{}</td></tr>\n<tr><th>axes</th><td>{}</td></tr>\n"
      "<tr><th>time</th><td>{}</td></tr>\n<tr><th>frequency</th><td>{}</td></tr>\n",
      joined(location.joints, number),
      joined(location.axes, [](const std::string& axis) { return axis; }),
      joined(location.time,
             [&](const auto& stretch) {
               return three_digits(stretch.first) + " to " + three_digits(stretch.second) + " s";
             }),
      joined(location.frequency_hz, [&](double hertz) { return three_digits(hertz) + " Hz"; }));
  for (const Correlate& each : location.correlates_with) {
    rows += fmt::format("<tr><th>goes with</th><td>{}: {:.0f} % of its power</td></tr>\n", each.cue,
                        100 * each.share);
  }
  return fmt::format(
      "<table>\n{}</table>\n<p>{} places were looked at; what stands here is "
      "significant at 1 % with that counted.</p>\n",
      rows, location.places);
}

std::string quality_table(const Observations& observations, const Diagnosis& diagnosis,
                          const std::vector<Quality>& qualities) {
  std::string html =
      "<table><tr><th>recording</th><th>rows</th><th>incomplete</th><th>used</th>"
      "<th>median step, s</th><th>largest gap, s</th></tr>\n";
  for (const Quality& each : qualities) {
    const simulation::Preparation& done = each.preparation;
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>one in {}</td><td>{:.4g}</td>"
        "<td>{:.4g}</td></tr>\n",
        escaped(each.file), done.rows, done.incomplete, done.kept_each, done.median_step,
        done.largest_gap);
  }
  html += fmt::format(
      "</table>\n<p>{} samples stood alone, far from their neighbours, and were "
      "left out.</p>\n",
      observations.outliers);
  for (const ClockCheck& clock : diagnosis.clocks) {
    html += fmt::format("<p>Clock of {}: late by {:.2f} ± {:.2f} ms (95 %).</p>\n", clock.group,
                        1e3 * clock.delay, 1.96e3 * clock.deviation);
  }
  html +=
      "<table><tr><th>joint</th><th>moves over, rad</th><th>up to, rad/s</th>"
      "<th>load up to, N·m</th><th>what can be told of it</th></tr>\n";
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
    html += "<p>" + joined(group, [](const Place& p) { return place_name(p.effect, p.joint); }) +
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
  std::string rows;
  for (std::size_t i = diagnosis.choice.findings.size(); i < fit.chosen.size(); ++i) {
    const Hypothesis& hypothesis = fit.chosen[i].hypothesis;
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n",
                        place_name(hypothesis.effect(), hypothesis.joint),
                        parameters(observations, fit.chosen[i], fit.covariance_of(i)));
  }
  return "<p>" + escaped(statement_of_retuned(observations, diagnosis)) +
         "</p>\n<table><tr><th>number of the model</th><th>± 95 %</th></tr>\n" + rows +
         "</table>\n" + channel_rows(observations, fit.remainder);
}

}  // namespace

std::string to_html(const Observations& observations, const Diagnosis& diagnosis,
                    const std::vector<Quality>& qualities) {
  const Eigen::VectorXd& after = diagnosis.choice.fit.remainder;
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Diagnosis</title>\n"
      "<style>{}</style></head><body>\n<h1>Diagnosis of {}</h1>\n<p class=\"lead\">{}</p>\n"
      "<p>Verdict: <b>{}</b>{}</p>\n",
      kStyle, escaped(observations.machine.robot.name), escaped(headline(observations, diagnosis)),
      diagnosis.verdict, diagnosis.reason.empty() ? "" : " (" + diagnosis.reason + ")");
  html += "<h2>Findings</h2>\n" + finding_rows(observations, diagnosis);
  html += "<h2>Residual</h2>\n" + channel_rows(observations, after);
  for (const Channel channel : observations.channels()) {
    html += fmt::format("<h3>{}</h3>\n{}\n", simulation::kChannels[channel],
                        time_picture(observations, after, channel));
  }
  if (observations.has(simulation::tcp_position) && !observations.is_static) {
    html += "<h3>along the path</h3>\n" + path_picture(observations, after);
  }
  html += "<h2>Where the mismatch is</h2>\n" + location_table(diagnosis.location);
  if (!diagnosis.reason.empty()) {
    html += "<h2>Where what is left is</h2>\n" + location_table(diagnosis.left);
  }
  if (!diagnosis.nearest.empty()) {
    html += "<p>Nearest to it, without proof: " +
            joined(diagnosis.nearest,
                   [](const Place& place) { return place_name(place.effect, place.joint); }) +
            ".</p>\n";
  }
  html += proposal(diagnosis.proposal);
  html += retuned(observations, diagnosis);
  html += "<h2>Hypotheses</h2>\n" + ranking_picture(diagnosis.choice.ranking);
  html += "<h2>What cannot be told apart</h2>\n" + groups(diagnosis);
  html += "<h2>What to record next</h2>\n<p>" +
          (diagnosis.suggested_experiment.empty() ? "Nothing is open that a recording would settle."
                                                  : escaped(diagnosis.suggested_experiment)) +
          "</p>\n";
  html += "<h2>Data</h2>\n" + quality_table(observations, diagnosis, qualities);
  return html + "</body></html>\n";
}

}  // namespace flexcomp::diagnosis
