#include "diagnosis/proposal.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/search/search.hpp"
#include "diagnosis/select/standards.hpp"
#include "effects/terms.hpp"
#include "linear_algebra/span.hpp"
#include "parallel/in_parallel.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr std::size_t kMostTerms = 3;  // more would fit anything, and tell nobody what it is
constexpr double kTermChance = 0.01;   // times the terms that are looked at, as of a finding
constexpr double kTermDeviations = 4;  // of a coefficient from zero: its constant alone is no term

/// A quantity along a recording that an error may follow.
struct Feature {
  enum Kind { angle, speed, load, time, temperature } kind;
  enum Shape { plain, size, square } shape;
  int joint;
};

Eigen::VectorXd plain_values(const Feature& feature, double reference, const Scene& scene,
                             const Simulation& simulation) {
  const Eigen::Index column = feature.joint - 1;
  switch (feature.kind) {
    case Feature::angle:
      return simulation.q.col(column).array() - reference;
    case Feature::speed:
      return simulation.velocity.col(column);
    case Feature::load:
      return shown_load(scene, simulation.prediction).col(column);
    case Feature::time:
      return scene.time.array() - scene.time[0];
    case Feature::temperature:
      break;
  }
  return scene.temperature.array() - reference;
}

Eigen::VectorXd values_along(const Feature& feature, double reference, const Scene& scene,
                             const Simulation& simulation) {
  Eigen::VectorXd plain = plain_values(feature, reference, scene, simulation);
  if (feature.shape == Feature::plain) {
    return plain;
  }
  if (feature.shape == Feature::size) {
    return plain.cwiseAbs();
  }
  return plain.cwiseAbs2();
}

double reference_of(const Feature& feature, const Observations& observations) {
  const Scene& scene = observations.scenes.front();
  switch (feature.kind) {
    case Feature::angle:
      return observations.simulations.front().q.col(feature.joint - 1).mean();
    case Feature::temperature:
      return scene.temperature.mean();
    default:
      return 0;
  }
}

std::string text_of(const Feature& feature, double reference, const model::Robot& robot) {
  constexpr const char* kNames[] = {"angle of joint", "speed of joint", "load on joint", "time",
                                    "temperature"};
  std::string name = feature.joint > 0 ? fmt::format("{} {}", kNames[feature.kind], feature.joint)
                                       : kNames[feature.kind];
  if (feature.shape == Feature::plain) {
    return name;
  }
  if (feature.shape == Feature::size) {
    return "|" + name + "|";
  }
  return feature.kind == Feature::angle
             ? fmt::format("({} − {:.3g} {})²", name, reference,
                           unit_of(robot.elastic.joint(feature.joint - 1), "rad"))
             : "(" + name + ")²";
}

/// An error's unit (as of a joint that turns) over that of a feature.
std::string unit_of(const Feature& feature, const std::string& output, const model::Robot& robot) {
  constexpr const char* kUnits[] = {"rad", "rad/s", "N·m", "s", "K"};
  std::string unit = kUnits[feature.kind];
  if (feature.joint > 0) {
    unit = model::unit_of(robot.elastic.joint(feature.joint - 1), unit);
  }
  const bool is_compound =
      unit.find('/') != std::string::npos || unit.find("·") != std::string::npos;
  return output + "/" + (is_compound ? "(" + unit + ")" : unit) +
         (feature.shape == Feature::square ? "²" : "");
}

std::vector<Feature> features(const Observations& observations) {
  std::vector<Feature> all;
  for (int joint = 1; joint <= observations.machine.robot.joints(); ++joint) {
    for (const Feature::Shape shape : {Feature::plain, Feature::size, Feature::square}) {
      if (shape != Feature::size) {  // an angle's size depends on where its zero is
        all.push_back({Feature::angle, shape, joint});
      }
      all.push_back({Feature::load, shape, joint});
      if (!observations.is_static) {
        all.push_back({Feature::speed, shape, joint});
      }
    }
  }
  const Scene& scene = observations.scenes.front();
  if (!observations.is_static) {
    all.push_back({Feature::time, Feature::plain, 0});
  }
  if (scene.temperature.size() > 0) {
    all.push_back({Feature::temperature, Feature::plain, 0});
  }
  return all;
}

/// Springs follow the load on their own joint; friction, and a servo behind its command, speed.
bool is_known(const Feature& feature, int joint, bool is_torque, bool follows_command) {
  if (feature.joint != joint || feature.shape != Feature::plain) {
    return false;
  }
  return feature.kind == (is_torque ? Feature::speed : Feature::load) ||
         (follows_command && feature.kind == Feature::speed);
}

/// An error of a joint's torque (N·m) or angle (rad): coefficient · feature + constant.
effects::LawPointer law_of(const model::Robot& robot, const Feature& feature, double reference,
                           bool is_torque, int joint) {
  const std::string output =
      model::unit_of(robot.elastic.joint(joint - 1), is_torque ? "N·m" : "rad");
  effects::Law law;
  law.effect = fmt::format("{} of joint {} in error by {}", is_torque ? "torque" : "angle", joint,
                           text_of(feature, reference, robot));
  law.traits.linear_in = 2;
  law.parameters = [unit = unit_of(feature, output, robot), output](const model::Robot&, int) {
    return std::vector<effects::Parameter>{{"coefficient", unit}, {"constant", output}};
  };
  law.apply = [=](const Values& values, int at_joint, Machine* machine) {
    machine->terms.push_back(
        {simulation::Term::output,
         [=](const Scene& scene, const Simulation& simulation, Prediction* prediction) {
           const Eigen::VectorXd error =
               values[1] + values[0] * values_along(feature, reference, scene, simulation).array();
           if (is_torque) {
             effects::add_torque(at_joint, error, prediction);
           } else {
             effects::add_joint_angle(simulation, at_joint, error, prediction);
           }
         }});
  };
  return std::make_shared<const effects::Law>(std::move(law));
}

Hypothesis term_of(const Observations& observations, const Feature& feature, int joint,
                   bool is_torque) {
  const double reference = reference_of(feature, observations);
  double largest = 0;
  for (std::size_t s = 0; s < observations.scenes.size(); ++s) {
    largest = std::max(largest, values_along(feature, reference, observations.scenes[s],
                                             observations.simulations[s])
                                    .cwiseAbs()
                                    .maxCoeff());
  }
  const double step = is_torque ? torque_step(observations, joint) : 1e-4;
  // A drive is in error by no more than twice what it was seen to give, an angle by 0.1 rad.
  const double far = is_torque ? 100 * step : 0.1;
  const double unit = std::max(largest, 1e-9);
  Hypothesis term(law_of(observations.machine.robot, feature, reference, is_torque, joint), joint,
                  observations.machine.robot);
  term.set_bounds({{-far / unit, far / unit, step / unit}, {-far, far, step}});
  return term;
}

std::vector<Hypothesis> library_of(const Observations& observations) {
  std::vector<Hypothesis> all;
  const std::vector<Feature> inputs = features(observations);
  for (const bool is_torque : {false, true}) {
    const bool is_seen =
        is_torque ? observations.has(simulation::joint_torque) : sees_angles(observations);
    for (int joint = 1; joint <= observations.machine.robot.joints() && is_seen; ++joint) {
      for (const Feature& feature : inputs) {
        if (!is_known(feature, joint, is_torque, observations.follows_command())) {
          all.push_back(term_of(observations, feature, joint, is_torque));
        }
      }
    }
  }
  return all;
}

/// The term that lowers the squares of what is left most, beside what is fitted.
const Hypothesis* best_beside(const Observations& observations, const Fit& fit,
                              const Changes& changes, const std::vector<Hypothesis>& library) {
  constexpr double kIndependent = 1e-3;  // of a column's length
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd left = clipped(fit.remainder.head(n));
  const Eigen::MatrixXd base = linear_algebra::orthonormal_basis(fit.derivative.topRows(n));
  std::vector<double> gains(library.size(), 0);
  in_parallel(
      library.size(), [](std::size_t, std::size_t) {},
      [&](std::size_t i) {
        Eigen::MatrixXd columns = changes.columns(library[i], {}).topRows(n);
        if (!columns.allFinite()) {
          return;
        }
        const Eigen::RowVectorXd length = columns.colwise().norm().cwiseMax(1e-300);
        columns.array().rowwise() /= length.array();
        columns -= base * (base.transpose() * columns).eval();
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd> rest(columns.rows(), columns.cols());
        rest.compute(columns);
        // Columns had unit length: what is left of one may be rounding.
        const auto independent =
            (rest.matrixQR().diagonal().cwiseAbs().array() > kIndependent).count();
        gains[i] = (rest.householderQ().transpose() * left).head(independent).squaredNorm();
      });
  const auto best = std::max_element(gains.begin(), gains.end());
  return best == gains.end() || !(*best > 0)
             ? nullptr
             : &library[static_cast<std::size_t>(best - gains.begin())];
}

class Proposer {
 public:
  Proposer(const Observations& observations, const Fit& known)
      : observations_(observations),
        library_(library_of(observations)),
        known_(known.chosen.size()),
        fit_(known) {}

  Proposal run() {
    const Changes changes(observations_);
    const Hypothesis* best = nullptr;
    do {
      best = terms() < kMostTerms ? best_beside(observations_, fit_, changes, library_) : nullptr;
    } while (best != nullptr && add(*best));
    for (std::size_t i = 0; i < terms();) {
      i = drop_if_superfluous(i) ? 0 : i + 1;
    }
    return result();
  }

 private:
  std::size_t terms() const { return fit_.chosen.size() - known_; }

  Fit with(std::vector<Chosen> chosen) const {
    return fit(observations_, std::move(chosen), kQuickSteps);
  }

  Evidence weighed(const Fit& before, const Fit& after) const {
    return weigh(observations_, before, after, static_cast<double>(library_.size()));
  }

  static bool holds(const Evidence& evidence) {
    return evidence.impossible.empty() && evidence.delta_bic > kStrongEvidence &&
           evidence.confirmation > kConfirmed && evidence.share > kLeastShare &&
           evidence.p_value < kTermChance;
  }

  bool add(const Hypothesis& term) {
    std::vector<Chosen> chosen = fit_.chosen;
    chosen.push_back({term, Values(term.parameters.size(), 0.0)});
    Fit grown = with(std::move(chosen));
    const auto coefficient = static_cast<Eigen::Index>(grown.parameters() - term.parameters.size());
    const double deviation = std::sqrt(std::max(grown.covariance(coefficient, coefficient), 0.0));
    const bool is_kept = holds(weighed(fit_, grown)) &&
                         std::abs(grown.chosen.back().values.front()) > kTermDeviations * deviation;
    if (is_kept) {
      fit_ = std::move(grown);
    }
    return is_kept;
  }

  std::vector<Chosen> others(std::size_t term) const {
    std::vector<Chosen> chosen = fit_.chosen;
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(known_ + term));
    return chosen;
  }

  /// A term that led the way to better ones may do nothing beside them.
  bool drop_if_superfluous(std::size_t term) {
    Fit fewer = with(others(term));
    const bool is_superfluous = !holds(weighed(fewer, fit_));
    if (is_superfluous) {
      fit_ = std::move(fewer);
    }
    return is_superfluous;
  }

  Proposal result() const {
    Proposal proposal{fit_, {}};
    Eigen::Index index = 0;
    for (std::size_t i = 0; i < fit_.chosen.size(); ++i) {
      const Chosen& chosen = fit_.chosen[i];
      if (i >= known_) {
        const Evidence evidence = weighed(with(others(i - known_)), fit_);
        proposal.terms.push_back({chosen.hypothesis.effect(),
                                  chosen.hypothesis.parameters.front().unit, chosen.values.front(),
                                  std::sqrt(std::max(fit_.covariance(index, index), 0.0)),
                                  std::min(evidence.share, 1.0)});
      }
      index += static_cast<Eigen::Index>(chosen.values.size());
    }
    return proposal;
  }

  const Observations& observations_;
  std::vector<Hypothesis> library_;
  std::size_t known_;
  Fit fit_;
};

}  // namespace

Proposal propose(const Observations& observations, const Fit& known) {
  return Proposer(observations, known).run();
}

}  // namespace flexcomp::diagnosis
