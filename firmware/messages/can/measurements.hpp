#pragma once

#include "messages/can/frame_set.hpp"

/// Measurements of sensors and trackers, on CAN.
namespace flexcomp::can {

template <>
struct Classic<WrenchMessage>
    : FrameSet<DBC_FRAME(WRENCH_FORCE, wrench_force), DBC_FRAME(WRENCH_MOMENT, wrench_moment)> {
  using Authentication = DBC_FRAME(WRENCH_AUTHENTICATION, wrench_authentication);
  using Fx = DBC_SIGNAL(wrench_force, fx, 17);
  using Fy = DBC_SIGNAL(wrench_force, fy, 17);
  using Fz = DBC_SIGNAL(wrench_force, fz, 17);
  using Mx = DBC_SIGNAL(wrench_moment, mx, 17);
  using My = DBC_SIGNAL(wrench_moment, my, 17);
  using Mz = DBC_SIGNAL(wrench_moment, mz, 17);

  static void pack(const WrenchMessage& message, flexcomp_can_wrench_force_t* force,
                   flexcomp_can_wrench_moment_t* moment) {
    force->fx = Fx::raw(message.wrench[0]);
    force->fy = Fy::raw(message.wrench[1]);
    force->fz = Fz::raw(message.wrench[2]);
    force->saturated = message.saturated ? 1 : 0;
    moment->mx = Mx::raw(message.wrench[3]);
    moment->my = My::raw(message.wrench[4]);
    moment->mz = Mz::raw(message.wrench[5]);
    moment->saturated = force->saturated;
  }

  static WrenchMessage unpack(const flexcomp_can_wrench_force_t& force,
                              const flexcomp_can_wrench_moment_t& moment) {
    return {kNoTime,
            {Fx::value(force.fx), Fy::value(force.fy), Fz::value(force.fz), Mx::value(moment.mx),
             My::value(moment.my), Mz::value(moment.mz)},
            (force.saturated | moment.saturated) != 0};
  }
};

template <>
struct Fd<WrenchMessage> : FrameSet<DBC_FRAME(WRENCH_FD, wrench_fd)> {
  using Authentication = DBC_FRAME(WRENCH_FD_AUTHENTICATION, wrench_fd_authentication);

  static void pack(const WrenchMessage& message, flexcomp_can_wrench_fd_t* raw) {
    raw->saturated = message.saturated ? 1 : 0;
    raw->timestamp = to_microseconds(message.timestamp);
    raw->fx = single(message.wrench[0]);
    raw->fy = single(message.wrench[1]);
    raw->fz = single(message.wrench[2]);
    raw->mx = single(message.wrench[3]);
    raw->my = single(message.wrench[4]);
    raw->mz = single(message.wrench[5]);
  }

  static WrenchMessage unpack(const flexcomp_can_wrench_fd_t& raw) {
    return {from_microseconds(raw.timestamp),
            {raw.fx, raw.fy, raw.fz, raw.mx, raw.my, raw.mz},
            raw.saturated != 0};
  }
};

template <>
struct Classic<MeasuredJointsMessage>
    : FrameSet<DBC_FRAME(MEASURED_A, measured_a), DBC_FRAME(MEASURED_B, measured_b),
               DBC_FRAME(MEASURED_C, measured_c)> {
  using Q = JointSignals<DBC_SIGNAL(measured_a, q1, 26), DBC_SIGNAL(measured_a, q2, 26),
                         DBC_SIGNAL(measured_b, q3, 26), DBC_SIGNAL(measured_b, q4, 26),
                         DBC_SIGNAL(measured_c, q5, 26), DBC_SIGNAL(measured_c, q6, 26)>;

  static void pack(const MeasuredJointsMessage& message, flexcomp_can_measured_a_t* a,
                   flexcomp_can_measured_b_t* b, flexcomp_can_measured_c_t* c) {
    Q::pack(message.q, a, b, c);
  }

  static MeasuredJointsMessage unpack(const flexcomp_can_measured_a_t& a,
                                      const flexcomp_can_measured_b_t& b,
                                      const flexcomp_can_measured_c_t& c) {
    return {Q::unpack(a, b, c)};
  }
};

template <>
struct Classic<MeasuredPositionMessage>
    : FrameSet<DBC_FRAME(MEASURED_POSITION_XY, measured_position_xy),
               DBC_FRAME(MEASURED_POSITION_Z, measured_position_z)> {
  using X = DBC_SIGNAL(measured_position_xy, x, 26);
  using Y = DBC_SIGNAL(measured_position_xy, y, 26);
  using Z = DBC_SIGNAL(measured_position_z, z, 26);

  static void pack(const MeasuredPositionMessage& message, flexcomp_can_measured_position_xy_t* xy,
                   flexcomp_can_measured_position_z_t* z) {
    xy->x = X::raw(message.position[0]);
    xy->y = Y::raw(message.position[1]);
    z->z = Z::raw(message.position[2]);
  }

  static MeasuredPositionMessage unpack(const flexcomp_can_measured_position_xy_t& xy,
                                        const flexcomp_can_measured_position_z_t& z) {
    return {{X::value(xy.x), Y::value(xy.y), Z::value(z.z)}};
  }
};

}  // namespace flexcomp::can
