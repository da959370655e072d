#include "diagnosis/observations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "effects/machine_size.hpp"

namespace flexcomp::diagnosis {
namespace {

using simulation::joint_deflection;
using simulation::joint_torque;
using simulation::tcp_position;

template <typename Values>
double largest(const std::vector<Values>& all) {
  double most = 0;
  for (const Values& values : all) {
    most = values.size() > 0 ? std::max(most, values.cwiseAbs().maxCoeff()) : most;
  }
  return most;
}

/// A residual (over the noise) as an error of a joint, by scene; `lever`: by how much a sample
/// changes with it.
template <typename Lever>
std::vector<JointResidual> residual_through(const Observations& observations,
                                            const Eigen::VectorXd& unexplained,
                                            const Lever& lever) {
  std::vector<JointResidual> all;
  for (const Scene& scene : observations.scenes) {
    all.push_back({Eigen::VectorXd::Zero(scene.rows()), Eigen::VectorXd::Zero(scene.rows())});
  }
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const double arm = lever(at);
    const double noise = observations.noise[i];
    all[at.scene].product[at.row] += arm * unexplained[i] / noise;
    all[at.scene].weight[at.row] += arm * arm / (noise * noise);
  }
  return all;
}

}  // namespace

Eigen::Index stretch_of(Eigen::Index row, Eigen::Index rows) {
  return equal_part_of(row, rows, kHoldoutStretches);
}

const Eigen::MatrixXd& shown_load(const Scene& scene, const Prediction& prediction) {
  return prediction.dynamic_load.cols() > 0 && !scene.has(tcp_position) ? prediction.dynamic_load
                                                                        : prediction.load;
}

Observations::Observations(Machine model, std::vector<Scene> all, std::size_t holdouts)
    : machine(std::move(model)), scenes(std::move(all)) {
  rigid = simulation::rigid_torques(machine, scenes);
  simulations = simulate(machine, scenes, rigid, simulation::Levers::all);
  predictions = with_terms(machine.terms, scenes, simulations);
  is_static = scenes.front().is_static;
  noise_is_known = !is_static;
  find_acceleration_error();
  collect(holdouts);
  renew_residual();
}

void Observations::renew_residual() { residual = residual_of(predictions); }

Eigen::Index Observations::fewest_rows() const {
  const auto is_shorter = [](const Scene& a, const Scene& b) { return a.rows() < b.rows(); };
  return std::min_element(scenes.begin(), scenes.end(), is_shorter)->rows();
}

bool Observations::has(Channel channel) const { return scenes.front().has(channel); }

std::vector<Channel> Observations::channels() const {
  std::vector<Channel> all;
  for (std::size_t i = 0; i < simulation::kChannels.size(); ++i) {
    if (has(static_cast<Channel>(i))) {
      all.push_back(static_cast<Channel>(i));
    }
  }
  return all;
}

bool Observations::has_weight() const { return !machine.robot.elastic.gravity.isZero(0); }

bool Observations::has_wrench() const {
  return std::any_of(scenes.begin(), scenes.end(), [](const Scene& scene) {
    return scene.has_wrench && !scene.wrench.isZero(0);
  });
}

bool Observations::follows_command() const { return scenes.front().follows_command; }

double Observations::largest_load(int joint) const {
  std::vector<Eigen::VectorXd> loads;
  for (const Prediction& prediction : predictions) {
    loads.emplace_back(prediction.load.col(joint - 1));
    if (prediction.dynamic_load.cols() > 0) {
      loads.emplace_back(prediction.dynamic_load.col(joint - 1));
    }
  }
  return largest(loads);
}

double Observations::largest_torque(int joint) const {
  constexpr double kPeak = 3;  // times the root mean square, which single outliers hardly raise
  std::vector<Eigen::VectorXd> torques;
  for (const Scene& scene : scenes) {
    if (scene.has(joint_torque)) {
      const Eigen::ArrayXd measured = scene.measured[joint_torque].col(joint - 1).array();
      const Eigen::ArrayXd known = measured.isFinite().select(measured, 0.0);
      torques.emplace_back(Eigen::VectorXd::Constant(1, kPeak * std::sqrt(known.square().mean())));
    }
  }
  for (const Prediction& prediction : predictions) {
    torques.emplace_back(prediction.channel[joint_torque].cols() > 0
                             ? prediction.channel[joint_torque].col(joint - 1)
                             : prediction.load.col(joint - 1));
  }
  return largest(torques);
}

double Observations::largest_speed(int joint) const {
  std::vector<Eigen::VectorXd> speeds;
  for (const Scene& scene : scenes) {
    speeds.emplace_back(scene.velocity.col(joint - 1));
  }
  return largest(speeds);
}

double Observations::range(int joint) const {
  double most = 0;
  for (const Scene& scene : scenes) {
    const auto q = scene.q.col(joint - 1);
    most = std::max(most, q.maxCoeff() - q.minCoeff());
  }
  return most;
}

bool Observations::spans_workspace() const {
  constexpr double kApart = 0.15;      // m, standard deviation in two directions
  constexpr double kAllApart = 0.045;  // of the reach, in all three: no circle does that
  // Of the reach, in one direction and across it: a circle that did so would fill the workspace.
  constexpr double kFar = 0.3;
  constexpr double kAcross = 0.1;
  Eigen::Index count = 0;
  Vector3<double> sum = Vector3<double>::Zero();
  Matrix3<double> square = Matrix3<double>::Zero();
  for (const Prediction& prediction : predictions) {
    const Eigen::MatrixXd& position = prediction.channel[tcp_position];
    if (position.cols() == 3) {
      count += position.rows();
      sum += position.colwise().sum().transpose();
      square += position.transpose() * position;
    }
  }
  if (count == 0) {
    return false;
  }
  const Vector3<double> mean = sum / static_cast<double>(count);
  const Matrix3<double> spread = square / static_cast<double>(count) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> axes(spread, Eigen::EigenvaluesOnly);
  const Eigen::Array3d apart = axes.eigenvalues().cwiseMax(0).cwiseSqrt();  // in rising order
  const double reach = effects::size_of(machine.robot).outreach;
  return apart[1] > kApart || apart[0] > kAllApart * reach ||
         (apart[2] > kFar * reach && apart[1] > kAcross * reach);
}

Eigen::VectorXd Observations::stacked(const std::vector<Prediction>& values) const {
  Eigen::VectorXd column(values.size() < scenes.size() ? train : noise.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const Sample& at = samples[static_cast<std::size_t>(i)];
    column[i] = values[at.scene].channel[at.channel](at.row, at.component) / noise[i];
  }
  return column;
}

Eigen::VectorXd Observations::residual_of(const std::vector<Prediction>& values) const {
  Eigen::VectorXd column(noise.size());
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    const Sample& at = samples[static_cast<std::size_t>(i)];
    column[i] = (scenes[at.scene].measured[at.channel](at.row, at.component) -
                 values[at.scene].channel[at.channel](at.row, at.component)) /
                noise[i];
  }
  return column;
}

double Observations::rms(const Eigen::VectorXd& values, Channel channel, bool held_out,
                         std::optional<Eigen::Index> component) const {
  double sum = 0;
  double count = 0;
  const Part asked = part(held_out);
  for (Eigen::Index i = asked.first; i < asked.end; ++i) {
    const Sample& at = samples[static_cast<std::size_t>(i)];
    if (at.channel == channel && at.component == component.value_or(at.component)) {
      sum += std::pow(values[i] * noise[i], 2);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::vector<JointResidual> Observations::angle_residual(int joint,
                                                        const Eigen::VectorXd& unexplained) const {
  return residual_through(*this, unexplained, [&](const Sample& at) {
    if (at.channel == tcp_position) {
      return simulations[at.scene].jacobian[static_cast<std::size_t>(at.row)](at.component,
                                                                              joint - 1);
    }
    return at.channel == joint_deflection && at.component == joint - 1 ? 1.0 : 0.0;
  });
}

std::vector<JointResidual> Observations::torque_residual(int joint,
                                                         const Eigen::VectorXd& unexplained) const {
  return residual_through(*this, unexplained, [&](const Sample& at) {
    return at.channel == joint_torque && at.component == joint - 1 ? 1.0 : 0.0;
  });
}

void Observations::keep(const std::vector<bool>& kept) {
  Eigen::Index count = 0;
  Eigen::Index kept_train = 0;
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (!kept[static_cast<std::size_t>(i)]) {
      continue;
    }
    samples[static_cast<std::size_t>(count)] = samples[static_cast<std::size_t>(i)];
    noise[count] = noise[i];
    floor[count] = floor[i];
    ++count;
    kept_train += i < train ? 1 : 0;
  }
  samples.resize(static_cast<std::size_t>(count));
  noise.conservativeResize(count);
  floor.conservativeResize(count);
  train = kept_train;
  renew_residual();
}

void Observations::leave_out(std::size_t scene, Part rows) {
  std::vector<bool> kept;
  for (const Sample& at : samples) {
    kept.push_back(at.scene != scene || at.row < rows.first || at.row >= rows.end);
  }
  keep(kept);
}

void Observations::drop_outliers(const Eigen::VectorXd& values, double limit) {
  std::vector<bool> kept;
  for (Eigen::Index i = 0; i < size(); ++i) {
    kept.push_back(std::abs(values[i]) <= limit);
  }
  outliers += static_cast<std::size_t>(std::count(kept.begin(), kept.end(), false));
  keep(kept);
}

void Observations::set_noise(double factor) {
  noise *= factor;
  floor = noise;
  renew_residual();
}

void Observations::add_model_error(const Eigen::VectorXd& factors) {
  noise = noise.cwiseProduct(factors);
  renew_residual();
}

}  // namespace flexcomp::diagnosis
