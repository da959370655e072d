#include <new>

#include "c_conversion.hpp"
#include "flexcomp/arc.hpp"

namespace {

using flexcomp::c_api::convert;
using flexcomp::c_api::copy;
using flexcomp::c_api::kJoints;
using flexcomp::c_api::to_c;
using flexcomp::c_api::vector6;
using ArcController = flexcomp::AdaptiveRobustController<float, kJoints>;

static_assert(sizeof(ArcController) <= FLEXCOMP_ARC_BYTES, "room for the object");
static_assert(alignof(ArcController) <= alignof(flexcomp_arc_t), "aligned for the object");

ArcController* object(flexcomp_arc_t* from) {
  return std::launder(reinterpret_cast<ArcController*>(from->bytes));
}

template <int Columns>
Eigen::Matrix<float, kJoints, Columns> rows(const float (&from)[kJoints][Columns]) {
  using RowMajor = Eigen::Matrix<float, kJoints, Columns, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(&from[0][0]);
}

flexcomp::ArcGains<float, kJoints> convert(const flexcomp_arc_gains_t& from) {
  flexcomp::ArcGains<float, kJoints> gains;
  gains.period = from.period;
  gains.rotor_inertia = vector6(from.rotor_inertia);
  gains.viscous = vector6(from.viscous);
  gains.link_rate = vector6(from.link_rate);
  gains.link_damping = from.link_damping;
  gains.motor_rate = vector6(from.motor_rate);
  gains.motor_damping = from.motor_damping;
  gains.motor_stiffness = vector6(from.motor_stiffness);
  gains.filter_frequency = from.filter_frequency;
  gains.leak = from.leak;
  gains.link_adaptation = rows<3>(from.link_adaptation);
  gains.motor_adaptation = rows<4>(from.motor_adaptation);
  gains.link_gain = vector6(from.link_gain);
  gains.motor_gain = vector6(from.motor_gain);
  gains.link_gain_limit = vector6(from.link_gain_limit);
  gains.motor_gain_limit = vector6(from.motor_gain_limit);
  gains.link_bound_limit = vector6(from.link_bound_limit);
  gains.motor_bound_limit = vector6(from.motor_bound_limit);
  gains.torque_limit = vector6(from.torque_limit);
  return gains;
}

}  // namespace

const char* flexcomp_describe_arc_status_bit(uint32_t bit) {
  return flexcomp::describe(static_cast<flexcomp::ArcStatusBit>(bit));
}

flexcomp_result_t flexcomp_arc_init(flexcomp_arc_t* arc, const flexcomp_model_t* model,
                                    const float inertia[FLEXCOMP_JOINTS][9],
                                    const flexcomp_arc_gains_t* gains) {
  if (arc == nullptr || model == nullptr || inertia == nullptr || gains == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::LinkInertia<float, kJoints> links;
  for (std::size_t i = 0; i < kJoints; ++i) {
    links[i] = Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(inertia[i]);
  }
  auto* made = new (arc->bytes) ArcController();
  return to_c(made->configure(convert(*model), links, convert(*gains)));
}

void flexcomp_arc_restart(flexcomp_arc_t* arc) {
  if (arc != nullptr) {
    object(arc)->restart();
  }
}

flexcomp_result_t flexcomp_arc_tick(flexcomp_arc_t* arc, const flexcomp_arc_input_t* input,
                                    flexcomp_arc_output_t* output) {
  if (arc == nullptr || input == nullptr || output == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  const ArcController::Output ticked = object(arc)->tick(
      {vector6(input->link), vector6(input->link_velocity), vector6(input->motor),
       vector6(input->motor_velocity), vector6(input->wanted), vector6(input->wanted_velocity),
       vector6(input->wanted_acceleration), vector6(input->external_torque)});
  copy(ticked.torque, output->torque);
  copy(ticked.link_bound, output->link_bound);
  copy(ticked.motor_bound, output->motor_bound);
  output->status = ticked.status;
  return FLEXCOMP_OK;
}
