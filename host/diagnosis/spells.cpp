#include "diagnosis/spells.hpp"

namespace flexcomp::diagnosis {

Eigen::VectorXd Spells::by_sample(const Observations& observations, Eigen::Index count) const {
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    values[i] = acts[at.scene][at.row];
  }
  return values;
}

std::vector<Spell> Spells::all() const {
  std::vector<Spell> spells;
  for (std::size_t scene = 0; scene < acts.size(); ++scene) {
    const Eigen::VectorXd& own = acts[scene];
    for (Eigen::Index row = 0; row < own.size(); ++row) {
      const bool begins = own[row] != 0 && (row == 0 || own[row - 1] == 0);
      if (begins) {
        spells.push_back({scene, {row, row}});
      }
      if (own[row] != 0) {
        spells.back().rows.end = row + 1;
      }
    }
  }
  return spells;
}

std::size_t Spells::changes() const {
  std::size_t count = 0;
  for (const Eigen::VectorXd& own : acts) {
    for (Eigen::Index row = 1; row < own.size(); ++row) {
      count += own[row] != own[row - 1] ? 1 : 0;
    }
  }
  return count;
}

bool Spells::lasts(const Observations& observations) const {
  const Eigen::VectorXd& last = acts[observations.train_scenes - 1];
  return last[last.size() - 1] != 0;
}

}  // namespace flexcomp::diagnosis
