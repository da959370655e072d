#include "diagnosis/clusters.hpp"

#include <algorithm>
#include <numeric>

namespace flexcomp::diagnosis {
namespace {

/// Chosen by judgement: fewer cells scatter too much themselves, and more would part rows whose
/// errors hang together.
constexpr Eigen::Index kMostCells = 16;
constexpr Eigen::Index kFewestRows = 3;  // of a cell
constexpr double kStill = 1e-6;          // rad, rad/s: a joint that moves by less stands

/// Angles and speeds of all scenes' rows (rows × twice the joints), those of joints that stand
/// zero, the others between 0 and 1.
Eigen::MatrixXd states_of(const std::vector<Scene>& scenes) {
  Eigen::Index rows = 0;
  for (const Scene& scene : scenes) {
    rows += scene.rows();
  }
  const Eigen::Index joints = scenes.front().joints();
  Eigen::MatrixXd states(rows, 2 * joints);
  Eigen::Index first = 0;
  for (const Scene& scene : scenes) {
    states.middleRows(first, scene.rows()) << scene.q, scene.velocity;
    first += scene.rows();
  }
  for (auto column : states.colwise()) {
    const double least = column.minCoeff();
    const double range = column.maxCoeff() - least;
    column = range > kStill ? ((column.array() - least) / range).matrix().eval()
                            : Eigen::VectorXd::Zero(rows).eval();
  }
  return states;
}

/// Halves the rows from `begin` to `end` at the median of the coordinate in which they scatter
/// most, and each half again, until a half has no more than `most` rows (k-d tree, Bentley 1975).
void divide(const Eigen::MatrixXd& states, std::size_t most,
            std::vector<Eigen::Index>::iterator begin, std::vector<Eigen::Index>::iterator end,
            Clusters* cells) {
  const auto rows = static_cast<std::size_t>(end - begin);
  if (rows <= most) {
    for (auto at = begin; at != end; ++at) {
      cells->of[static_cast<std::size_t>(*at)] = cells->count;
    }
    ++cells->count;
    return;
  }
  const std::vector<Eigen::Index> own(begin, end);
  const Eigen::MatrixXd here = states(own, Eigen::all);
  Eigen::Index widest = 0;
  (here.rowwise() - here.colwise().mean()).colwise().squaredNorm().maxCoeff(&widest);
  const auto middle = begin + static_cast<std::ptrdiff_t>(rows / 2);
  std::nth_element(begin, middle, end, [&](Eigen::Index a, Eigen::Index b) {
    return states(a, widest) < states(b, widest);
  });
  divide(states, most, begin, middle, cells);
  divide(states, most, middle, end, cells);
}

}  // namespace

Clusters clusters_in_time(const Observations& observations) {
  Clusters clusters;
  clusters.count = kHoldoutStretches * static_cast<Eigen::Index>(observations.scenes.size());
  clusters.of.reserve(static_cast<std::size_t>(observations.train));
  for (std::size_t i = 0; i < static_cast<std::size_t>(observations.train); ++i) {
    const Sample& at = observations.samples[i];
    clusters.of.push_back(static_cast<Eigen::Index>(at.scene) * kHoldoutStretches +
                          stretch_of(at.row, observations.scenes[at.scene].rows()));
  }
  return clusters;
}

Clusters clusters_in_state(const Observations& observations) {
  const Eigen::MatrixXd states = states_of(observations.scenes);
  Clusters cells;
  cells.of.resize(static_cast<std::size_t>(states.rows()));
  std::vector<Eigen::Index> rows(cells.of.size());
  std::iota(rows.begin(), rows.end(), 0);
  const auto most = static_cast<std::size_t>(
      std::max(kFewestRows, (states.rows() + kMostCells - 1) / kMostCells));
  divide(states, most, rows.begin(), rows.end(), &cells);

  std::vector<Eigen::Index> first_row;
  Eigen::Index first = 0;
  for (const Scene& scene : observations.scenes) {
    first_row.push_back(first);
    first += scene.rows();
  }
  Clusters clusters;
  clusters.count = cells.count;
  clusters.of.reserve(static_cast<std::size_t>(observations.train));
  for (std::size_t i = 0; i < static_cast<std::size_t>(observations.train); ++i) {
    const Sample& at = observations.samples[i];
    clusters.of.push_back(cells.of[static_cast<std::size_t>(first_row[at.scene] + at.row)]);
  }
  return clusters;
}

}  // namespace flexcomp::diagnosis
