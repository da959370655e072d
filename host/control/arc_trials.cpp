#include "control/arc_trials.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulation/sample_arms.hpp"

namespace flexcomp::control {
namespace {

constexpr double kTrialPi = 3.14159265358979323846;
constexpr int kThinning = 20;  // ticks from one drawn sample to the next

/// A swing that begins smoothly: position, velocity and acceleration are zero at first.
template <int Joints>
Reference<Joints> swing_at(const Trial<Joints>& trial, double time) {
  const double w = trial.frequency;
  const double s = std::sin(w * time);
  const double c = std::cos(w * time);
  return {trial.center + trial.size * (s * s * s), trial.size * (3 * w * s * s * c),
          trial.size * (w * w * (6 * s * c * c - 3 * s * s * s))};
}

template <int Joints>
using Arc = AdaptiveRobustController<double, Joints>;

template <int Joints>
Arc<Joints> configured(const Trial<Joints>& trial, const ArcGains<double, Joints>& gains) {
  Arc<Joints> controller;
  if (controller.configure(trial.nominal.model, trial.nominal.inertia, gains) != Result::ok) {
    throw std::invalid_argument("the core refuses the gains of a design");
  }
  return controller;
}

/// Gains that adapt so little that nothing comes of it, and forget as little.
template <int Joints>
ArcGains<double, Joints> frozen(ArcGains<double, Joints> gains) {
  gains.link_adaptation.setConstant(1e-200);
  gains.motor_adaptation.setConstant(1e-200);
  gains.leak = 1e-12;
  return gains;
}

/// Figures of the last fifth, thinned samples on the way.
template <int Joints>
TrialRun<Joints> run_with(const Trial<Joints>& trial, const std::string& name,
                          const Controller<Joints>& controller, const Arc<Joints>* adaptive) {
  TrialRun<Joints> run;
  run.controller = name;
  TrackingJob<Joints> job;
  job.period = trial.design.gains.period;
  job.arm = trial.arm;
  job.later_arm = trial.arm;
  job.later_arm->model.payload_mass = trial.load;
  job.change_time = trial.duration / 2;
  job.duration = trial.duration;
  job.reference = [&trial](double time) { return swing_at(trial, time); };
  job.load = [&trial](double time, const auto&) -> JointVector<double, Joints> {
    return trial.disturbance * std::sin(6 * kTrialPi * time);
  };
  int tick = 0;
  const auto observe = [&](double time, const ArcInput<double, Joints>& input, const auto&) {
    if (tick++ % kThinning == 0) {
      run.time.push_back(time);
      run.error.push_back((input.link - input.wanted).norm());
      if (adaptive != nullptr) {
        JointVector<double, Joints> bound;
        for (Eigen::Index i = 0; i < Joints; ++i) {
          bound[i] = adaptive->link_parameters()(i, 0);
        }
        run.bound.push_back(bound);
      }
    }
  };
  job.settled = 0.8 * trial.duration;
  run.after = track<Joints>(job, controller, observe);
  return run;
}

template <int Joints>
TrialRun<Joints> run_both_halves(const Trial<Joints>& trial, const std::string& name,
                                 const std::function<Controller<Joints>()>& make,
                                 const std::function<const Arc<Joints>*()>& adaptive) {
  const Controller<Joints> controller = make();
  TrialRun<Joints> run = run_with(trial, name, controller, adaptive());
  Trial<Joints> first = trial;
  first.duration = trial.duration / 2;
  first.load = trial.arm.model.payload_mass;
  run.before = run_with(first, name, make(), adaptive()).after;
  return run;
}

}  // namespace

template <int Joints>
std::vector<TrialRun<Joints>> run_trial(const Trial<Joints>& trial) {
  const ArcGains<double, Joints>& gains = trial.design.gains;
  Arc<Joints> controller;
  const auto arc = [&](const ArcGains<double, Joints>& with, bool bounded) {
    return [&trial, &controller, with, bounded]() -> Controller<Joints> {
      controller = configured(trial, with);
      if (bounded) {
        typename Arc<Joints>::LinkParameters link;
        typename Arc<Joints>::MotorParameters motor;
        for (Eigen::Index i = 0; i < Joints; ++i) {
          const auto at = static_cast<std::size_t>(i);
          link.row(i) = trial.design.link[at].typical.transpose();
          motor.row(i) = trial.design.motor[at].typical.transpose();
        }
        controller.set_parameters(link, motor);
      }
      return [&controller](const ArcInput<double, Joints>& input) {
        return controller.tick(input).torque;
      };
    };
  };
  const auto servo = [&] { return pd_controller<Joints>(matching_pd<Joints>(gains)); };
  const auto none = []() -> const Arc<Joints>* { return nullptr; };
  return {run_both_halves<Joints>(trial, "servo (PD)", servo, none),
          run_both_halves<Joints>(
              trial, "servo with feed-forward",
              [&] { return with_feed_forward(trial.nominal, servo()); }, none),
          run_both_halves<Joints>(trial, "virtual control alone", arc(frozen(gains), false), none),
          run_both_halves<Joints>(trial, "robust, fixed bounds", arc(frozen(gains), true), none),
          run_both_halves<Joints>(trial, "adaptive robust", arc(gains, false),
                                  [&]() -> const Arc<Joints>* { return &controller; })};
}

Trial<2> two_link_trial() {
  ArmUncertainty set;
  set.payload = FuzzyNumber::triangular(0, 1, 4);
  set.link_mass = FuzzyNumber::triangular(0.8, 1, 1.3);
  set.stiffness = FuzzyNumber::trapezoidal(0.7, 0.9, 1.05, 1.2);
  set.rotor_inertia = FuzzyNumber::triangular(0.85, 1, 1.15);
  set.viscous = FuzzyNumber::triangular(0.5, 1, 2);
  set.coulomb = FuzzyNumber::triangular(0, 1, 2);
  set.joint_load = FuzzyNumber::triangular(0, 4, 8);
  set.start_error = FuzzyNumber::triangular(-0.005, 0, 0.005);
  Trial<2> trial;
  trial.nominal = simulation::two_link_arm();
  trial.design = design_arc<2>(trial.nominal, set, {1.2, 3, 15}, ArcBandwidth());
  trial.arm = trial.nominal;
  for (std::size_t i = 0; i < 2; ++i) {
    trial.arm.model.joints[i].mass *= 1.15;
    trial.arm.inertia[i] *= 1.15;
    trial.arm.model.joints[i].compliance /= 0.8;
  }
  trial.arm.rotor_inertia *= 1.1;
  trial.arm.viscous *= 1.5;
  trial.arm.coulomb *= 1.5;
  trial.load = 3;
  trial.center << 0.3, -0.4;
  trial.size << 0.5, 0.4;
  trial.frequency = 1.25;
  trial.disturbance << 6, 3;
  return trial;
}

Trial<6> six_axis_trial(const simulation::FlexibleArm<6>& nominal,
                        const ArmUncertainty& uncertainty, const MotionLimits& motion,
                        const ArcDesign<6>& design) {
  std::mt19937_64 random(1);
  Trial<6> trial;
  trial.nominal = nominal;
  trial.design = design;
  trial.arm = draw_arm(nominal, uncertainty, &random).arm;
  trial.arm.model.payload_mass = uncertainty.payload.support().lower;
  trial.load = uncertainty.payload.support().upper;
  trial.center << 0, -1.2, 1.6, 0.2, 0.6, 0;
  trial.frequency = 1.25;
  // The largest speed of a sin³ is 2/√3 times frequency times size.
  trial.size.setConstant(motion.velocity * std::sqrt(3.0) / 2 / trial.frequency);
  return trial;
}

template <int Joints>
std::string error_script(const std::vector<TrialRun<Joints>>& runs, const std::string& title) {
  constexpr const char* kColours[] = {"#d7191c", "#fdae61", "#7b3294", "#1a9641", "#2c7bb6"};
  std::string text;
  std::string plots;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    text += fmt::format("$run{} << EOD\n", i);
    for (std::size_t k = 0; k < runs[i].time.size(); ++k) {
      text += fmt::format("{:.4f} {:.6g}\n", runs[i].time[k], 1e3 * runs[i].error[k]);
    }
    text += "EOD\n";
    plots += fmt::format("{}$run{} with lines lw 1.5 lc rgb '{}' title '{}'", i > 0 ? ", " : "", i,
                         kColours[i % 5], runs[i].controller);
  }
  return text + fmt::format(
                    "set title \"{}\" noenhanced\nset xlabel 'time, s'\nset logscale y\n"
                    "set ylabel 'tracking error of the links, mrad'\n"
                    "set key outside right top vertical\nset grid lc rgb '#dddddd'\nplot {}\n",
                    title, plots);
}

template <int Joints>
std::string bound_script(const TrialRun<Joints>& run, const std::string& title) {
  std::string text = "$bound << EOD\n";
  for (std::size_t k = 0; k < run.bound.size(); ++k) {
    text += fmt::format("{:.4f}", run.time[k]);
    for (Eigen::Index i = 0; i < Joints; ++i) {
      text += fmt::format(" {:.6g}", run.bound[k][i]);
    }
    text += "\n";
  }
  std::string plots;
  for (int i = 0; i < Joints; ++i) {
    plots += fmt::format("{}$bound using 1:{} with lines lw 1.5 title 'joint {}'",
                         i > 0 ? ", " : "", i + 2, i + 1);
  }
  return text + fmt::format(
                    "EOD\nset title \"{}\" noenhanced\nset xlabel 'time, s'\n"
                    "set ylabel 'adapted bound, constant part, N·m'\n"
                    "set key outside right top vertical\nset grid lc rgb '#dddddd'\nplot {}\n",
                    title, plots);
}

template std::vector<TrialRun<2>> run_trial(const Trial<2>&);
template std::string error_script(const std::vector<TrialRun<2>>&, const std::string&);
template std::string bound_script(const TrialRun<2>&, const std::string&);
template std::vector<TrialRun<6>> run_trial(const Trial<6>&);
template std::string error_script(const std::vector<TrialRun<6>>&, const std::string&);
template std::string bound_script(const TrialRun<6>&, const std::string&);

}  // namespace flexcomp::control
