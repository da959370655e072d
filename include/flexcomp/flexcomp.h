#ifndef FLEXCOMP_H
#define FLEXCOMP_H

/// @file
/// flexcomp for C: the real-time core in single precision for six joints.
///
/// A robot bends under a force on its tool. In every control period the core takes the joint
/// setpoint and the measured wrench, and returns the setpoint that puts the bent robot's tool where
/// a stiff robot would have it.
///
/// The calls in their order, and the thread that makes them:
///
///     at start (any thread)
///       flexcomp_table_size            how long the table is, where what holds it is longer
///       flexcomp_table_open            check a table where it lies (flash, or a buffer you keep)
///       flexcomp_table_check_model     with the model at hand: does it say the same of the robot?
///       flexcomp_compensator_init      period, limits, ranges, the robot's fingerprint; only while
///                                      nothing is corrected, because it begins anew
///       flexcomp_compensator_set_table
///     every period (the control thread)
///       flexcomp_compensator_tick      send output.setpoint to the drives, in every state
///     between two ticks (the control thread)
///       flexcomp_compensator_arm       FLEXCOMP_NOT_READY until ready_ticks good inputs in a row
///       flexcomp_compensator_set_table another table, also while correcting
///       flexcomp_compensator_disarm    then tick on until the state is FLEXCOMP_STATE_OFF
///       flexcomp_compensator_reset     after a fault: from latched to off, then arm again
///     on a PC or in a slow thread
///       flexcomp_table_build_path, flexcomp_table_build_grid, flexcomp_model_evaluate
///
/// A bad input holds the correction; if it lasts, the correction fades to zero and is latched. It
/// never jumps, unless flexcomp_compensator_init is called while it is not zero. Every call says in
/// its result or status what is wrong; no number from outside is trusted.
///
/// SI units throughout (m, rad, s, N, N·m, kg); vectors in the robot base frame unless said
/// otherwise. A wrench is {fx, fy, fz, mx, my, mz}: force and moment acting ON the tool at the tool
/// centre point (TCP). A twist is {x, y, z, rx, ry, rz}: small translation and rotation vector.
///
/// No call allocates, blocks, does I/O, or keeps anything outside the objects it is given. Calls on
/// different objects may run at the same time; one object belongs to one thread at a time. Nothing
/// here is a safety function. README.md beside this file in the sources has a whole program.
///
/// For C11 or later, and C++11 or later.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Joints of every robot here.
#define FLEXCOMP_JOINTS 6

/// Result of a call. Stable numbers.
typedef enum flexcomp_result {
  FLEXCOMP_OK = 0,
  FLEXCOMP_BAD_ARGUMENT = 1,         ///< null, misaligned, unknown, or a number that cannot be
  FLEXCOMP_BAD_MODEL = 2,            ///< a number of the model is not finite or out of its range
  FLEXCOMP_BAD_CONFIG = 3,           ///< a number of the configuration is out of its range
  FLEXCOMP_BAD_PATH = 4,             ///< fewer than two distinct points, or one not finite
  FLEXCOMP_BUFFER_TOO_SMALL = 5,     ///< no table within the tolerance fits
  FLEXCOMP_TOLERANCE_NOT_MET = 6,    ///< finer than the arithmetic can certify
  FLEXCOMP_CHART_NOT_INVARIANT = 7,  ///< this model needs a path table
  FLEXCOMP_TABLE_MISALIGNED = 8,     ///< a table must start at a multiple of 4 bytes
  FLEXCOMP_TABLE_TRUNCATED = 9,      ///< fewer bytes than the table says it has, or than a header
  FLEXCOMP_TABLE_NOT_A_TABLE = 10,   ///< another magic number
  FLEXCOMP_TABLE_VERSION = 11,       ///< another version of the format
  FLEXCOMP_TABLE_CORRUPT = 12,       ///< CRC-32 or a field contradicts the content; NaN, infinity
  FLEXCOMP_TABLE_OTHER_MODEL = 13,   ///< made for another robot, tool or payload
  FLEXCOMP_GAIN_TOO_HIGH = 14,       ///< above the largest safe gain in the table
  FLEXCOMP_NOT_READY = 15,           ///< too few good inputs in a row, or the wrong state
  FLEXCOMP_NO_TABLE = 16             ///< no table yet
} flexcomp_result_t;

/// State of a compensator. Stable numbers.
typedef enum flexcomp_state {
  FLEXCOMP_STATE_OFF = 0,         ///< no correction
  FLEXCOMP_STATE_FADING_IN = 1,   ///< the correction grows to its full size
  FLEXCOMP_STATE_ACTIVE = 2,      ///< full correction
  FLEXCOMP_STATE_HOLDING = 3,     ///< a bad input: the correction stays where it is
  FLEXCOMP_STATE_FADING_OUT = 4,  ///< the correction shrinks to zero
  FLEXCOMP_STATE_LATCHED = 5      ///< no correction after a fault, until a reset
} flexcomp_state_t;

/// Bits of the status word. Stable numbers; the lower half are faults, the upper half remarks. As
/// constants of an enumeration they are of type int: to take one away under -Wsign-conversion write
/// `status &= ~(uint32_t)FLEXCOMP_WRENCH_STALE`.
enum {
  FLEXCOMP_SETPOINT_NOT_FINITE = 1 << 0,
  FLEXCOMP_SETPOINT_STALE = 1 << 1,         ///< age above the limit, negative or not finite
  FLEXCOMP_SETPOINT_OUT_OF_RANGE = 1 << 2,  ///< outside the joint limits in the table
  FLEXCOMP_SETPOINT_JUMP = 1 << 3,          ///< faster than the joint can move
  FLEXCOMP_WRENCH_NOT_FINITE = 1 << 4,
  FLEXCOMP_WRENCH_STALE = 1 << 5,         ///< age above the limit, negative or not finite
  FLEXCOMP_WRENCH_OUT_OF_RANGE = 1 << 6,  ///< beyond the sensor's range
  FLEXCOMP_OUTSIDE_CHART = 1 << 7,        ///< further outside the table's chart than the margin
  FLEXCOMP_EXTERNAL_FAULT = 1 << 8,       ///< reported by the caller
  FLEXCOMP_NOT_COMPUTABLE = 1 << 9,       ///< the table gave a number that is not finite
  FLEXCOMP_VALUE_LIMITED = 1 << 16,       ///< a joint's correction is at its largest value
  FLEXCOMP_RATE_LIMITED = 1 << 17,        ///< on its way, as fast as allowed
  FLEXCOMP_DEFLECTION_LIMITED = 1 << 18,  ///< scaled down to the largest correction at the TCP
  FLEXCOMP_CHART_EDGE = 1 << 19,          ///< outside the chart but within the margin
  FLEXCOMP_NO_SETPOINT = 1 << 20          ///< no usable setpoint yet: do not use the output
};
/// The bits that are faults.
#define FLEXCOMP_FAULT_BITS 0xFFFFu

/// A few words for a person; never null.
const char* flexcomp_describe_result(flexcomp_result_t result);
/// A few words for a person; never null.
const char* flexcomp_describe_state(flexcomp_state_t state);
/// A few words for a person; never null. `bit`: one bit of the status word.
const char* flexcomp_describe_status_bit(uint32_t bit);

/// Version of the library, for example "0.1.0"; never null.
const char* flexcomp_version(void);

/// A robot: rotations are row by row; a frame's pose is given in the frame before it. All numbers
/// of a model are finite.
typedef struct flexcomp_pose {
  float rotation[9];  ///< row by row; right-handed, columns of length 1 at right angles, to 1e-4
  float position[3];  ///< m
} flexcomp_pose_t;

/// A joint, its spring, and the link that it moves.
typedef struct flexcomp_joint {
  flexcomp_pose_t origin;    ///< joint frame in the previous link's frame
  float axis[3];             ///< unit vector in the joint frame, to 1e-4
  float lower;               ///< rad
  float upper;               ///< rad, above `lower`
  float compliance;          ///< rad/(N·m), c1 in wind-up = c1 τ + c3 τ³; 0 or more
  float cubic_compliance;    ///< rad/(N·m)³, c3; below 0 for a hardening spring
  float link_compliance[6];  ///< m/N (3), rad/(N·m) (3), of the moved link in its frame; 0 or more
  float mass;                ///< kg, of the moved link; 0 or more
  float center_of_mass[3];   ///< m, link frame
} flexcomp_joint_t;

/// A robot of six revolute joints with limits.
typedef struct flexcomp_model {
  flexcomp_joint_t joints[FLEXCOMP_JOINTS];  ///< base to tip
  flexcomp_pose_t tool;                      ///< TCP in the last link's frame
  float base_compliance[6];                  ///< base frame; 0 or more
  float tool_compliance[6];                  ///< tool frame; 0 or more
  float gravity[3];                          ///< m/s²; zero leaves weight out
  float payload_mass;                        ///< kg; 0 or more
  float payload_center[3];                   ///< m, tool frame
} flexcomp_model_t;

/// FLEXCOMP_OK, FLEXCOMP_BAD_ARGUMENT or FLEXCOMP_BAD_MODEL (`flexcomp_model_unusable_member` says
/// which number). Cost: about 1,000 operations.
flexcomp_result_t flexcomp_model_validate(const flexcomp_model_t* model);

/// The first member of a model that is out of its range, by its name, for example "axis"; null
/// where all are usable, or without a model. `joint`, unless null, receives the joint whose member
/// it is, from 0, and FLEXCOMP_JOINTS for a member of the model itself or where there is none.
const char* flexcomp_model_unusable_member(const flexcomp_model_t* model, size_t* joint);

/// Fingerprint that ties tables to a robot; 0 for a null pointer. Cost: about 3,000 operations.
uint64_t flexcomp_model_hash(const flexcomp_model_t* model);

/// TCP pose, Jacobian-based compliance (6×6, row by row) and so on at joint angles `q` (rad).
/// Null outputs are left out. FLEXCOMP_OK, or BAD_ARGUMENT, with the outputs untouched, for a null
/// input, an angle not finite, or where an output would not be. Whether the model is one is said by
/// `flexcomp_model_validate` alone: call it first.
/// Cost: about 1,500 operations, 12 sines and cosines; about 1.5 KiB of stack.
flexcomp_result_t flexcomp_model_evaluate(const flexcomp_model_t* model,
                                          const float q[FLEXCOMP_JOINTS], flexcomp_pose_t* tcp,
                                          float compliance[36]);

/// Deflection of the TCP (twist) under a wrench and the weights in the model, and what to add to
/// the joint setpoint against it (rad), straight from the model. Null outputs are left out.
/// FLEXCOMP_OK, or BAD_ARGUMENT, with the outputs untouched, for a null input, an angle, force or
/// moment not finite, or where an output would not be; `flexcomp_model_validate` comes first here,
/// too. Cost: about 2,500 operations and 2 KiB of stack; with base, link or tool springs twice
/// that.
flexcomp_result_t flexcomp_model_respond(const flexcomp_model_t* model,
                                         const float q[FLEXCOMP_JOINTS], const float wrench[6],
                                         float deflection[6], float correction[FLEXCOMP_JOINTS]);

/// Loads and tolerances that a table is built for. All are finite.
typedef struct flexcomp_table_requirements {
  float force_bound;            ///< N, largest force that will act; 0 or more, and not both 0
  float moment_bound;           ///< N·m
  float position_tolerance;     ///< m, largest allowed error at the TCP; above 0
  float orientation_tolerance;  ///< rad; above 0
  /// Largest safe correction gain, 0 if not analysed. No compensator has a gain above 1: a larger
  /// number, of a loop that would bear more, allows all of them.
  float largest_gain;
} flexcomp_table_requirements_t;

/// Builds a path table for the program through `count` points of six joint angles each, into a
/// 4-byte aligned buffer. `size` receives the bytes used.
///
/// FLEXCOMP_OK, or BAD_ARGUMENT (also for a misaligned buffer or requirements out of their range),
/// BAD_MODEL, BAD_PATH, BUFFER_TOO_SMALL, TOLERANCE_NOT_MET; then the buffer holds no table, and
/// `size` is untouched. Cost: some thousand evaluations of the model a node (not for the tick);
/// memory: the buffer, 244 to 544 bytes a node, and 13 KiB of stack.
flexcomp_result_t flexcomp_table_build_path(const flexcomp_model_t* model, const float* points,
                                            size_t count,
                                            const flexcomp_table_requirements_t* requirements,
                                            void* buffer, size_t capacity, size_t* size);

/// Builds a joint-grid table over joints 2 to 5; `lower[i] == upper[i]` fixes a joint. As above;
/// BAD_ARGUMENT also for an angle not finite or a lower one above its upper; also
/// CHART_NOT_INVARIANT for a robot whose joints 1 and 6 may not turn freely (base, link or tool
/// springs; a TCP off the last axis; weight not along axis 1). Cost: the product of the nodes.
flexcomp_result_t flexcomp_table_build_grid(const flexcomp_model_t* model, const float lower[4],
                                            const float upper[4],
                                            const flexcomp_table_requirements_t* requirements,
                                            void* buffer, size_t capacity, size_t* size);

/// A checked view of a table, which must outlive it. Do not touch the members.
typedef struct flexcomp_table {
  const void* header;  ///< first byte
  const void* end;     ///< behind the last
  const void* index;   ///< null, or what flexcomp_table_index made
} flexcomp_table_t;

/// Content of a table's header that a caller may want to know.
typedef struct flexcomp_table_info {
  uint64_t model_hash;      ///< fingerprint of the robot it was made for
  bool is_path;             ///< else a joint grid
  uint32_t node_count;      ///< records in it
  uint32_t size;            ///< bytes
  float force_bound;        ///< N
  float moment_bound;       ///< N·m
  float position_error;     ///< m, certified for all wrenches within the bounds
  float orientation_error;  ///< rad
  float largest_gain;       ///< 0 if not analysed
} flexcomp_table_info_t;

/// Bytes of the table at the start of `available` bytes, by its header; `size` receives them, and
/// is untouched unless the result is FLEXCOMP_OK. For a table in a longer place (a sector of flash)
/// or with a signature behind it: `flexcomp table sign` appends 24 bytes, which begin at `size` and
/// are not looked at here. FLEXCOMP_OK says that so many bytes are there and that the header does
/// not contradict itself; `flexcomp_table_open` checks the rest. Else BAD_ARGUMENT,
/// TABLE_MISALIGNED, TABLE_TRUNCATED, TABLE_NOT_A_TABLE, TABLE_VERSION, TABLE_CORRUPT. Cost: the
/// header's alone.
flexcomp_result_t flexcomp_table_size(const void* data, size_t available, size_t* size);

/// Checks a table in place (flash) and opens it. `size` is exactly the table's, without a signature
/// or anything else behind it: see `flexcomp_table_size`. FLEXCOMP_OK, or BAD_ARGUMENT (a null
/// pointer), TABLE_MISALIGNED, TABLE_TRUNCATED (of size 0, too), TABLE_NOT_A_TABLE, TABLE_VERSION,
/// TABLE_CORRUPT (also for bytes beyond the table's). Cost: two passes over the bytes.
flexcomp_result_t flexcomp_table_open(const void* data, size_t size, flexcomp_table_t* table);

/// Bytes that an index of a table takes, about 12 a node; 0 for a grid, which needs none, and for a
/// table that is not open.
size_t flexcomp_table_index_size(const flexcomp_table_t* table);

/// Makes an index of an open path table in 4-byte aligned memory, which must outlive the table's
/// use. With it, arming, a new table, and a program that has jumped cost a bounded number of steps
/// however long the program is: at most 20,000 instructions, and 5 ticks or so until a program is
/// found again. Memory that changes while it is in use makes a program be found late or not at all,
/// but nothing is read beyond the table. FLEXCOMP_OK (at once for a grid), or BAD_ARGUMENT,
/// NO_TABLE (not opened), BUFFER_TOO_SMALL, TABLE_CORRUPT (angles beyond 10⁴ rad). Cost: on a
/// Cortex-M7 12,000 instructions a node for 2,000 of them, and 1,000 more for each doubling of
/// their number (not for the tick); 2 KiB of stack.
flexcomp_result_t flexcomp_table_index(flexcomp_table_t* table, void* memory, size_t capacity);

/// Does an open table say of the robot what the model says? Whoever has the model should ask before
/// using a table from elsewhere: the fingerprint that a compensator compares is a claim of the
/// table, while this compares the springs, joint limits and all else that a tick reads of its
/// header. FLEXCOMP_OK, or BAD_ARGUMENT, NO_TABLE (not opened), BAD_MODEL, TABLE_OTHER_MODEL (its
/// header says something else of the robot), TABLE_CORRUPT (a header that no builder writes, or a
/// largest gain that does not follow from the process beside it). Cost: about 5,000 operations, and
/// a million where the table states a process. The records are looked at by `flexcomp table
/// verify`, which derives the certificates again.
flexcomp_result_t flexcomp_table_check_model(const flexcomp_table_t* table,
                                             const flexcomp_model_t* model);

/// FLEXCOMP_OK, BAD_ARGUMENT, NO_TABLE (not opened) or TABLE_CORRUPT (its header has changed since
/// and contradicts itself; the records and the checksum are not looked at again).
flexcomp_result_t flexcomp_table_describe(const flexcomp_table_t* table,
                                          flexcomp_table_info_t* info);

/// Limits of one joint's correction, which hold whatever the input. All are above 0.
typedef struct flexcomp_limits {
  float value;  ///< rad, largest correction of the joint
  float rate;   ///< rad/s; at least 1/64 of acceleration × period
  /// rad/s²; large enough for a float: acceleration × period² is at least 1.6e-5 of the value.
  float acceleration;
} flexcomp_limits_t;

/// Numbers of a compensator; the robot controller's, the sensor's and the job's. All are finite,
/// and above 0 where nothing else is said.
typedef struct flexcomp_config {
  float period;              ///< s, from one tick to the next
  uint64_t model_hash;       ///< of the robot that is there; a table of another is refused
  float gain;                ///< share of the deflection that is corrected, above 0 to 1
  float filter_cutoff;       ///< Hz, of the low-pass on the wrench; 0: no filter
  float force_range;         ///< N, largest plausible magnitude; at most 1e19
  float moment_range;        ///< N·m; at most 1e19
  float setpoint_age_limit;  ///< s, beyond it a setpoint is stale
  float wrench_age_limit;    ///< s
  float joint_speed[FLEXCOMP_JOINTS];         ///< rad/s, largest plausible
  flexcomp_limits_t limits[FLEXCOMP_JOINTS];  ///< the correction's
  float deflection_limit;                     ///< m, largest correction at the TCP
  float chart_margin;  ///< rad, outside the chart, over which the correction fades
  /// s, a fault may last before fading out. Bad ticks count up, good ones down: a fault that comes
  /// and goes fades out too, once bad ticks outnumber good ones by this time. 0 or more, at most
  /// 1e9 periods.
  float hold_time;
  /// s, from nothing to full correction and back; 0 or more, at most 1e6 periods.
  float fade_time;
  uint32_t ready_ticks;  ///< good inputs in a row before it may be armed; any number
} flexcomp_config_t;

/// Input of one tick.
typedef struct flexcomp_input {
  float setpoint[FLEXCOMP_JOINTS];  ///< rad, uncorrected
  float setpoint_age;               ///< s, since it was made
  float wrench[6];                  ///< N, N·m; on the tool at the TCP, base frame
  float wrench_age;                 ///< s, since it was measured
  bool external_fault;              ///< anything the caller knows: bus off, late tick
} flexcomp_input_t;

/// Result of one tick.
typedef struct flexcomp_output {
  float setpoint[FLEXCOMP_JOINTS];    ///< rad, corrected; always finite
  float correction[FLEXCOMP_JOINTS];  ///< rad, part of the above; within all limits
  float deflection[6];                ///< m, rad; predicted for the filtered wrench
  uint32_t status;                    ///< bits of this tick
  uint32_t latched_faults;            ///< what led to the last fade-out, until a reset
  flexcomp_state_t state;             ///< after this tick
} flexcomp_output_t;

/// Bytes of a compensator.
#define FLEXCOMP_COMPENSATOR_BYTES 768
/// Room for a compensator, static or on a stack, where the compiler aligns it. Other memory must
/// start at a multiple of 16 bytes: malloc promises that on a 64-bit PC, not on every
/// microcontroller. Do not touch the member.
typedef struct flexcomp_compensator {
#ifdef __cplusplus
  alignas(16) unsigned char bytes[FLEXCOMP_COMPENSATOR_BYTES];  ///< opaque
#else
  _Alignas(16) unsigned char bytes[FLEXCOMP_COMPENSATOR_BYTES];  ///< opaque
#endif
} flexcomp_compensator_t;

/// The first number of a configuration that no compensator takes, by its member's name, for example
/// "hold_time" ("limits" for any joint's); null where it takes all, or without a configuration.
/// Times and limits are counted in periods: where they would do with a period of 1 ms and do not
/// with one outside 0.1 ms to 1 s, it is "period".
const char* flexcomp_config_unusable_member(const flexcomp_config_t* config);

/// Takes a configuration and begins anew in FLEXCOMP_STATE_OFF, whatever the memory held: a
/// correction that was there is gone at once, and so are table, latched faults and good inputs. So
/// it must not be called while a robot moves by a correction. No call changes the gain or another
/// number in operation: disarm, tick until the state is FLEXCOMP_STATE_OFF, then init, set the
/// table, and arm again after `ready_ticks`.
///
/// FLEXCOMP_OK; BAD_ARGUMENT (null pointer), with the compensator untouched; or BAD_CONFIG
/// (`flexcomp_config_unusable_member` says which number). After BAD_CONFIG the compensator has no
/// configuration: what it was is gone all the same, it cannot be armed, and each tick says
/// BAD_CONFIG.
flexcomp_result_t flexcomp_compensator_init(flexcomp_compensator_t* compensator,
                                            const flexcomp_config_t* config);

/// Gives it a table, at any time between ticks, also while correcting: the correction then moves to
/// the new table's within its limits. FLEXCOMP_OK, or BAD_ARGUMENT, NO_TABLE, TABLE_CORRUPT (its
/// header has changed since it was opened and contradicts itself; no more is looked at again),
/// TABLE_OTHER_MODEL (also where no configuration was accepted), GAIN_TOO_HIGH with the table in
/// use unchanged. Cost: one look at every node, or less with an index.
///
/// The compensator keeps sizes and indices of the table in its own memory: should the table's
/// memory change while it is in use, the correction may be wrong, within its limits, but nothing is
/// read beyond the table. Check its CRC-32 now and then where that can be, as `flexcompd` does.
flexcomp_result_t flexcomp_compensator_set_table(flexcomp_compensator_t* compensator,
                                                 const flexcomp_table_t* table);

/// Starts to correct. FLEXCOMP_OK, BAD_ARGUMENT, NO_TABLE or NOT_READY. Cost: as above; that of a
/// tick where the last ticks were on the program.
flexcomp_result_t flexcomp_compensator_arm(flexcomp_compensator_t* compensator);

/// Fades out, then off.
void flexcomp_compensator_disarm(flexcomp_compensator_t* compensator);

/// From latched to off. FLEXCOMP_OK, BAD_ARGUMENT or NOT_READY.
flexcomp_result_t flexcomp_compensator_reset(flexcomp_compensator_t* compensator);

/// One control period: check, filter, look up, deflect, invert, limit, fade. Constant time; the
/// correction obeys its value, rate and acceleration limits whatever the input. FLEXCOMP_OK, or
/// BAD_ARGUMENT (null pointer; `output` untouched), or BAD_CONFIG: no configuration was accepted,
/// since `init` failed or the memory is zero as a static object's before it. `output` then passes
/// the setpoint on without a correction. Memory that is neither zero nor of an `init` is not found
/// out. Cost: about 2 KiB of stack.
flexcomp_result_t flexcomp_compensator_tick(flexcomp_compensator_t* compensator,
                                            const flexcomp_input_t* input,
                                            flexcomp_output_t* output);

/// Bits of the status word of adaptive robust control. Stable numbers; the lower half refuse a
/// tick.
enum {
  FLEXCOMP_ARC_INPUT_NOT_FINITE = 1 << 0,
  FLEXCOMP_ARC_NOT_COMPUTABLE = 1 << 1,   ///< finite input, but so large that the result is not
  FLEXCOMP_ARC_NOT_CONFIGURED = 1 << 2,   ///< no accepted configuration: the torque is zero
  FLEXCOMP_ARC_TORQUE_LIMITED = 1 << 16,  ///< a joint asks for more than its torque limit
  FLEXCOMP_ARC_BOUND_LIMITED = 1 << 17    ///< a bound is near its limit: it adapts less, or no more
};
/// The bits that refuse a tick.
#define FLEXCOMP_ARC_REFUSED_BITS 0xFFFFu

/// A few words for a person; never null. `bit`: one bit of the status word.
const char* flexcomp_describe_arc_status_bit(uint32_t bit);

/// Gains of adaptive robust control, joint side of the gears; flexcomp design-arc writes them as a
/// header. flexcomp/arc.hpp says what each is.
typedef struct flexcomp_arc_gains {
  float period;                                ///< s
  float rotor_inertia[FLEXCOMP_JOINTS];        ///< kg·m²
  float viscous[FLEXCOMP_JOINTS];              ///< N·m·s/rad
  float link_rate[FLEXCOMP_JOINTS];            ///< 1/s
  float link_damping;                          ///< 1/s
  float motor_rate[FLEXCOMP_JOINTS];           ///< 1/s
  float motor_damping;                         ///< 1/s
  float motor_stiffness[FLEXCOMP_JOINTS];      ///< N·m/rad
  float filter_frequency;                      ///< rad/s
  float leak;                                  ///< 1/s
  float link_adaptation[FLEXCOMP_JOINTS][3];   ///< squared units of the parameters by J
  float motor_adaptation[FLEXCOMP_JOINTS][4];  ///< the same of the motors
  float link_gain[FLEXCOMP_JOINTS];            ///< 1/W
  float motor_gain[FLEXCOMP_JOINTS];           ///< 1/W
  float link_gain_limit[FLEXCOMP_JOINTS];      ///< N·m·s/rad
  float motor_gain_limit[FLEXCOMP_JOINTS];     ///< N·m·s/rad
  float link_bound_limit[FLEXCOMP_JOINTS];     ///< N·m
  float motor_bound_limit[FLEXCOMP_JOINTS];    ///< N·m
  float torque_limit[FLEXCOMP_JOINTS];         ///< N·m
} flexcomp_arc_gains_t;

/// Input of one tick of adaptive robust control.
typedef struct flexcomp_arc_input {
  float link[FLEXCOMP_JOINTS];                 ///< rad, link side of the springs
  float link_velocity[FLEXCOMP_JOINTS];        ///< rad/s
  float motor[FLEXCOMP_JOINTS];                ///< rad, motor side, reflected through the gear
  float motor_velocity[FLEXCOMP_JOINTS];       ///< rad/s
  float wanted[FLEXCOMP_JOINTS];               ///< rad
  float wanted_velocity[FLEXCOMP_JOINTS];      ///< rad/s
  float wanted_acceleration[FLEXCOMP_JOINTS];  ///< rad/s²
  float external_torque[FLEXCOMP_JOINTS];      ///< N·m, of the measured wrench; zero if unmeasured
} flexcomp_arc_input_t;

/// Result of one tick of adaptive robust control.
typedef struct flexcomp_arc_output {
  float torque[FLEXCOMP_JOINTS];       ///< N·m, joint side; finite, within the limit
  float link_bound[FLEXCOMP_JOINTS];   ///< N·m, adapted bound of what disturbs the link
  float motor_bound[FLEXCOMP_JOINTS];  ///< N·m, the motor
  uint32_t status;                     ///< bits of this tick
} flexcomp_arc_output_t;

/// Bytes of a controller.
#define FLEXCOMP_ARC_BYTES 3072
/// Room for a controller, aligned for the widest vector registers: static or on a stack the
/// compiler sees to it. Other memory must start at a multiple of 64 bytes, which malloc does not
/// promise (`aligned_alloc` of C11 does). Do not touch the member.
typedef struct flexcomp_arc {
#ifdef __cplusplus
  alignas(64) unsigned char bytes[FLEXCOMP_ARC_BYTES];  ///< opaque
#else
  _Alignas(64) unsigned char bytes[FLEXCOMP_ARC_BYTES];          ///< opaque
#endif
} flexcomp_arc_t;

/// Takes the nominal robot, each link's inertia about its centre of mass (link frame, row by row,
/// kg·m²) and gains, and begins anew: not while it drives a robot. FLEXCOMP_OK, BAD_ARGUMENT,
/// BAD_MODEL (also for a joint without compliance) or BAD_CONFIG. After the last two each tick says
/// FLEXCOMP_ARC_NOT_CONFIGURED.
flexcomp_result_t flexcomp_arc_init(flexcomp_arc_t* arc, const flexcomp_model_t* model,
                                    const float inertia[FLEXCOMP_JOINTS][9],
                                    const flexcomp_arc_gains_t* gains);

/// Forgets what was adapted and the last torque. Begin again with `wanted` at the link's angle.
void flexcomp_arc_restart(flexcomp_arc_t* arc);

/// One control period. Constant time; a refused tick repeats the last torque. FLEXCOMP_OK or
/// BAD_ARGUMENT (null pointer; `output` untouched). Cost: about 3 KiB of stack.
flexcomp_result_t flexcomp_arc_tick(flexcomp_arc_t* arc, const flexcomp_arc_input_t* input,
                                    flexcomp_arc_output_t* output);

#ifdef __cplusplus
}
#endif

#endif  // FLEXCOMP_H
