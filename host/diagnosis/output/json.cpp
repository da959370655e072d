#include "diagnosis/output/json.hpp"

#include <cmath>

#include "check/json.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/output/torque_band.hpp"
#include "diagnosis/output/words.hpp"
#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {
namespace {

using Json = nlohmann::ordered_json;
using simulation::kChannels;

Json joint_or_null(int joint) { return joint > 0 ? Json(joint) : Json(nullptr); }

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Null where the part has no samples of the channel.
Json rms_or_null(const Observations& observations, const Eigen::VectorXd& values, Channel channel,
                 bool held_out) {
  const bool has_samples =
      observations.rms(Eigen::VectorXd::Ones(observations.size()), channel, held_out) > 0;
  return has_samples ? Json(observations.rms(values, channel, held_out)) : Json(nullptr);
}

Json rms_of(const Observations& observations, const Eigen::VectorXd& values) {
  Json json = Json::object();
  for (const Channel channel : observations.channels()) {
    json[kChannels[channel]] = {{"train_rms", rms_or_null(observations, values, channel, false)},
                                {"holdout_rms", rms_or_null(observations, values, channel, true)}};
  }
  return json;
}

Json noise_floor(const Observations& observations) {
  Json json = Json::object();
  for (const Channel channel : observations.channels()) {
    json[kChannels[channel]] =
        observations.rms(Eigen::VectorXd::Ones(observations.size()), channel, false);
  }
  return json;
}

Json event_json(const Observations& observations, const Event& event) {
  Json places = Json::array();
  for (const Excursion& each : event.excursions) {
    places.push_back({{"channel", kChannels[each.channel]},
                      {"component", component_in_words(each.channel, each.component)},
                      {"largest", each.most}});
  }
  return {{"file", observations.scenes[event.scene].file},
          {"time", {event.begin, event.end}},
          {"places", places},
          {"statement", statement_of_event(observations, event)}};
}

Json location(const Location& location) {
  Json correlates = Json::array();
  for (const Correlate& each : location.correlates_with) {
    correlates.push_back(
        {{"with", each.cue}, {"share_of_power", each.share}, {"p_value", each.p_value}});
  }
  return {{"joints", location.joints},     {"axes", location.axes},
          {"time", location.time},         {"frequency_hz", location.frequency_hz},
          {"correlates_with", correlates}, {"places_looked_at", location.places}};
}

Json parameters_of(const Observations& observations, const Chosen& chosen,
                   const Eigen::MatrixXd& covariance) {
  Json parameters = Json::object();
  for (const Estimate& estimate : estimates(observations, chosen, covariance)) {
    parameters[estimate.name] = {{"value", estimate.value},
                                 {"std", finite_or_null(estimate.deviation)},
                                 {"unit", estimate.unit}};
  }
  return parameters;
}

/// Parameters of a finding; `std_alone` were nothing off but what was found.
Json parameters_of(const Observations& observations, const Finding& finding) {
  Json parameters = parameters_of(observations, finding.chosen, finding.whole_covariance());
  for (const Estimate& alone : estimates(observations, finding.chosen, finding.covariance)) {
    parameters[alone.name]["std_alone"] = finite_or_null(alone.deviation);
  }
  return parameters;
}

/// Of effects that take several.
Json form_or_null(const Hypothesis& hypothesis) {
  return hypothesis.law->form.empty() ? Json(nullptr) : Json(hypothesis.law->form);
}

Json formula_json(const model::WrittenLaw& law) {
  return {{"place", law.place},
          {"axis", law.axis.empty() ? Json(nullptr) : Json(law.axis)},
          {"formula", law.formula}};
}

Json places(const std::vector<Place>& all) {
  Json json = Json::array();
  for (const Place& place : all) {
    json.push_back({{"effect", place.effect}, {"joint", joint_or_null(place.joint)}});
  }
  return json;
}

/// When a finding acts that comes and goes; null where it always does.
Json when_json(const Observations& observations, const std::shared_ptr<const Spells>& when) {
  if (!when) {
    return nullptr;
  }
  Json json = Json::array();
  for (const Spell& spell : when->all()) {
    const Scene& scene = observations.scenes[spell.scene];
    json.push_back({{"file", scene.file},
                    {"time", {scene.time[spell.rows.first], scene.time[spell.rows.end - 1]}}});
  }
  return json;
}

Json finding_json(const Observations& observations, const Diagnosis& diagnosis, std::size_t index) {
  const Choice& choice = diagnosis.choice;
  const Finding& finding = choice.findings[index];
  const Hypothesis& hypothesis = finding.chosen.hypothesis;
  Json alternatives = Json::array();
  for (const Alternative& other : finding.alternatives) {
    alternatives.push_back({{"effect", other.effect},
                            {"form", form_or_null(other.chosen.hypothesis)},
                            {"joint", joint_or_null(other.joint)},
                            {"delta_bic", other.delta_bic}});
  }
  const Channel channel = main_channel(observations, finding.without, diagnosis.weighed());
  Json json = {{"effect", hypothesis.effect()},
               {"form", form_or_null(hypothesis)},
               {"joint", joint_or_null(hypothesis.joint)},
               {"when", when_json(observations, hypothesis.when)}};
  if (hypothesis.law->written) {
    json.update(formula_json(*hypothesis.law->written));
  }
  json.update(
      {{"parameters", parameters_of(observations, finding)},
       {"confounders", places(finding.confounders)},
       {"evidence",
        {{"delta_bic", finding.evidence.delta_bic},
         {"p_value", finding.evidence.p_value},
         {"channel", kChannels[channel]},
         {"holdout_rms_before", observations.rms(finding.without.remainder, channel, true)},
         {"holdout_rms_after", observations.rms(diagnosis.weighed().remainder, channel, true)}}},
       {"alternatives", alternatives},
       {"statement", statement(observations, diagnosis, index)}});
  return json;
}

/// The answer to a law that a person suspected, with its fit by itself.
Json trial_json(const Observations& observations, const Trial& trial) {
  Json json = formula_json(*trial.hypothesis.law->written);
  json["joint"] = joint_or_null(trial.hypothesis.joint);
  json["stands"] = trial.stands;
  json["why_not"] = trial.stands ? Json(nullptr) : Json(trial.why);
  json["parameters"] = nullptr;
  json["evidence"] = nullptr;
  if (!trial.chosen.empty()) {
    json["parameters"] = parameters_of(observations, trial.chosen.front(), trial.covariance);
    json["evidence"] = {{"delta_bic", trial.evidence.delta_bic},
                        {"p_value", trial.evidence.p_value},
                        {"explained", trial.evidence.explained}};
  }
  json["statement"] = statement_of_trial(observations, trial);
  return json;
}

Json excitation_json(const Excitation& of) {
  return {{"joint", of.joint},
          {"range", of.range},
          {"largest_speed", of.largest_speed},
          {"largest_load", of.largest_load},
          {"reversals", of.reversals},
          {"relative_stiffness_resolution", finite_or_null(of.stiffness)},
          {"zero_resolution", finite_or_null(of.zero)},
          {"friction_resolution", finite_or_null(of.friction)},
          {"verdict", verdict(of)}};
}

/// Errors of torques that passed the filter by which the angles were differentiated.
Json band_json(const Observations& observations, const Diagnosis& diagnosis) {
  const std::optional<TorqueBand> band = torque_band(observations);
  if (!band) {
    return nullptr;
  }
  const auto rms = [&](const Eigen::VectorXd& values) {
    return Json{{"train_rms", rms_in_band(observations, *band, values, false)},
                {"holdout_rms", rms_in_band(observations, *band, values, true)}};
  };
  return {{"below_hz", band->frequency},
          {"baseline", rms(observations.residual)},
          {"final", rms(diagnosis.updated().remainder)}};
}

/// A form, not a finding: what the residual goes with, whatever causes it.
Json proposal_json(const std::vector<ProposedTerm>& terms) {
  Json json = Json::array();
  for (const ProposedTerm& term : terms) {
    json.push_back({{"form", term.text},
                    {"coefficient", term.coefficient},
                    {"std", term.deviation},
                    {"unit", term.unit},
                    {"share_of_power", term.share}});
  }
  return json;
}

/// The model's own numbers that stand in for what is unexplained, and what they do for each
/// channel.
Json retuned_json(const Observations& observations, const Diagnosis& diagnosis) {
  const Fit& fit = diagnosis.retuned;
  if (fit.chosen.empty()) {
    return nullptr;
  }
  Json numbers = Json::array();
  for (std::size_t i = diagnosis.choice.findings.size(); i < fit.chosen.size(); ++i) {
    const Hypothesis& hypothesis = fit.chosen[i].hypothesis;
    numbers.push_back(
        {{"number", hypothesis.effect()},
         {"joint", hypothesis.joint},
         {"parameters", parameters_of(observations, fit.chosen[i], fit.covariance_of(i))}});
  }
  return {{"numbers", numbers}, {"updated_model", rms_of(observations, fit.remainder)}};
}

}  // namespace

Json to_json(const Observations& observations, const Diagnosis& diagnosis,
             const check::Checks& checks) {
  Json json = {{"schema", "flexcomp/diagnosis/1"}, {"verdict", name_of(diagnosis.verdict)}};
  json["channels"] = Json::array();
  for (const Channel channel : observations.channels()) {
    json["channels"].push_back(kChannels[channel]);
  }
  json["noise_floor_rms"] = noise_floor(observations);
  json["baseline"] = rms_of(observations, observations.residual);
  json["final"] = rms_of(observations, diagnosis.updated().remainder);
  json["joint_torque_in_band"] = band_json(observations, diagnosis);
  json["location"] = location(diagnosis.location);
  json["findings"] = Json::array();
  for (std::size_t i = 0; i < diagnosis.choice.findings.size(); ++i) {
    json["findings"].push_back(finding_json(observations, diagnosis, i));
  }
  json["unexplained"] = nullptr;
  if (!diagnosis.reason.empty()) {
    json["unexplained"] = {{"reason", diagnosis.reason},
                           {"location", location(diagnosis.left)},
                           {"nearest", places(diagnosis.nearest)},
                           {"proposal", proposal_json(diagnosis.proposal)},
                           {"retuned", retuned_json(observations, diagnosis)}};
  }
  json["indistinguishable"] = Json::array();
  for (const std::vector<Place>& group : diagnosis.indistinguishable) {
    json["indistinguishable"].push_back(places(group));
  }
  json["suggested_experiment"] =
      diagnosis.suggested_experiment.empty() ? Json(nullptr) : Json(diagnosis.suggested_experiment);
  json["laws"] = Json::array();
  for (const Trial& trial : diagnosis.trials) {
    json["laws"].push_back(trial_json(observations, trial));
  }
  json["law_search_stopped"] = diagnosis.laws_stopped;
  json["clocks"] = Json::array();
  for (const ClockCheck& clock : diagnosis.clocks) {
    json["clocks"].push_back(
        {{"group", clock.group}, {"delay", clock.delay}, {"std", clock.deviation}});
  }
  json["events"] = Json::array();
  for (const Event& event : diagnosis.events) {
    json["events"].push_back(event_json(observations, event));
  }
  json["excitation"] = Json::array();
  for (const Excitation& each : diagnosis.excitation) {
    json["excitation"].push_back(excitation_json(each));
  }
  json["cancellation"] = diagnosis.cancellation;
  json["outliers"] = observations.outliers;
  json["checks"] = check::as_json(checks);
  return json;
}

}  // namespace flexcomp::diagnosis
