#pragma once

/// @file
/// The joints' own control: adaptive robust control of flexible joints.

#include <Eigen/Core>
#include <cstdint>

#include "flexcomp/inverse_dynamics.hpp"

namespace flexcomp {

/// Bits of the status word of the adaptive robust controller. The lower half refuse the tick: the
/// state stays as it is and the torque is the last one, zero before the first and after a restart.
/// The upper half are remarks. The numbers are
/// stable.
enum ArcStatusBit : std::uint32_t {
  kArcInputNotFinite = 1U << 0,  ///< a number of the input is NaN or infinite
  kArcNotComputable = 1U << 1,   ///< finite input, but so large that the result is not
  kArcNotConfigured = 1U << 2,   ///< there is no accepted configuration: the torque is zero
  kArcTorqueLimited = 1U << 16,  ///< a joint asks for more than its torque limit
  kArcBoundLimited = 1U << 17,   ///< a bound is near its limit: it adapts less, or no more
};

/// The bits that refuse a tick.
constexpr std::uint32_t kArcRefusedBits = 0xFFFFU;

/// A few words for a person on one status bit; never null.
const char* describe(ArcStatusBit bit);

/// The gains. Diagonal matrices are one number a joint; torques and inertias are those on the
/// joint side of the gear. `flexcomp design-arc` makes all of them.
template <typename Scalar, int Joints>
struct ArcGains {
  using Angles = JointVector<Scalar, Joints>;  ///< one number a joint

  Scalar period = 0;                      ///< s, from one tick to the next
  Angles rotor_inertia = Angles::Zero();  ///< kg·m², J₀
  Angles viscous = Angles::Zero();        ///< N·m·s/rad, F₀
  Angles link_rate =
      Angles::Zero();  ///< 1/s, S₁: how fast the tracking error decays on the surface s₁ = 0
  Scalar link_damping = 0;                  ///< 1/s, k_v: how fast s₁ decays
  Angles motor_rate = Angles::Zero();       ///< 1/s, S₂
  Scalar motor_damping = 0;                 ///< 1/s, k₂
  Angles motor_stiffness = Angles::Zero();  ///< N·m/rad, K_p2
  Scalar filter_frequency = 0;  ///< rad/s, ω_f of the filter on the wanted elastic torque
  Scalar leak = 0;              ///< 1/s, ω_l, at which adapted parameters are forgotten
  Eigen::Matrix<Scalar, Joints, 3> link_adaptation =
      Eigen::Matrix<Scalar, Joints, 3>::Zero();  ///< Γ₁, squared units of α₁ by J
  Eigen::Matrix<Scalar, Joints, 4> motor_adaptation =
      Eigen::Matrix<Scalar, Joints, 4>::Zero();  ///< Γ₂
  Angles link_gain = Angles::Zero();             ///< 1/W, γ₁
  Angles motor_gain = Angles::Zero();            ///< 1/W, γ₂
  Angles link_gain_limit = Angles::Zero();  ///< N·m·s/rad, largest slope of the link's robust term
  Angles motor_gain_limit = Angles::Zero();  ///< N·m·s/rad
  Angles link_bound_limit = Angles::Zero();  ///< N·m, largest bound ρ₁ that adaptation may reach
  Angles motor_bound_limit = Angles::Zero();  ///< N·m
  Angles torque_limit = Angles::Zero();       ///< N·m
};

/// Input of one tick.
template <typename Scalar, int Joints>
struct ArcInput {
  using Angles = JointVector<Scalar, Joints>;  ///< one number a joint

  Angles link = Angles::Zero();             ///< rad, q₁, link side of the springs
  Angles link_velocity = Angles::Zero();    ///< rad/s
  Angles motor = Angles::Zero();            ///< rad, q₂, motor side, reflected through the gear
  Angles motor_velocity = Angles::Zero();   ///< rad/s
  Angles wanted = Angles::Zero();           ///< rad, q_d
  Angles wanted_velocity = Angles::Zero();  ///< rad/s
  Angles wanted_acceleration = Angles::Zero();  ///< rad/s²
  /// N·m, of the measured wrench on the tool about the joints, Jᵀ·wrench; zero where not measured.
  /// A compensator beside it corrects only what bends beyond the link encoders.
  Angles external_torque = Angles::Zero();
};

/// Result of one tick.
template <typename Scalar, int Joints>
struct ArcOutput {
  using Angles = JointVector<Scalar, Joints>;  ///< one number a joint

  Angles torque =
      Angles::Zero();  ///< N·m, of the motors, joint side; always finite, within the limit
  Angles link_surface = Angles::Zero();   ///< rad/s, s₁
  Angles motor_surface = Angles::Zero();  ///< rad/s, s₂
  Angles motor_error = Angles::Zero();    ///< rad, x₃: motor angle less the virtual control's
  Angles wanted_elastic_torque = Angles::Zero();  ///< N·m, w*, before the filter
  Angles link_bound = Angles::Zero();             ///< N·m, ρ̂₁ in use
  Angles motor_bound = Angles::Zero();            ///< N·m, ρ̂₂
  std::uint32_t status = 0;                       ///< bits of this tick
};

/// Adaptive robust control of an arm with flexible joints by a virtual control implanted between
/// link and motor (after Dong, Han and Xia 2017; the law here is worked out in
/// host/control/README.md).
///
/// Model: D q₁'' + C q₁' + G + K (q₁ − q₂) = τ_ext,  J q₂'' + F q₂' − K (q₁ − q₂) = u + τ_d;
/// masses, K, J, F, τ_ext and τ_d are uncertain. The link side chooses an elastic torque w* =
/// feed-forward + robust term, a filter makes it twice differentiable, and the motor follows q_d +
/// K₀⁻¹ w. Each side's robust term works against a bound that grows with what the arm does and
/// whose parameters α̂ adapt with leakage.
///
/// Every tick takes the same time and uses no memory but the object. Whatever the input, the
/// torque is finite and within `torque_limit`, and the state finite. Not a safety function: whoever
/// calls it has to brake when ticks are refused for longer than the arm can bear.
template <typename Scalar, int Joints>
class AdaptiveRobustController {
 public:
  using Gains = ArcGains<Scalar, Joints>;                    ///< made by flexcomp design-arc
  using Input = ArcInput<Scalar, Joints>;                    ///< one for each tick
  using Output = ArcOutput<Scalar, Joints>;                  ///< one for each tick
  using Angles = JointVector<Scalar, Joints>;                ///< one number a joint
  using LinkParameters = Eigen::Matrix<Scalar, Joints, 3>;   ///< α₁, a row a joint
  using MotorParameters = Eigen::Matrix<Scalar, Joints, 4>;  ///< α₂

  /// Takes the nominal robot (its joint compliances are K₀⁻¹) and the gains, and starts anew.
  /// Returns ok; bad_model as `InverseDynamics::configure`, or for a compliance that is not above
  /// zero; bad_config for a gain that is not finite and positive (`viscous` may be zero), or gains
  /// too fast for the period: ω_f·T above 1, or (k₂ + motor gain limit/J₀)·T above 0.5. Then no
  /// tick is computed until a configuration is accepted.
  Result configure(const RobotModel<Scalar, Joints>& model,
                   const LinkInertia<Scalar, Joints>& inertia, const Gains& gains);

  /// Forgets what was adapted and the last torque, which may be of long ago; the next tick starts
  /// the filter where it finds the arm.
  void restart();

  /// Begins with these parameters instead of none: what was adapted before, or bounds that are
  /// known. Returns ok, or bad_argument for one that is not finite or below zero.
  Result set_parameters(const LinkParameters& link, const MotorParameters& motor);

  /// One control period. Begin with `wanted` at the link's angle: a jump asks for torque at once.
  Output tick(const Input& input);

  const LinkParameters& link_parameters() const { return state_.link; }     ///< α̂₁
  const MotorParameters& motor_parameters() const { return state_.motor; }  ///< α̂₂

 private:
  struct State {
    Angles elastic_torque = Angles::Zero();  ///< N·m, w
    Angles elastic_rate = Angles::Zero();    ///< N·m/s, w'
    LinkParameters link = LinkParameters::Zero();
    MotorParameters motor = MotorParameters::Zero();
    bool is_running = false;
  };

  void track(const Input& input, State* next, Output* output) const;
  void drive(const Input& input, Eigen::Index joint, const Vector3<Scalar>& regressor, State* next,
             Output* output) const;
  void advance_filter(Eigen::Index joint, Scalar wanted, State* next) const;

  InverseDynamics<Scalar, Joints> dynamics_;
  Gains gains_{};
  Angles compliance_ = Angles::Zero();  ///< rad/(N·m), K₀⁻¹
  Angles stiffness_ = Angles::Zero();   ///< N·m/rad, K₀
  Scalar kept_ = 0;                     ///< share of α̂ that is left after a period
  Scalar decay_ = 0;                    ///< e^(−ω_f T)
  State state_{};
  Angles torque_ = Angles::Zero();  ///< of the last good tick
  bool is_configured_ = false;
};

}  // namespace flexcomp
