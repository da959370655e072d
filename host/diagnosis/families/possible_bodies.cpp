#include "diagnosis/families/possible_bodies.hpp"

#include <Eigen/QR>

#include "diagnosis/held_remainder.hpp"
#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kCloser = 0.3;          // times the tolerances of a body that cannot be
constexpr int kRounds = 20;              // of a tighter edge
constexpr double kTighter = 0.3;         // times the edge before
constexpr int kBodySteps = 50;           // of each round; one takes milliseconds
constexpr double kTangentChange = 1e-9;  // of the sum of squares

/// The weighted squares of a fit about where it is, rotated into as many rows as there are numbers.
struct Tangent {
  Eigen::VectorXd begin;  ///< the numbers there
  Eigen::MatrixXd slope;  ///< of the prediction by the numbers
  Eigen::VectorXd left;   ///< of the remainder

  Tangent(const Observations& observations, const Fit& fit) {
    const Eigen::Index n = observations.train;
    const Eigen::Index columns = fit.derivative.cols();
    const Eigen::VectorXd root = huber_weights(fit.remainder.head(n)).cwiseSqrt();
    Eigen::MatrixXd whole(n, columns + 1);
    whole.leftCols(columns) = root.asDiagonal() * fit.derivative.topRows(n);
    whole.col(columns) = root.cwiseProduct(fit.remainder.head(n));
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(whole);
    const Eigen::MatrixXd upper =
        factors.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
    slope = upper.leftCols(columns);
    left = upper.col(columns);
    begin.resize(columns);
    Eigen::Index next = 0;
    for (const Chosen& each : fit.chosen) {
      for (const double value : each.values) {
        begin[next++] = value;
      }
    }
  }
};

/// The rows of the tangent, instead of a simulation.
class TangentRemainder : public HeldRemainder {
 public:
  TangentRemainder(const Tangent& tangent, Evaluator* evaluator)
      : HeldRemainder(evaluator), tangent_(tangent) {}

 protected:
  std::optional<Eigen::VectorXd> left(const Values& values, Eigen::MatrixXd* slope) const override {
    if (slope != nullptr) {
      *slope = -tangent_.slope;
    }
    const Eigen::Map<const Eigen::VectorXd> here(values.data(), tangent_.begin.size());
    return tangent_.left - tangent_.slope * (here - tangent_.begin);
  }

 private:
  const Tangent& tangent_;
};

}  // namespace

std::optional<std::vector<Chosen>> without_impossible(const Observations& observations,
                                                      const Fit& fit, std::size_t given,
                                                      bool holds_bodies) {
  std::vector<Chosen> possible;
  bool all_can_be = true;
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    Chosen chosen = fit.chosen[i];
    const bool can_be = i < given || could_be(observations, fit, i);
    all_can_be = all_can_be && can_be;
    if (can_be || (holds_bodies && chosen.hypothesis.traits().is_body)) {
      for (Parameter& parameter : chosen.hypothesis.parameters) {
        parameter.tolerance *= can_be ? 1 : kCloser;
      }
      possible.push_back(std::move(chosen));
    }
  }
  return all_can_be ? std::nullopt : std::make_optional(std::move(possible));
}

bool bodies_can_be(const Observations& observations, const Fit& fit) {
  return Bodies(observations, fit.chosen).can_be(fit.machine.robot);
}

std::vector<Chosen> with_possible_bodies(const Observations& observations, const Fit& fit) {
  const Tangent tangent(observations, fit);
  std::vector<Chosen> chosen = fit.chosen;
  for (int round = 0; round < kRounds; ++round) {
    for (Chosen& each : chosen) {
      each.hypothesis.edge *= kTighter;
    }
    Evaluator evaluator(observations, chosen, nullptr);
    TangentRemainder cost(tangent, &evaluator);
    minimise(&cost, {kBodySteps, kTangentChange}, &evaluator);
    chosen = evaluator.chosen();
    if (evaluator.bodies().can_be(evaluator.robot_with(evaluator.values()))) {
      break;
    }
  }
  return chosen;
}

}  // namespace flexcomp::diagnosis
