#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "byte_source.hpp"
#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"

namespace flexcomp::fuzz {

using Words = std::vector<std::uint32_t>;

/// A stretch of program, as a table of a few nodes.
inline Words path_table(const RobotModel<float, 6>& model) {
  std::array<JointVector<float, 6>, 8> program;
  for (std::size_t i = 0; i < program.size(); ++i) {
    program[i] = test::loop_angles<float>(0.05 * static_cast<double>(i));
  }
  Words words(1 << 12);
  std::size_t size = 0;
  const Result built =
      build_path_table<float, 6>(model, program.data(), program.size(), {1600, 20, 1e-4F, 1e-4F, 0},
                                 words.data(), 4 * words.size(), &size);
  expect(built == Result::ok, "the path table builds");
  words.resize(size / 4);
  return words;
}

/// A small box over joints 2 and 3.
inline Words grid_table(const RobotModel<float, 6>& model) {
  const GridRange<float> ranges[4] = {{-1.25F, -1.15F}, {1.25F, 1.35F}, {0.3F, 0.3F}, {0.8F, 0.8F}};
  Words words(1 << 14);
  std::size_t size = 0;
  const Result built = build_grid_table<float, 6>(model, ranges, {1600, 20, 1e-4F, 1e-4F, 0},
                                                  words.data(), 4 * words.size(), &size);
  expect(built == Result::ok, "the grid table builds");
  words.resize(size / 4);
  return words;
}

}  // namespace flexcomp::fuzz
