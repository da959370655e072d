#pragma once

#include <tinyxml.h>

#include <string>

namespace flexcomp::model {

/// Refuses what urdfdom would replace by a default without a word: a mass, place, axis, limit or
/// inertia that is no number, has the wrong count, stands twice, is misspelt, stands in the wrong
/// element or is missing.
///
/// An origin, its xyz or rpy, and an inertial may be left out, as the standard says; a joint that
/// moves must say its axis and its limits; of a continuous one they may be left out. What flexcomp
/// does not read (pictures, collision shapes, transmissions) is not looked at.
///
/// Throws InputError with file, line and element. `file` is for messages.
void refuse_unreadable_values(const std::string& file, const TiXmlDocument& document);

}  // namespace flexcomp::model
