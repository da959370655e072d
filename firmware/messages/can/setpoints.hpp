#pragma once

#include "messages/can/frame_set.hpp"

/// Setpoint and corrected setpoint on CAN.
namespace flexcomp::can {

template <>
struct Classic<SetpointMessage>
    : FrameSet<DBC_FRAME(SETPOINT_A, setpoint_a), DBC_FRAME(SETPOINT_B, setpoint_b),
               DBC_FRAME(SETPOINT_C, setpoint_c)> {
  using Authentication = DBC_FRAME(SETPOINT_AUTHENTICATION, setpoint_authentication);
  using Q = JointSignals<DBC_SIGNAL(setpoint_a, q1, 26), DBC_SIGNAL(setpoint_a, q2, 26),
                         DBC_SIGNAL(setpoint_b, q3, 26), DBC_SIGNAL(setpoint_b, q4, 26),
                         DBC_SIGNAL(setpoint_c, q5, 26), DBC_SIGNAL(setpoint_c, q6, 26)>;

  static void pack(const SetpointMessage& message, flexcomp_can_setpoint_a_t* a,
                   flexcomp_can_setpoint_b_t* b, flexcomp_can_setpoint_c_t* c) {
    Q::pack(message.q, a, b, c);
  }

  static SetpointMessage unpack(const flexcomp_can_setpoint_a_t& a,
                                const flexcomp_can_setpoint_b_t& b,
                                const flexcomp_can_setpoint_c_t& c) {
    return {kNoTime, Q::unpack(a, b, c)};
  }
};

template <>
struct Fd<SetpointMessage> : FrameSet<DBC_FRAME(SETPOINT_FD, setpoint_fd)> {
  using Authentication = DBC_FRAME(SETPOINT_FD_AUTHENTICATION, setpoint_fd_authentication);

  static void pack(const SetpointMessage& message, flexcomp_can_setpoint_fd_t* raw) {
    raw->timestamp = to_microseconds(message.timestamp);
    raw->q1 = single(message.q[0]);
    raw->q2 = single(message.q[1]);
    raw->q3 = single(message.q[2]);
    raw->q4 = single(message.q[3]);
    raw->q5 = single(message.q[4]);
    raw->q6 = single(message.q[5]);
  }

  static SetpointMessage unpack(const flexcomp_can_setpoint_fd_t& raw) {
    return {from_microseconds(raw.timestamp), {raw.q1, raw.q2, raw.q3, raw.q4, raw.q5, raw.q6}};
  }
};

template <>
struct Classic<CorrectedMessage>
    : FrameSet<DBC_FRAME(CORRECTED_A, corrected_a), DBC_FRAME(CORRECTED_B, corrected_b),
               DBC_FRAME(CORRECTED_C, corrected_c), DBC_FRAME(UNCORRECTED_A, uncorrected_a),
               DBC_FRAME(UNCORRECTED_B, uncorrected_b), DBC_FRAME(UNCORRECTED_C, uncorrected_c),
               DBC_FRAME(STATUS, status)> {
  using Authentication = DBC_FRAME(CORRECTED_AUTHENTICATION, corrected_authentication);
  using Corrected = JointSignals<DBC_SIGNAL(corrected_a, q1, 26), DBC_SIGNAL(corrected_a, q2, 26),
                                 DBC_SIGNAL(corrected_b, q3, 26), DBC_SIGNAL(corrected_b, q4, 26),
                                 DBC_SIGNAL(corrected_c, q5, 26), DBC_SIGNAL(corrected_c, q6, 26)>;
  using Uncorrected =
      JointSignals<DBC_SIGNAL(uncorrected_a, q1, 26), DBC_SIGNAL(uncorrected_a, q2, 26),
                   DBC_SIGNAL(uncorrected_b, q3, 26), DBC_SIGNAL(uncorrected_b, q4, 26),
                   DBC_SIGNAL(uncorrected_c, q5, 26), DBC_SIGNAL(uncorrected_c, q6, 26)>;

  static void pack(const CorrectedMessage& message, flexcomp_can_corrected_a_t* corrected_a,
                   flexcomp_can_corrected_b_t* corrected_b, flexcomp_can_corrected_c_t* corrected_c,
                   flexcomp_can_uncorrected_a_t* uncorrected_a,
                   flexcomp_can_uncorrected_b_t* uncorrected_b,
                   flexcomp_can_uncorrected_c_t* uncorrected_c, flexcomp_can_status_t* status) {
    Corrected::pack(message.corrected, corrected_a, corrected_b, corrected_c);
    Uncorrected::pack(message.uncorrected, uncorrected_a, uncorrected_b, uncorrected_c);
    status->status = message.status;
    status->node_status = message.node_status;
    status->state = message.state;
  }

  static CorrectedMessage unpack(const flexcomp_can_corrected_a_t& corrected_a,
                                 const flexcomp_can_corrected_b_t& corrected_b,
                                 const flexcomp_can_corrected_c_t& corrected_c,
                                 const flexcomp_can_uncorrected_a_t& uncorrected_a,
                                 const flexcomp_can_uncorrected_b_t& uncorrected_b,
                                 const flexcomp_can_uncorrected_c_t& uncorrected_c,
                                 const flexcomp_can_status_t& status) {
    return {kNoTime,
            Corrected::unpack(corrected_a, corrected_b, corrected_c),
            Uncorrected::unpack(uncorrected_a, uncorrected_b, uncorrected_c),
            status.status,
            status.node_status,
            status.state};
  }
};

template <>
struct Fd<CorrectedMessage> : FrameSet<DBC_FRAME(CORRECTED_FD, corrected_fd)> {
  using Authentication = DBC_FRAME(CORRECTED_FD_AUTHENTICATION, corrected_fd_authentication);

  static void pack(const CorrectedMessage& message, flexcomp_can_corrected_fd_t* raw) {
    raw->state = message.state;
    raw->timestamp = to_microseconds(message.timestamp);
    raw->q1 = single(message.corrected[0]);
    raw->q2 = single(message.corrected[1]);
    raw->q3 = single(message.corrected[2]);
    raw->q4 = single(message.corrected[3]);
    raw->q5 = single(message.corrected[4]);
    raw->q6 = single(message.corrected[5]);
    raw->uncorrected1 = single(message.uncorrected[0]);
    raw->uncorrected2 = single(message.uncorrected[1]);
    raw->uncorrected3 = single(message.uncorrected[2]);
    raw->uncorrected4 = single(message.uncorrected[3]);
    raw->uncorrected5 = single(message.uncorrected[4]);
    raw->uncorrected6 = single(message.uncorrected[5]);
    raw->status = message.status;
    raw->node_status = message.node_status;
  }

  static CorrectedMessage unpack(const flexcomp_can_corrected_fd_t& raw) {
    return {from_microseconds(raw.timestamp),
            {raw.q1, raw.q2, raw.q3, raw.q4, raw.q5, raw.q6},
            {raw.uncorrected1, raw.uncorrected2, raw.uncorrected3, raw.uncorrected4,
             raw.uncorrected5, raw.uncorrected6},
            raw.status,
            raw.node_status,
            raw.state};
  }
};

}  // namespace flexcomp::can
