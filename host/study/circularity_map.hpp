#pragma once

#include <functional>
#include <vector>

#include "study/milled_circle.hpp"

namespace flexcomp::study {

/// Circularity over the plane of joints 2 and 3: circles about the nodes of a grid.
struct CircularityMap {
  double step = 0.05;    ///< m; nodes lie at its whole multiples
  int first_column = 0;  ///< x of the first column, in steps
  int first_row = 0;     ///< z of the first row, in steps
  int columns = 0;
  int rows = 0;
  std::vector<double> circularity;  ///< m, row by row; NaN where out of reach

  double x(int column) const { return (first_column + column) * step; }
  double z(int row) const { return (first_row + row) * step; }
  double at(int column, int row) const {
    return circularity[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(column)];
  }
};

/// Nodes wherever the arm could reach, nothing known of them (NaN). Throws InputError for a step
/// that is not above zero or gives more than 10⁸ nodes.
CircularityMap empty_map(const PlanarArm& arm, double step);

/// The map of all that the arm reaches, on all cores. `progress` is told: rows done, of how many.
/// Throws InputError as `empty_map` does.
CircularityMap map_circularity(const CircleStudy& study, double step,
                               const std::function<void(std::size_t, std::size_t)>& progress);

/// Values over the nodes in reach; m.
struct MapSummary {
  std::size_t reached = 0;
  double min = 0;
  double max = 0;
  double mean = 0;
  double median = 0;
};

/// Throws InputError for a map with nothing in reach.
MapSummary summarize(const CircularityMap& map);

/// Where a square job, its sides along x and z, is milled best: all of its nodes in reach, the
/// worst of them as small as may be.
struct BestSquare {
  double size = 0;    ///< m, of a side
  bool fits = false;  ///< is there any place for it? Else what follows is meaningless
  double x = 0;       ///< m, of its centre
  double z = 0;
  double worst = 0;  ///< m, the largest circularity in it
};

BestSquare best_square(const CircularityMap& map, double size);

}  // namespace flexcomp::study
