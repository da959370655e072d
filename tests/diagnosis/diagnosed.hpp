#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::test {

/// Settings of a diagnosis that tells nobody how far it is.
inline diagnosis::Settings quiet_settings() {
  diagnosis::Settings settings;
  settings.simulating = [](std::size_t, std::size_t) {};
  settings.choosing = [](const std::string&) {};
  return settings;
}

/// The same with so much processor time (s) for laws; none are composed for 0.
inline diagnosis::Settings quiet_settings(double law_seconds) {
  diagnosis::Settings settings = quiet_settings();
  settings.law_seconds = law_seconds;
  return settings;
}

/// A whole diagnosis, with so much processor time (s) for laws.
inline diagnosis::Diagnosis diagnosed(diagnosis::Observations* observations, double law_seconds) {
  return diagnose(observations, all_hypotheses(*observations), quiet_settings(law_seconds));
}

/// The findings of a whole diagnosis without laws.
inline std::vector<diagnosis::Finding> findings_of(diagnosis::Observations observations) {
  return diagnosed(&observations, 0).choice.findings;
}

}  // namespace flexcomp::test
