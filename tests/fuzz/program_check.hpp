#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "byte_source.hpp"
#include "complaint.hpp"
#include "programs/corrected_program.hpp"

namespace flexcomp::fuzz {

using ProgramReader = std::function<programs::Program(const std::string& text)>;

/// Everything of a program that was read is a number, and lies where its statement can stand: a
/// routine may call one that stands above it, but no two statements share their text.
inline void check_motions(const programs::Program& program) {
  for (const programs::Motion& motion : program.motions) {
    expect(motion.end.position.allFinite() && motion.end.rotation.allFinite(), "poses are finite");
    expect(motion.feed >= 0 && motion.feed < 1e12, "feeds are finite");
    expect(motion.turn_feed >= 0 && motion.turn_feed < 1e12, "turns are finite");
    expect(motion.arc.center.allFinite() && motion.arc.angle >= 0, "arcs are finite");
  }
  std::vector<programs::Motion> as_written = program.motions;
  std::sort(as_written.begin(), as_written.end(),
            [](const auto& a, const auto& b) { return a.begin < b.begin; });
  std::size_t at = 0;
  for (const programs::Motion& motion : as_written) {
    expect(motion.begin >= at && motion.finish >= motion.begin, "statements stand apart");
    at = motion.finish;
  }
  expect(at <= program.text.size(), "statements stand in the text");
}

/// Reads a program, writes it as if nothing had been corrected, and reads that.
inline void check_program(const std::string& text, const ProgramReader& read) {
  programs::CorrectedProgram same;
  same.source = read(text);
  check_motions(same.source);
  for (const programs::Motion& motion : same.source.motions) {
    expect(motion.end.position.cwiseAbs().maxCoeff() < 1e9, "places are those of machines");
    same.in_place.push_back({motion});
  }
  same.frame = same.source.frame.value_or(Pose<double>{});
  if (!same.source.motions.empty()) {
    const std::string written = programs::text_of(same, same.source.format, "p");
    expect(written.size() >= same.source.motions.size(), "every motion is written");
  }
}

}  // namespace flexcomp::fuzz
