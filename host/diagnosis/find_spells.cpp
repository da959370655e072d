#include "diagnosis/find_spells.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/fit.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Squares over the noise that a beginning or an end must explain. A moment that is sought among
/// thousands of rows is worth 18 by BIC; errors that hang together over time are worth more.
constexpr double kWorthOfMoment = 50;
constexpr std::size_t kMostMoments = 40;    // of a recording: more are a course, not spells
constexpr Eigen::Index kSpellBlocks = 400;  // of a recording, in which moments are sought first
constexpr int kFirstMoments = 8;            // moments of a recording from which spells are sought
constexpr int kSpellRounds = 8;             // of sizes and spells: few take more than four
constexpr double kAlikeDamping = 1e-9;      // of a column's square: against columns that are alike

/// Does an effect act in each of some steps of a scene's time, by how much the sum of squares
/// changes in each if it does? (Viterbi's algorithm: the least sum, a moment costs its worth.)
std::vector<bool> cheapest(const Eigen::VectorXd& change) {
  const Eigen::Index steps = change.size();
  std::vector<std::array<bool, 2>> came_from(static_cast<std::size_t>(steps));  // idle, acting
  std::array<double, 2> sum = {0, 0};
  for (Eigen::Index i = 0; i < steps; ++i) {
    std::array<double, 2> next{};
    for (const std::size_t acts : {0U, 1U}) {
      const double stays = sum[acts];
      const double turns = sum[1 - acts] + (i > 0 ? kWorthOfMoment : 0);
      came_from[static_cast<std::size_t>(i)][acts] = (turns < stays) != (acts == 1);
      next[acts] = std::min(stays, turns) + (acts == 1 ? change[i] : 0);
    }
    sum = next;
  }
  std::vector<bool> acts(static_cast<std::size_t>(steps));
  bool here = sum[1] < sum[0];
  for (std::size_t i = acts.size(); i-- > 0;) {
    acts[i] = here;
    here = came_from[i][here ? 1 : 0];
  }
  return acts;
}

/// Samples by blocks of time, all scenes' one after the other.
class SpellBlocks {
 public:
  explicit SpellBlocks(const Observations& observations) : scenes_(observations.scenes.size()) {
    of_sample_.reserve(observations.samples.size());
    for (const Sample& at : observations.samples) {
      const Eigen::Index rows = observations.scenes[at.scene].rows();
      of_sample_.push_back(static_cast<Eigen::Index>(at.scene) * kSpellBlocks +
                           equal_part_of(at.row, rows, kSpellBlocks));
    }
  }

  Eigen::Index count() const { return static_cast<Eigen::Index>(scenes_) * kSpellBlocks; }
  std::size_t scenes() const { return scenes_; }
  Eigen::Index of(Eigen::Index sample) const {
    return of_sample_[static_cast<std::size_t>(sample)];
  }

 private:
  std::size_t scenes_;
  std::vector<Eigen::Index> of_sample_;
};

/// What is fitted already, by normal equations over what is there to fit to.
class AlreadyFitted {
 public:
  AlreadyFitted(const Eigen::MatrixXd& columns, const Eigen::VectorXd& left)
      : product(columns.transpose() * left),
        scale_(columns.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose()) {
    const Eigen::MatrixXd scaled = columns * scale_.asDiagonal();
    Eigen::MatrixXd gram = scaled.transpose() * scaled;
    gram.diagonal().array() += kAlikeDamping;
    solver_.compute(gram);
  }

  /// Sizes by their products with something; none where nothing is fitted.
  Eigen::MatrixXd sizes(const Eigen::MatrixXd& products) const {
    return scale_.size() > 0 ? Eigen::MatrixXd(scale_.asDiagonal() *
                                               solver_.solve(scale_.asDiagonal() * products))
                             : products;
  }

  const Eigen::VectorXd product;  ///< with what is left

 private:
  Eigen::VectorXd scale_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

/// Products of an entry's columns with all that is fitted, itself included, and with what is left,
/// by block; and the sizes that follow from them for given spells.
class Entrywise {
 public:
  Entrywise(const Observations& observations, const SpellBlocks& blocks,
            const Eigen::MatrixXd& fitted, const Eigen::VectorXd& left, const Eigen::MatrixXd& own)
      : blocks_(blocks), p_(fitted.cols()), k_(own.cols()) {
    to_fit_.resize(static_cast<std::size_t>(blocks.count()),
                   Eigen::MatrixXd::Zero(p_ + k_ + 1, k_));
    all_ = to_fit_;
    Eigen::VectorXd row(p_ + k_ + 1);
    for (Eigen::Index i = 0; i < observations.size(); ++i) {
      row << fitted.row(i).transpose(), own.row(i).transpose(), left[i];
      const auto block = static_cast<std::size_t>(blocks.of(i));
      all_[block] += row * own.row(i);
      if (i < observations.train) {
        to_fit_[block] += row * own.row(i);
      }
    }
  }

  /// Sizes of what is fitted and of the entry, within its bounds, and how much the entry lowers the
  /// sum of squares.
  LeastSquares sizes(const std::vector<bool>& acts, const Hypothesis& hypothesis,
                     const AlreadyFitted& fitted) const {
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(p_ + k_ + 1, k_);
    for (std::size_t i = 0; i < acts.size(); ++i) {
      if (acts[i]) {
        product += to_fit_[i];
      }
    }
    const Eigen::MatrixXd shared = product.topRows(p_);
    const Eigen::MatrixXd own = product.middleRows(p_, k_);
    const Eigen::VectorXd moment = product.bottomRows(1).transpose();
    LeastSquares solved = solve_within_bounds(
        {&hypothesis}, own - shared.transpose() * fitted.sizes(shared),
        moment - shared.transpose() * fitted.sizes(fitted.product), own.diagonal().cwiseSqrt());
    Eigen::VectorXd all(p_ + k_);
    all << fitted.sizes(fitted.product - shared * solved.amplitude), solved.amplitude;
    return {all, solved.gain};
  }

  /// The spells in blocks that cost the least, for given sizes.
  std::vector<bool> spells(const Eigen::VectorXd& sizes) const {
    const Eigen::VectorXd own = sizes.tail(k_);
    Eigen::VectorXd weight(p_ + k_ + 1);  // of the squares of what is left with and without
    weight << 2 * sizes.head(p_), own, -2.0;
    Eigen::VectorXd change(blocks_.count());
    for (Eigen::Index i = 0; i < change.size(); ++i) {
      change[i] = weight.dot(all_[static_cast<std::size_t>(i)] * own);
    }
    std::vector<bool> acts;
    for (std::size_t scene = 0; scene < blocks_.scenes(); ++scene) {
      const std::vector<bool> here =
          cheapest(change.segment(static_cast<Eigen::Index>(scene) * kSpellBlocks, kSpellBlocks));
      acts.insert(acts.end(), here.begin(), here.end());
    }
    return acts;
  }

 private:
  const SpellBlocks& blocks_;
  Eigen::Index p_, k_;
  std::vector<Eigen::MatrixXd> to_fit_;  ///< by block: fitted, own and left × own
  std::vector<Eigen::MatrixXd> all_;     ///< the same with what was held out
};

std::size_t moments_in(const std::vector<bool>& acts) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < acts.size(); ++i) {
    count += i % kSpellBlocks != 0 && acts[i] != acts[i - 1] ? 1 : 0;
  }
  return count;
}

/// Does it change within the recordings to fit to?
bool changes(const std::vector<bool>& acts, std::size_t scenes) {
  const auto end = acts.begin() + static_cast<std::ptrdiff_t>(scenes * kSpellBlocks);
  return moments_in({acts.begin(), end}) > 0;
}

/// Always, and from a moment on in one recording or in all of them: with what to begin.
std::vector<std::vector<bool>> starts(std::size_t scenes, std::size_t to_fit) {
  const std::size_t count = scenes * kSpellBlocks;
  std::vector<std::vector<bool>> all = {std::vector<bool>(count, true)};
  for (int k = 1; k < kFirstMoments; ++k) {
    const auto moment = static_cast<std::size_t>(k * kSpellBlocks / kFirstMoments);
    std::vector<bool> everywhere(count, false);
    for (std::size_t scene = 0; scene < scenes; ++scene) {
      std::vector<bool> here(count, false);
      for (std::size_t i = moment; i < kSpellBlocks; ++i) {
        here[scene * kSpellBlocks + i] = everywhere[scene * kSpellBlocks + i] = true;
      }
      if (scene < to_fit) {
        all.push_back(std::move(here));
      }
    }
    all.push_back(std::move(everywhere));
  }
  return all;
}

Spells in_rows(const Observations& observations, const std::vector<bool>& blocks) {
  Spells spells;
  for (std::size_t scene = 0; scene < observations.scenes.size(); ++scene) {
    const Eigen::Index rows = observations.scenes[scene].rows();
    Eigen::VectorXd acts(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const auto block = static_cast<std::size_t>(equal_part_of(row, rows, kSpellBlocks));
      acts[row] = blocks[scene * kSpellBlocks + block] ? 1 : 0;
    }
    spells.acts.push_back(std::move(acts));
  }
  return spells;
}

/// May a hypothesis come and go? A clock and what grows gradually do not.
bool may_come_and_go(const Hypothesis& hypothesis) {
  const effects::Traits& traits = hypothesis.traits();
  return hypothesis.linear > 0 && !traits.is_clock && !traits.is_gradual && !traits.is_curve_only;
}

}  // namespace

std::vector<Spelled> find_spells(const Observations& observations, const Dictionary& dictionary,
                                 const Fit& beside) {
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd left = clipped(beside.remainder);
  const Eigen::MatrixXd& fitted = beside.derivative;
  const AlreadyFitted known(fitted.topRows(n), left.head(n));
  const SpellBlocks blocks(observations);
  const std::vector<std::vector<bool>> begun =
      starts(observations.scenes.size(), observations.train_scenes);
  std::vector<std::optional<Spelled>> found(dictionary.entries.size());
  in_parallel(
      found.size(), [](std::size_t, std::size_t) {},
      [&](std::size_t at) {
        const Entry& entry = dictionary.entries[at];
        const Hypothesis& hypothesis = dictionary.hypotheses[entry.hypothesis];
        if (!may_come_and_go(hypothesis)) {
          return;
        }
        const Entrywise products(observations, blocks, fitted, left,
                                 dictionary.columns.middleCols(entry.first, entry.count));
        const double always = products.sizes(begun.front(), hypothesis, known).gain;
        for (std::vector<bool> acts : begun) {
          LeastSquares sizes = products.sizes(acts, hypothesis, known);
          for (int round = 0; round < kSpellRounds; ++round) {
            std::vector<bool> anew = products.spells(sizes.amplitude);
            if (anew == acts) {
              break;
            }
            acts = std::move(anew);
            sizes = products.sizes(acts, hypothesis, known);
          }
          const std::size_t moments = moments_in(acts);
          const double gain = sizes.gain - always - kWorthOfMoment * static_cast<double>(moments);
          if (changes(acts, observations.train_scenes) &&
              moments <= kMostMoments * blocks.scenes() && sizes.amplitude.allFinite() &&
              within_bounds(hypothesis, sizes.amplitude.tail(entry.count)) &&
              gain > (found[at] ? found[at]->gain : 0)) {
            found[at] = Spelled{at, in_rows(observations, acts), gain};
          }
        }
        if (found[at]) {
          found[at]->gain += always;
        }
      });
  std::vector<Spelled> all;
  for (std::optional<Spelled>& each : found) {
    if (each) {
      all.push_back(std::move(*each));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Spelled& a, const Spelled& b) { return a.gain > b.gain; });
  return all;
}

Spells spells_of(const Observations& observations, const Eigen::VectorXd& left_without,
                 const Eigen::VectorXd& change) {
  std::vector<Eigen::VectorXd> by_row;
  for (const Scene& scene : observations.scenes) {
    by_row.emplace_back(Eigen::VectorXd::Zero(scene.rows()));
  }
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    by_row[at.scene][at.row] += change[i] * (change[i] - 2 * left_without[i]);
  }
  Spells spells;
  for (const Eigen::VectorXd& own : by_row) {
    const std::vector<bool> acts = cheapest(own);
    spells.acts.emplace_back(Eigen::VectorXd::Zero(own.size()));
    for (std::size_t row = 0; row < acts.size(); ++row) {
      spells.acts.back()[static_cast<Eigen::Index>(row)] = acts[row] ? 1 : 0;
    }
  }
  return spells;
}

}  // namespace flexcomp::diagnosis
