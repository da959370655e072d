#pragma once

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// One plain sentence about a finding.
std::string statement(const Observations& observations, const Diagnosis& diagnosis,
                      std::size_t finding);

/// One plain sentence about a law that a person suspected: whether it stands, or why not.
std::string statement_of_trial(const Observations& observations, const Trial& trial);

/// One plain sentence about the numbers that stand in for what is unexplained; empty without any.
std::string statement_of_retuned(const Observations& observations, const Diagnosis& diagnosis);

/// One plain sentence about the torques that the angles can tell of; empty where that is all.
std::string statement_of_band(const Observations& observations, const Diagnosis& diagnosis);

/// One plain sentence about something that happened once: when, where, and how much.
std::string statement_of_event(const Observations& observations, const Event& event);

/// One plain sentence about where and when what is unexplained stands; empty where nothing of it
/// stands out.
std::string statement_of_left(const Diagnosis& diagnosis);

/// One plain sentence about a clock: how late it is, ± 95 %, and whether that is nothing.
std::string statement_of_clock(const ClockCheck& clock);

/// Where the search for laws ended for want of time.
constexpr const char* kLawsStopped =
    "The search for laws ended for want of time: --law-seconds gives it more.";

/// One plain sentence about the whole.
std::string headline(const Observations& observations, const Diagnosis& diagnosis);

}  // namespace flexcomp::diagnosis
