#pragma once

#include <string>

/// First words of RAPID's statements, in capitals.
namespace flexcomp::programs {

/// An instruction that moves the robot, whether it is read or not.
bool is_rapid_motion(const std::string& word);

/// One of these that is not read.
bool is_unreadable_rapid_motion(const std::string& word);

/// An instruction that is known not to change motions.
bool is_rapid_without_motion(const std::string& word);

bool opens_rapid_block(const std::string& word);
bool closes_rapid_block(const std::string& word);
bool begins_rapid_routine(const std::string& word);
bool ends_rapid_routine(const std::string& word);

/// An instruction that moves the points of motions behind it: PDispSet, EOffsOn.
bool displaces_rapid_motions(const std::string& word);

}  // namespace flexcomp::programs
