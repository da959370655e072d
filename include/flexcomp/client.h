#ifndef FLEXCOMP_CLIENT_H
#define FLEXCOMP_CLIENT_H

/// @file
/// A robot controller's side of the CAN bus for C: makes the frames that a compensator wants to
/// hear, reads its answers, and holds and fades the correction by itself when they cease.
///
/// The caller moves the frames: this needs no socket, no clock and no driver. The calls in their
/// order, all from one thread:
///
///     at start
///       flexcomp_client_init
///     in the first ten periods, then every 0.2 s or so
///       flexcomp_client_identity    a compensator that starts anew must hear whose robot this is
///     every period
///       flexcomp_client_wrench      only where the controller has the sensor; before the setpoint
///       flexcomp_client_setpoint    makes the tick
///       flexcomp_client_receive     each frame that has come, also between
///       flexcomp_client_end_period  gives what to send to the drives
///     once
///       flexcomp_client_command     arm, after some good cycles; FLEXCOMP_CLIENT_REPLY tells
///
/// A lost answer holds the last correction. Answers that stay away for the hold time fade it to
/// zero, where it stays until the compensator has been off and is armed again. A compensator that
/// is suddenly off has been started anew, and is faded out in the same way.
///
/// Messages that are authenticated with a key are not made here. No call allocates, blocks or does
/// I/O; nothing is kept outside the objects. firmware/client/README.md in the sources has a whole
/// program and the numbers of the protocol.

#include "flexcomp/flexcomp.h"

#ifdef __cplusplus
extern "C" {
#endif

/// When to hold and when to fade.
typedef struct flexcomp_follower_config {
  double period;     ///< s, from one end of a period to the next; above 0
  double hold_time;  ///< s, that answers may stay away before it fades; 0 or more
  double fade_time;  ///< s, from the whole correction to none; above 0
} flexcomp_follower_config_t;

/// Bytes of a follower.
#define FLEXCOMP_FOLLOWER_BYTES 192
/// The correction that a robot moves by, for callers with a transport of their own (LCM, say).
/// Static or on a stack the compiler aligns it; other memory must start at a multiple of 64 bytes,
/// which malloc does not promise (`aligned_alloc` of C11 does). Do not touch the member.
typedef struct flexcomp_follower {
#ifdef __cplusplus
  alignas(64) unsigned char bytes[FLEXCOMP_FOLLOWER_BYTES];  ///< opaque
#else
  _Alignas(64) unsigned char bytes[FLEXCOMP_FOLLOWER_BYTES];  ///< opaque
#endif
} flexcomp_follower_t;

/// Begins without a correction. FLEXCOMP_OK, BAD_ARGUMENT, or BAD_CONFIG for a time that is not
/// finite or out of range; the follower must not be used then.
flexcomp_result_t flexcomp_follower_init(flexcomp_follower_t* follower,
                                         const flexcomp_follower_config_t* config);

/// Takes an answer: corrected less uncorrected setpoint (rad), and whether the compensator is off
/// or latched. One that is not finite is no answer.
void flexcomp_follower_take(flexcomp_follower_t* follower, const double correction[FLEXCOMP_JOINTS],
                            bool off);

/// Ends a period, and gives the correction (rad) that the robot moves by in the next one.
void flexcomp_follower_end_period(flexcomp_follower_t* follower,
                                  double correction[FLEXCOMP_JOINTS]);

/// Did answers cease, so that the correction fades or has faded, and stays at zero until the
/// compensator has been off?
bool flexcomp_follower_is_lost(const flexcomp_follower_t* follower);

/// A CAN frame with an identifier of 11 bits.
typedef struct flexcomp_can_frame {
  uint32_t id;       ///< identifier
  uint8_t size;      ///< bytes of data: 8 or fewer, FD up to 64
  bool fd;           ///< an FD frame; to be sent with the faster bit rate where there is one
  uint8_t data[64];  ///< `size` of them
} flexcomp_can_frame_t;

/// The frames of one message, to be sent in their order.
typedef struct flexcomp_frames {
  size_t count;                   ///< 1 to 3
  flexcomp_can_frame_t frame[3];  ///< `count` of them
} flexcomp_frames_t;

/// Settings that a client is made with.
typedef struct flexcomp_client_config {
  bool fd;              ///< send FD frames where a message has one; both kinds are understood
  uint64_t model_hash;  ///< fingerprint of the robot, as in node.toml (flexcomp configure)
  flexcomp_follower_config_t follower;  ///< what to do where answers cease
} flexcomp_client_config_t;

/// Bytes of a client.
#define FLEXCOMP_CLIENT_BYTES 6144
/// Room for a client, static or on a stack; other memory as for a follower. Do not touch the
/// member.
typedef struct flexcomp_client {
#ifdef __cplusplus
  alignas(64) unsigned char bytes[FLEXCOMP_CLIENT_BYTES];  ///< opaque
#else
  _Alignas(64) unsigned char bytes[FLEXCOMP_CLIENT_BYTES];    ///< opaque
#endif
} flexcomp_client_t;

/// Begins with no answer and no correction. FLEXCOMP_OK, or BAD_ARGUMENT or BAD_CONFIG, as
/// flexcomp_follower_init; the client must not be used then.
flexcomp_result_t flexcomp_client_init(flexcomp_client_t* client,
                                       const flexcomp_client_config_t* config);

/// Makes the message that names the robot, and the base frame as the wrench's. FLEXCOMP_OK or
/// BAD_ARGUMENT.
flexcomp_result_t flexcomp_client_identity(flexcomp_client_t* client, flexcomp_frames_t* frames);

/// Makes the message of a wrench on the tool at the TCP, base frame (N, N·m). `saturated`: the
/// sensor is at the end of its range. `now`: ns, of a clock that only grows; FD frames carry it.
/// A number that is not finite travels as "not available". FLEXCOMP_OK or BAD_ARGUMENT.
flexcomp_result_t flexcomp_client_wrench(flexcomp_client_t* client, const double wrench[6],
                                         bool saturated, int64_t now, flexcomp_frames_t* frames);

/// Makes the message of an uncorrected setpoint (rad). As above.
flexcomp_result_t flexcomp_client_setpoint(flexcomp_client_t* client,
                                           const double setpoint[FLEXCOMP_JOINTS], int64_t now,
                                           flexcomp_frames_t* frames);

/// Commands to a compensator. Stable numbers.
typedef enum flexcomp_command {
  FLEXCOMP_COMMAND_NONE = 0,
  FLEXCOMP_COMMAND_ARM = 1,
  FLEXCOMP_COMMAND_DISARM = 2,
  FLEXCOMP_COMMAND_RESET = 3,
  FLEXCOMP_COMMAND_REPORT = 4  ///< send the statistics
} flexcomp_command_t;

/// Makes the message of a command. FLEXCOMP_OK, or BAD_ARGUMENT also for none or another.
flexcomp_result_t flexcomp_client_command(flexcomp_client_t* client, flexcomp_command_t command,
                                          flexcomp_frames_t* frames);

/// Outcome of a received frame.
typedef enum flexcomp_client_event {
  FLEXCOMP_CLIENT_NOTHING = 0,    ///< part of a message, damaged, repeated, or not for a client
  FLEXCOMP_CLIENT_ANSWER = 1,     ///< flexcomp_client_answer has it
  FLEXCOMP_CLIENT_REPLY = 2,      ///< flexcomp_client_reply has it
  FLEXCOMP_CLIENT_HEARTBEAT = 3,  ///< the compensator is there
  FLEXCOMP_CLIENT_FAULT = 4       ///< flexcomp_client_fault has it
} flexcomp_client_event_t;

/// Takes a frame from the bus; `now` as above. Whatever it holds: a frame that is too long, damaged
/// or of somebody else is FLEXCOMP_CLIENT_NOTHING, and so are null pointers.
flexcomp_client_event_t flexcomp_client_receive(flexcomp_client_t* client,
                                                const flexcomp_can_frame_t* frame, int64_t now);

/// Result of a tick of the compensator.
typedef struct flexcomp_answer {
  double corrected[FLEXCOMP_JOINTS];    ///< rad; NaN where it had none
  double uncorrected[FLEXCOMP_JOINTS];  ///< rad, the setpoint that it answers
  uint32_t status;                      ///< bits as in flexcomp.h
  uint16_t node_status;                 ///< bits of the node: firmware/README.md, Faults
  flexcomp_state_t state;               ///< after the tick
} flexcomp_answer_t;

/// The last answer; zero before the first. FLEXCOMP_OK or BAD_ARGUMENT.
flexcomp_result_t flexcomp_client_answer(const flexcomp_client_t* client,
                                         flexcomp_answer_t* answer);

/// Reply to a command.
typedef struct flexcomp_command_reply {
  flexcomp_command_t command;  ///< that it replies to
  uint8_t reply;               ///< 0: done; else flexcomp_describe_reply says why not
  double largest_gain;         ///< of the table in use or refused
} flexcomp_command_reply_t;

/// The last reply; zero before the first. FLEXCOMP_OK or BAD_ARGUMENT.
flexcomp_result_t flexcomp_client_reply(const flexcomp_client_t* client,
                                        flexcomp_command_reply_t* reply);

/// A fault that began or ended, or another event.
typedef struct flexcomp_fault {
  uint16_t code;    ///< firmware/README.md, Faults
  bool active;      ///< it began, or it ended
  uint32_t detail;  ///< depends on the code
} flexcomp_fault_t;

/// The last fault; zero before the first. FLEXCOMP_OK or BAD_ARGUMENT.
flexcomp_result_t flexcomp_client_fault(const flexcomp_client_t* client, flexcomp_fault_t* fault);

/// Ends a period: `drives` is `setpoint` (rad) with the correction that holds from now on. It is
/// finite, and moves by no more than the answers and the fade do. FLEXCOMP_OK, or BAD_ARGUMENT for
/// a null pointer or a setpoint that is not finite, with `drives` untouched; the period has ended
/// all the same.
flexcomp_result_t flexcomp_client_end_period(flexcomp_client_t* client,
                                             const double setpoint[FLEXCOMP_JOINTS],
                                             double drives[FLEXCOMP_JOINTS]);

/// Did answers cease? As flexcomp_follower_is_lost.
bool flexcomp_client_is_lost(const flexcomp_client_t* client);

/// A few words for a person on the reply to a command; never null.
const char* flexcomp_describe_reply(uint8_t reply);
/// A few words for a person on one bit of a node's status; never null.
const char* flexcomp_describe_node_bit(uint16_t bit);

#ifdef __cplusplus
}
#endif

#endif  // FLEXCOMP_CLIENT_H
