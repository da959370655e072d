#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "programs/corrected_program.hpp"

namespace flexcomp::programs {

/// A number with so many decimals, and no minus before a zero.
std::string fixed(double value, int decimals);

/// Was the program read from a text in this format, which can be rewritten?
bool has_text_in(Format format, const Program& source);

/// The source's text with each motion's statement replaced, everything else byte for byte.
/// `statement` is told a motion's number.
std::string rewritten(const Program& source,
                      const std::function<std::string(std::size_t)>& statement);

/// "From pocket.nc, corrected for the deflection of the robot by flexcomp.", or what holds where
/// nothing is corrected. The first line of a program that is not in its source's format.
std::string origin_of(const CorrectedProgram& program);

/// Why a program that is written anew stops before a motion from a place that the source does not
/// tell.
constexpr const char* kUnknownWay =
    "the source does not tell the way to the next point: come to it by a motion of your own";

/// How the source's lines end.
std::string_view line_end(const Program& source);

/// Lines of the source that stand before a motion and after the one before it, or behind all where
/// there is no such motion, as comments: each without blanks around, behind `mark`. Empty lines are
/// left out. What a moving line of G-code says beside its motion follows them.
std::string comments_before(const Program& source, std::size_t motion, const std::string& mark);

/// Does the way go on after a motion without a corner (10°) and without a rapid, so that there need
/// be no stop?
bool goes_on(const CorrectedProgram& program, std::size_t motion);

/// The pose before a motion; its own end for the first.
const Pose<double>& start_of(const CorrectedProgram& program, std::size_t motion);

/// Calls `visit` with the start of every motion that takes the place of one of the source's, the
/// motion, and whether it is the last of them.
void visit_in_place(const CorrectedProgram& program, std::size_t motion,
                    const std::function<void(const Pose<double>&, const Motion&, bool)>& visit);

/// So many straight lines are within 5 µm of a motion.
int chords_of(const Pose<double>& start, const Motion& motion);

}  // namespace flexcomp::programs
