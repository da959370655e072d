#include <cstring>
#include <new>

#include "c_conversion.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/flexcomp.h"
#include "flexcomp/path_index.hpp"
#include "flexcomp/table_builder.hpp"

namespace {

using flexcomp::c_api::kJoints;
using Angles = flexcomp::JointVector<float, kJoints>;
using flexcomp::c_api::Model;
using Compensator = flexcomp::Compensator<float, kJoints>;

static_assert(sizeof(Compensator) <= FLEXCOMP_COMPENSATOR_BYTES, "room for the object");
static_assert(alignof(Compensator) <= alignof(flexcomp_compensator_t), "aligned for the object");

using flexcomp::c_api::convert;
using flexcomp::c_api::copy;
using flexcomp::c_api::to_c;
using flexcomp::c_api::vector6;

flexcomp::CompensatorConfig<float, kJoints> convert(const flexcomp_config_t& from) {
  flexcomp::CompensatorConfig<float, kJoints> config;
  config.period = from.period;
  config.model_hash = from.model_hash;
  config.gain = from.gain;
  config.filter_cutoff = from.filter_cutoff;
  config.force_range = from.force_range;
  config.moment_range = from.moment_range;
  config.setpoint_age_limit = from.setpoint_age_limit;
  config.wrench_age_limit = from.wrench_age_limit;
  config.joint_speed = Eigen::Map<const Angles>(from.joint_speed);
  for (std::size_t i = 0; i < kJoints; ++i) {
    const flexcomp_limits_t& limits = from.limits[i];
    config.limits[i] = {limits.value, limits.rate, limits.acceleration};
  }
  config.deflection_limit = from.deflection_limit;
  config.chart_margin = from.chart_margin;
  config.hold_time = from.hold_time;
  config.fade_time = from.fade_time;
  config.ready_ticks = from.ready_ticks;
  return config;
}

flexcomp::TableRequirements<float> convert(const flexcomp_table_requirements_t& from) {
  return {from.force_bound, from.moment_bound, from.position_tolerance, from.orientation_tolerance,
          from.largest_gain};
}

/// The C view tells where a table that was checked begins and ends. Not open if its fields no
/// longer fit in between.
flexcomp::Result view(const flexcomp_table_t& from, flexcomp::Table* table) {
  if (from.header == nullptr) {
    return flexcomp::Result::no_table;
  }
  const auto* begin = static_cast<const unsigned char*>(from.header);
  const auto* end = static_cast<const unsigned char*>(from.end);
  const flexcomp::Result result =
      flexcomp::Table::reopen(begin, static_cast<std::size_t>(end - begin), table);
  if (result == flexcomp::Result::ok) {
    table->use_index(static_cast<const flexcomp::IndexNode*>(from.index));
  }
  return result;
}

Compensator* object(flexcomp_compensator_t* from) {
  return std::launder(reinterpret_cast<Compensator*>(from->bytes));
}

}  // namespace

const char* flexcomp_describe_result(flexcomp_result_t result) {
  return flexcomp::describe(static_cast<flexcomp::Result>(result));
}

const char* flexcomp_describe_state(flexcomp_state_t state) {
  return flexcomp::describe(static_cast<flexcomp::State>(state));
}

const char* flexcomp_describe_status_bit(uint32_t bit) {
  return flexcomp::describe(static_cast<flexcomp::StatusBit>(bit));
}

const char* flexcomp_version(void) { return FLEXCOMP_VERSION; }

flexcomp_result_t flexcomp_model_validate(const flexcomp_model_t* model) {
  return model == nullptr ? FLEXCOMP_BAD_ARGUMENT : to_c(flexcomp::validate(convert(*model)));
}

const char* flexcomp_model_unusable_member(const flexcomp_model_t* model, size_t* joint) {
  const flexcomp::UnusableMember member = model == nullptr
                                              ? flexcomp::UnusableMember{nullptr, FLEXCOMP_JOINTS}
                                              : flexcomp::unusable_member(convert(*model));
  if (joint != nullptr) {
    *joint = member.joint;
  }
  return member.name;
}

uint64_t flexcomp_model_hash(const flexcomp_model_t* model) {
  return model == nullptr ? 0 : flexcomp::model_hash(convert(*model));
}

flexcomp_result_t flexcomp_model_evaluate(const flexcomp_model_t* model,
                                          const float q[FLEXCOMP_JOINTS], flexcomp_pose_t* tcp,
                                          float compliance[36]) {
  if (model == nullptr || q == nullptr || !vector6(q).allFinite()) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  const Model robot = convert(*model);
  const auto kinematics = flexcomp::forward_kinematics<float, kJoints>(robot, vector6(q));
  flexcomp::Compliance<float> computed = flexcomp::Compliance<float>::Zero();
  if (compliance != nullptr) {
    computed = flexcomp::tcp_compliance(robot, kinematics);
  }
  if (!kinematics.tcp.rotation.allFinite() || !kinematics.tcp.position.allFinite() ||
      !computed.allFinite()) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  if (tcp != nullptr) {
    copy(kinematics.tcp.rotation, tcp->rotation);
    copy(kinematics.tcp.position, tcp->position);
  }
  if (compliance != nullptr) {
    copy(computed, compliance);
  }
  return FLEXCOMP_OK;
}

flexcomp_result_t flexcomp_model_respond(const flexcomp_model_t* model,
                                         const float q[FLEXCOMP_JOINTS], const float wrench[6],
                                         float deflection[6], float correction[FLEXCOMP_JOINTS]) {
  if (model == nullptr || q == nullptr || wrench == nullptr || !vector6(q).allFinite() ||
      !vector6(wrench).allFinite()) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  const Model robot = convert(*model);
  flexcomp::Twist<float> bent = flexcomp::Twist<float>::Zero();
  Angles against = Angles::Zero();
  if (deflection != nullptr) {
    bent = flexcomp::deflection<float, kJoints>(robot, vector6(q), vector6(wrench)).tcp;
  }
  if (correction != nullptr) {
    against = flexcomp::setpoint_correction<float, kJoints>(robot, vector6(q), vector6(wrench));
  }
  if (!bent.allFinite() || !against.allFinite()) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  if (deflection != nullptr) {
    copy(bent, deflection);
  }
  if (correction != nullptr) {
    copy(against, correction);
  }
  return FLEXCOMP_OK;
}

flexcomp_result_t flexcomp_table_build_path(const flexcomp_model_t* model, const float* points,
                                            size_t count,
                                            const flexcomp_table_requirements_t* requirements,
                                            void* buffer, size_t capacity, size_t* size) {
  static_assert(sizeof(Angles) == kJoints * sizeof(float), "points lie as an array of vectors");
  if (model == nullptr || points == nullptr || requirements == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  return to_c(flexcomp::build_path_table<float, kJoints>(
      convert(*model), reinterpret_cast<const Angles*>(points), count, convert(*requirements),
      buffer, capacity, size));
}

flexcomp_result_t flexcomp_table_build_grid(const flexcomp_model_t* model, const float lower[4],
                                            const float upper[4],
                                            const flexcomp_table_requirements_t* requirements,
                                            void* buffer, size_t capacity, size_t* size) {
  if (model == nullptr || lower == nullptr || upper == nullptr || requirements == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  const flexcomp::GridRange<float> ranges[4] = {
      {lower[0], upper[0]}, {lower[1], upper[1]}, {lower[2], upper[2]}, {lower[3], upper[3]}};
  return to_c(flexcomp::build_grid_table<float, kJoints>(
      convert(*model), ranges, convert(*requirements), buffer, capacity, size));
}

flexcomp_result_t flexcomp_table_size(const void* data, size_t available, size_t* size) {
  return to_c(flexcomp::Table::find_size(data, available, size));
}

flexcomp_result_t flexcomp_table_open(const void* data, size_t size, flexcomp_table_t* table) {
  flexcomp::Table opened;
  const flexcomp::Result result = table == nullptr ? flexcomp::Result::bad_argument
                                                   : flexcomp::Table::open(data, size, &opened);
  if (result == flexcomp::Result::ok) {
    *table = {data, static_cast<const unsigned char*>(data) + size, nullptr};
  }
  return to_c(result);
}

size_t flexcomp_table_index_size(const flexcomp_table_t* table) {
  flexcomp::Table opened;
  const bool is_open = table != nullptr && view(*table, &opened) == flexcomp::Result::ok;
  return is_open ? flexcomp::path_index_size(opened) : 0;
}

flexcomp_result_t flexcomp_table_index(flexcomp_table_t* table, void* memory, size_t capacity) {
  if (table == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::Table opened;
  flexcomp::Result result = view(*table, &opened);
  if (result == flexcomp::Result::ok) {
    result = flexcomp::index_path(memory, capacity, &opened);
  }
  if (result == flexcomp::Result::ok) {
    table->index = opened.index();
  }
  return to_c(result);
}

flexcomp_result_t flexcomp_table_check_model(const flexcomp_table_t* table,
                                             const flexcomp_model_t* model) {
  if (table == nullptr || model == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::Table opened;
  const flexcomp::Result result = view(*table, &opened);
  return to_c(result == flexcomp::Result::ok
                  ? flexcomp::check_against_model<float, kJoints>(convert(*model), opened)
                  : result);
}

flexcomp_result_t flexcomp_table_describe(const flexcomp_table_t* table,
                                          flexcomp_table_info_t* info) {
  if (table == nullptr || info == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::Table opened;
  const flexcomp::Result result = view(*table, &opened);
  if (result != flexcomp::Result::ok) {
    return to_c(result);
  }
  const flexcomp::TableHeader& header = opened.header();
  *info = {opened.model_hash(),   opened.chart() == flexcomp::Chart::path,
           header.node_count,     header.size,
           header.force_bound,    header.moment_bound,
           header.position_error, header.orientation_error,
           header.largest_gain};
  return FLEXCOMP_OK;
}

const char* flexcomp_config_unusable_member(const flexcomp_config_t* config) {
  return config == nullptr ? nullptr : flexcomp::unusable_member(convert(*config));
}

flexcomp_result_t flexcomp_compensator_init(flexcomp_compensator_t* compensator,
                                            const flexcomp_config_t* config) {
  if (compensator == nullptr || config == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  auto* made = new (compensator->bytes) Compensator();
  return to_c(made->configure(convert(*config)));
}

flexcomp_result_t flexcomp_compensator_set_table(flexcomp_compensator_t* compensator,
                                                 const flexcomp_table_t* table) {
  if (compensator == nullptr || table == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  flexcomp::Table opened;
  const flexcomp::Result result = view(*table, &opened);
  return to_c(result == flexcomp::Result::ok ? object(compensator)->set_table(opened) : result);
}

flexcomp_result_t flexcomp_compensator_arm(flexcomp_compensator_t* compensator) {
  return compensator == nullptr ? FLEXCOMP_BAD_ARGUMENT : to_c(object(compensator)->arm());
}

void flexcomp_compensator_disarm(flexcomp_compensator_t* compensator) {
  if (compensator != nullptr) {
    object(compensator)->disarm();
  }
}

flexcomp_result_t flexcomp_compensator_reset(flexcomp_compensator_t* compensator) {
  return compensator == nullptr ? FLEXCOMP_BAD_ARGUMENT : to_c(object(compensator)->reset());
}

flexcomp_result_t flexcomp_compensator_tick(flexcomp_compensator_t* compensator,
                                            const flexcomp_input_t* input,
                                            flexcomp_output_t* output) {
  if (compensator == nullptr || input == nullptr || output == nullptr) {
    return FLEXCOMP_BAD_ARGUMENT;
  }
  const Compensator::Output ticked = object(compensator)
                                         ->tick({
                                             vector6(input->setpoint),
                                             input->setpoint_age,
                                             vector6(input->wrench),
                                             input->wrench_age,
                                             input->external_fault,
                                         });
  copy(ticked.setpoint, output->setpoint);
  copy(ticked.correction, output->correction);
  copy(ticked.deflection, output->deflection);
  output->status = ticked.status;
  output->latched_faults = ticked.latched_faults;
  output->state = static_cast<flexcomp_state_t>(ticked.state);
  return object(compensator)->is_configured() ? FLEXCOMP_OK : FLEXCOMP_BAD_CONFIG;
}
