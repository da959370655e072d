#include "study/circularity_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "error.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::study {
namespace {

constexpr double kMostNodes = 1e8;

/// The largest of every `width` numbers that follow each other; NaN where one of them is.
std::vector<double> sliding_worst(const std::vector<double>& values, std::size_t width) {
  std::vector<double> worst;
  for (std::size_t first = 0; first + width <= values.size(); ++first) {
    double most = values[first];
    for (std::size_t i = first + 1; i < first + width && !std::isnan(most); ++i) {
      most = std::isnan(values[i]) ? values[i] : std::max(most, values[i]);
    }
    worst.push_back(most);
  }
  return worst;
}

}  // namespace

CircularityMap empty_map(const PlanarArm& arm, double step) {
  const double reach = arm.reach[1];
  if (!(step > 0) || !(std::pow(2 * reach / step + 2, 2) < kMostNodes)) {
    throw InputError("the step of the map must be above zero and not so small: at most 1e8 nodes");
  }
  const auto first = [&](double middle) {
    return static_cast<int>(std::floor((middle - reach) / step));
  };
  const auto count = [&](double middle) {
    return static_cast<int>(std::ceil((middle + reach) / step)) - first(middle) + 1;
  };
  CircularityMap map;
  map.step = step;
  map.first_column = first(arm.shoulder.real());
  map.first_row = first(arm.shoulder.imag());
  map.columns = count(arm.shoulder.real());
  map.rows = count(arm.shoulder.imag());
  map.circularity.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                         std::numeric_limits<double>::quiet_NaN());
  return map;
}

CircularityMap map_circularity(const CircleStudy& study, double step,
                               const std::function<void(std::size_t, std::size_t)>& progress) {
  CircularityMap map = empty_map(study.arm(), step);
  const auto columns = static_cast<std::size_t>(map.columns);
  in_parallel(static_cast<std::size_t>(map.rows), progress, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      map.circularity[row * columns + column] =
          study.circularity({map.x(static_cast<int>(column)), map.z(static_cast<int>(row))});
    }
  });
  return map;
}

MapSummary summarize(const CircularityMap& map) {
  std::vector<double> values;
  std::copy_if(map.circularity.begin(), map.circularity.end(), std::back_inserter(values),
               [](double value) { return !std::isnan(value); });
  if (values.empty()) {
    throw InputError("no circle of the map is in reach: a smaller radius, or another robot");
  }
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  const auto total = static_cast<double>(count);
  return {count, values.front(), values.back(),
          std::accumulate(values.begin(), values.end(), 0.0) / total,
          (values[(count - 1) / 2] + values[count / 2]) / 2};
}

BestSquare best_square(const CircularityMap& map, double size) {
  BestSquare best;
  best.size = size;
  best.worst = std::numeric_limits<double>::infinity();
  const double steps = std::ceil(size / map.step - 1e-9);
  if (!(size >= 0) || steps >= std::min(map.columns, map.rows)) {
    return best;
  }
  const auto width = static_cast<std::size_t>(steps) + 1;
  // First along the rows, then along the columns of what that gives.
  std::vector<std::vector<double>> along_rows;
  for (int row = 0; row < map.rows; ++row) {
    const auto begin = map.circularity.begin() + static_cast<std::ptrdiff_t>(row) * map.columns;
    along_rows.push_back(sliding_worst({begin, begin + map.columns}, width));
  }
  for (std::size_t column = 0; column < along_rows.front().size(); ++column) {
    std::vector<double> line;
    line.reserve(along_rows.size());
    for (const std::vector<double>& row : along_rows) {
      line.push_back(row[column]);
    }
    const std::vector<double> worst = sliding_worst(line, width);
    for (std::size_t row = 0; row < worst.size(); ++row) {
      if (worst[row] < best.worst) {
        best.fits = true;
        best.worst = worst[row];
        best.x = map.x(static_cast<int>(column)) + steps * map.step / 2;
        best.z = map.z(static_cast<int>(row)) + steps * map.step / 2;
      }
    }
  }
  return best;
}

}  // namespace flexcomp::study
