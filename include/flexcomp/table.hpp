#pragma once

/// @file
/// Tables: their format, how they are opened and looked up.

#include <cstddef>
#include <cstdint>

#include "flexcomp/compliance.hpp"

namespace flexcomp {

/// Set of joint angles that a table covers.
enum class Chart : std::uint32_t {
  path = 1,        ///< the neighbourhood of a known program
  joint_grid = 2,  ///< boxes over the middle joints; joints 1 and 6 enter as exact rotations
};

constexpr std::uint32_t kTableVersion = 1;  ///< the format's
constexpr std::size_t kTableJoints = 6;     ///< every robot that has tables has six
constexpr std::size_t kMaxGridAxes = 4;     ///< joints that a grid may cover

/// First bytes of a table: a flat blob of little-endian 32-bit words, read where it lies (flash).
///
/// After the header come `node_count` records of `record_size` floats. A table holds, at each node,
/// what the joint springs need (the Jacobian at the TCP; the torques of the weights) and what the
/// other springs add. From it follow the compliance C = J K⁻¹ Jᵀ + D of Klimchik et al. (2017), the
/// deflection C w, and the joint correction, which at the singular postures of a wrist could not be
/// had from C alone because J has no inverse there.
struct TableHeader {
  std::uint32_t magic;            ///< `Table::kMagic`
  std::uint32_t version;          ///< `kTableVersion`
  std::uint32_t size;             ///< bytes of the whole table
  std::uint32_t crc;              ///< CRC-32 (IEEE 802.3) of the whole table with this word zero
  std::uint32_t model_hash_low;   ///< fingerprint of the robot
  std::uint32_t model_hash_high;  ///< its upper half
  std::uint32_t chart;            ///< `Chart`
  std::uint32_t contents;         ///< bits: 1 weight acts, 2 base, link or tool springs
  std::uint32_t joints;           ///< `kTableJoints`
  std::uint32_t record_size;      ///< floats
  std::uint32_t node_count;       ///< records
  std::uint32_t closed;           ///< path: 1 if the last node is the first again
  std::uint32_t grid_axes;        ///< grid: how many joints it covers
  std::uint32_t grid_joint[kMaxGridAxes];  ///< index of the joint along each axis, from 0
  std::uint32_t grid_nodes[kMaxGridAxes];  ///< nodes along each axis
  float grid_lower[kMaxGridAxes];          ///< grid: rad; path: `inside_error`
  float grid_step[kMaxGridAxes];           ///< grid: rad
  float fixed_angle[kTableJoints];  ///< grid: rad, where the middle joints off the axes must stand;
                                    ///< path: `gain_basis`
  float first_axis[3];              ///< grid: axis of joint 1, base frame
  float joint_lower[kTableJoints];  ///< rad, limits of the robot
  float joint_upper[kTableJoints];  ///< rad
  float compliance[kTableJoints];   ///< rad/(N·m)
  float cubic_compliance[kTableJoints];  ///< rad/(N·m)³
  float force_bound;                     ///< N, the certificate holds for forces up to this
  float moment_bound;                    ///< N·m
  float position_error;     ///< m, certified largest error of deflection and of correction: of a
                            ///< path table on its program, of a grid everywhere in it
  float orientation_error;  ///< rad
  float largest_gain;       ///< largest safe correction gain; 0 where it was not analysed
};

/// The cut, and the loop that corrects it, from which the largest gain of a path table follows
/// (`gain_limit` in flexcomp/loop_gain.hpp). All zero where no process was analysed.
struct GainBasis {
  float least_push = 0;  ///< m, zero or below: along the program, the least displacement of the TCP
                         ///< into the material under the nominal wrench
  float most_push = 0;   ///< m, zero or above: the largest
  float depth_of_cut = 0;   ///< m, nominal
  float period = 0;         ///< s, of a tick
  float filter_cutoff = 0;  ///< Hz, of the low-pass on the wrench; 0: none
  float delay = 0;          ///< s, from the wrench to the robot standing corrected
};

/// Largest errors, for any wrench within the bounds.
struct InsideError {
  float position = 0;     ///< m
  float orientation = 0;  ///< rad
};

/// A path table's fields lie in words of the header that only a grid uses otherwise. Tables of
/// before they were stated have zeros there; so has a grid for those who ask.
GainBasis gain_basis(const TableHeader& header);
/// The other way.
void set_gain_basis(const GainBasis& basis, TableHeader* header);

/// The certificate for all joint angles that a tick takes for inside a path table, which may be off
/// the chord between two nodes by the width that stands in the record: more than the error on the
/// program itself, for which the table was made. Zero where it is not stated.
InsideError inside_error(const TableHeader& header);
/// The other way.
void set_inside_error(const InsideError& error, TableHeader* header);

/// The fields of a header that sizes, indices and branches come from, in narrow types that hold any
/// value a table can have.
struct TableShape {
  std::uint8_t chart = 0;                       ///< as in the header, and so all of these
  std::uint8_t contents = 0;                    ///< bits
  std::uint16_t record_size = 0;                ///< floats
  std::uint32_t node_count = 0;                 ///< records
  bool closed = false;                          ///< path: the last node is the first again
  std::uint8_t grid_axes = 0;                   ///< grid: how many joints it covers
  std::uint8_t grid_joint[kMaxGridAxes] = {};   ///< from 0
  std::uint16_t grid_nodes[kMaxGridAxes] = {};  ///< along each axis
};

struct IndexNode;

/// A checked, read-only view of a table. Copying the view does not copy the table, which must
/// outlive it.
///
/// The view keeps the shape that it has checked. A table whose memory changes while it is in use
/// gives wrong numbers, which the compensator limits, but is never read beyond its end.
class Table {
 public:
  Table() = default;

  /// Bytes of the table at the start of `available` bytes, by its header, which must not contradict
  /// itself: for a table with something behind it. Returns as `open`; `size` is untouched unless
  /// ok.
  static Result find_size(const void* data, std::size_t available, std::size_t* size);

  /// Checks everything: alignment (4 bytes), magic number, version, size, CRC-32, consistent
  /// fields, finite numbers. `size` is exactly the table's. Cost: two passes over the bytes. Call
  /// it before use, not in the control tick.
  ///
  /// Returns ok, or bad_argument, table_misaligned, table_truncated, table_not_a_table,
  /// table_version, table_corrupt; `table` is untouched unless ok.
  static Result open(const void* data, std::size_t size, Table* table);

  /// A view again of a table of `size` bytes that `open` has checked. Constant time: checks that
  /// the fields still fit the size. Returns ok, bad_argument or table_corrupt.
  static Result reopen(const void* data, std::size_t size, Table* table);

  bool is_open() const { return header_ != nullptr; }     ///< only then the rest may be asked
  const TableHeader& header() const { return *header_; }  ///< where it lies
  const TableShape& shape() const { return shape_; }      ///< as it was checked
  std::size_t size() const {                              ///< bytes
    return sizeof(TableHeader) +
           sizeof(float) * static_cast<std::size_t>(shape_.node_count) * shape_.record_size;
  }
  Chart chart() const { return static_cast<Chart>(shape_.chart); }  ///< path or grid
  std::uint64_t model_hash() const;                                 ///< fingerprint of its robot
  bool has_weight() const { return (shape_.contents & kWeight) != 0; }  ///< weights act
  /// Base, links or tool give too.
  bool has_structure() const { return (shape_.contents & kStructure) != 0; }
  /// `node` is below `shape().node_count`.
  const float* record(std::uint32_t node) const {
    return records_ + static_cast<std::size_t>(node) * shape_.record_size;
  }

  /// Root of the index over a path's segments (flexcomp/path_index.hpp); null where it has none.
  const IndexNode* index() const { return index_; }
  /// `index` must be of this very table.
  void use_index(const IndexNode* index) { index_ = index; }

  static constexpr std::uint32_t kMagic = 0x31544346;  ///< "FCT1"
  static constexpr std::uint32_t kWeight = 1;          ///< bit of the contents
  static constexpr std::uint32_t kStructure = 2;       ///< bit of the contents

 private:
  const TableHeader* header_ = nullptr;
  const float* records_ = nullptr;
  const IndexNode* index_ = nullptr;
  TableShape shape_;
};

/// Where in the chart the last lookup ended; keeps the next one short. Zero to begin with.
struct TableCursor {
  std::uint32_t segment = 0;   ///< the path's, from 0
  std::uint32_t searched = 0;  ///< since the program was lost: segments looked at; with an index
                               ///< the node where the search goes on, 0: at the root
  std::uint32_t pending = 0;   ///< with an index: bit i is set if, i levels above that node, the
                               ///< other half is still to be looked at
  bool off_program = false;  ///< with an index: no segment holds the angles, so that the search is
                             ///< for one that is near
};

/// Content of a table at one set of joint angles; base frame.
template <typename Scalar, int Joints>
struct TableEntry {
  static_assert(Joints == static_cast<int>(kTableJoints), "the format holds six joints");

  Jacobian<Scalar, Joints> jacobian;                    ///< the TCP's
  JointVector<Scalar, Joints> weight_torque;            ///< N·m, of the weights on the joints
  Compliance<Scalar> structure;                         ///< D, of base, link and tool springs
  Eigen::Matrix<Scalar, Joints, 6> structure_motion;    ///< J⁺ D
  Twist<Scalar> structure_weight;                       ///< TCP twist from weight on those springs
  JointVector<Scalar, Joints> structure_weight_motion;  ///< J⁺ of it
  Scalar outside;  ///< rad, how far the joint angles lie outside the chart (0: inside)
};

/// How the robot gives way and what to add to the setpoint against it.
template <typename Scalar, int Joints>
struct TableResponse {
  Twist<Scalar> deflection;                ///< of the TCP, base frame
  JointVector<Scalar, Joints> correction;  ///< rad, to add to the joint setpoint
};

/// Finds the segment of a path table that `q` is least outside, by looking at all of them. With an
/// index (flexcomp/path_index.hpp) it finds one that `q` is on, if there is any, or one that `q` is
/// at most twice as far outside as the nearest: in at most 20,000 instructions, after which
/// look-ups go on. For arming; not for the tick. Grid tables need no cursor and leave it as it is.
template <typename Scalar, int Joints>
void locate(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor);

/// Moves the cursor as a look-up does, without reading what is there; returns `outside` of it
/// (rad). For who will look up later and is on the program already. Grid tables need no cursor: 0.
template <typename Scalar, int Joints>
Scalar track(const Table& table, const JointVector<Scalar, Joints>& q, TableCursor* cursor);

/// Reads the table at joint angles `q` (rad, finite). Constant time: a path table moves its cursor
/// at most two segments a call, and where `q` has left the segment sideways (a jump; a program that
/// runs back on itself and then turns off) looks at four more, further on each call, for one that
/// it is on, or with an index goes on with a search as that of `locate`; a grid blends the 2^axes
/// corners of one box. Outside the chart the nearest edge is used and `outside` says how far off
/// `q` is; nothing is extrapolated.
template <typename Scalar, int Joints>
TableEntry<Scalar, Joints> look_up(const Table& table, const JointVector<Scalar, Joints>& q,
                                   TableCursor* cursor);

/// Deflection and correction under a wrench at an entry of the table.
template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> respond(const Table& table, const TableEntry<Scalar, Joints>& entry,
                                      const Wrench<Scalar>& wrench);

/// `respond` of `look_up`, to rounding, and `TableEntry::outside`. What a tick does: for a path
/// table at a quarter of the instructions, because no entry is formed.
template <typename Scalar, int Joints>
TableResponse<Scalar, Joints> look_up_response(const Table& table,
                                               const JointVector<Scalar, Joints>& q,
                                               const Wrench<Scalar>& wrench, TableCursor* cursor,
                                               Scalar* outside);

}  // namespace flexcomp
