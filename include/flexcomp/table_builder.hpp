#pragma once

/// @file
/// How tables are built and their certificates derived.

#include "flexcomp/table.hpp"

namespace flexcomp {

/// Loads and tolerances that a table is built for.
template <typename Scalar>
struct TableRequirements {
  Scalar force_bound;            ///< N, largest force that will act
  Scalar moment_bound;           ///< N·m, largest moment that will act
  Scalar position_tolerance;     ///< m, largest allowed error at the TCP
  Scalar orientation_tolerance;  ///< rad
  Scalar largest_gain = 0;       ///< largest safe correction gain, 0 if not analysed
  GainBasis gain_basis = {};  ///< path: what that gain follows from; all zero if not to be stated
};

/// A certificate: over the whole chart, for any wrench within the bounds, neither the predicted
/// deflection nor the TCP after correction is further from the model's than this.
template <typename Scalar>
struct TableError {
  Scalar position = 0;     ///< m
  Scalar orientation = 0;  ///< rad
};

/// Angles of one joint that a grid covers; a range of zero width fixes the joint there.
template <typename Scalar>
struct GridRange {
  Scalar lower;  ///< rad
  Scalar upper;  ///< rad
};

/// Builds a path table into `buffer` (`capacity` bytes, 4-byte aligned).
///
/// The program is the polyline through `points` in joint space; nodes are set along it as far apart
/// as the tolerance allows, and at its corners. The certificate is not a sample: between the points
/// where the error is computed, the second derivative of error along the program is bounded in
/// closed form from the robot's link lengths and springs, and what it can add is part of the bound,
/// as is the rounding of `float` arithmetic in the lookup. Beside it stands a second certificate,
/// for all angles that a lookup takes for inside (`inside_error`).
///
/// Cost: some thousand evaluations of the model a node; no memory but the buffer and about 4 KiB of
/// stack. Returns ok, bad_argument, bad_model, bad_path, buffer_too_small or tolerance_not_met
/// (which also means: base, link or tool springs give at a singular posture, where no joint motion
/// can make up for it). `size` receives the bytes used; the buffer holds no valid table unless ok.
template <typename Scalar, int Joints>
Result build_path_table(const RobotModel<Scalar, Joints>& model,
                        const JointVector<Scalar, Joints>* points, std::size_t count,
                        const TableRequirements<Scalar>& requirements, void* buffer,
                        std::size_t capacity, std::size_t* size);

/// Builds a joint-grid table over joints 2 to 5 (`ranges[0]` to `ranges[3]`), as `build_path_table`
/// otherwise. Joints 1 and 6 turn the result exactly and may have any angle, for which the model
/// must allow it: no base, link or tool springs, the TCP on the last axis, and weight, if it acts,
/// along axis 1 with the last link and payload balanced about theirs; else chart_not_invariant.
template <typename Scalar, int Joints>
Result build_grid_table(const RobotModel<Scalar, Joints>& model,
                        const GridRange<Scalar> (&ranges)[4],
                        const TableRequirements<Scalar>& requirements, void* buffer,
                        std::size_t capacity, std::size_t* size);

/// Does a table's header say of the robot what the model says? All that a tick reads of it is
/// looked at: fingerprint, springs, joint limits, contents, first axis, whether the program is
/// closed, that the largest gain follows from the process that is stated with it, and that bounds
/// and unused fields are as a builder writes them. `Table::open` cannot know this, and the
/// fingerprint alone is a claim that anyone can copy into a table.
///
/// Exact: a table of another robot is refused, however little it differs. A largest gain without a
/// process (of an older table, or given by who built it) is taken as it is. Cost: some thousand
/// operations, and a millisecond on a PC where a process is stated. Returns ok, bad_argument (no
/// table), bad_model, table_other_model (the header says something else of the robot) or
/// table_corrupt (no builder writes such a header).
template <typename Scalar, int Joints>
Result check_against_model(const RobotModel<Scalar, Joints>& model, const Table& table);

/// Derives a table's certificate again, from its own nodes and the model alone, as its builder did:
/// the errors at the nodes and on the chords between them, what lies between the points looked at,
/// and rounding. The certificate holds if `error` is not above what the header states; the
/// derivation ends where it is.
///
/// Not seen are the program's deviations from the chords, which the builder looks at too: a path
/// table does not hold its program. `derive_inside_error` bounds what they can do. Returns ok, or
/// what `check_against_model` returns, or table_corrupt: planes or widths that no builder writes,
/// or an error stated a hundred times above what is found. Cost: as for building the table, without
/// the attempts. For tables that were built in `float` and in `double`; to be run in `double`.
template <typename Scalar, int Joints>
Result derive_certificate(const RobotModel<Scalar, Joints>& model, const Table& table,
                          TableError<Scalar>* error);

/// Derives again, from nodes, widths and model, the largest error at any joint angles that a tick
/// takes for inside a path table (of a grid: `derive_certificate`). The planes in the records need
/// not be believed for it: wherever they put the angles along a chord, a tick takes them only if
/// they lie within the width of that place. Holds if `error` is not above what `inside_error` of
/// the header states, where it does; the derivation ends where it is. Returns ok, or what
/// `check_against_model` returns, or table_corrupt: an error stated more than twice what is found.
/// Cost: some hundred evaluations of the model a node.
template <typename Scalar, int Joints>
Result derive_inside_error(const RobotModel<Scalar, Joints>& model, const Table& table,
                           TableError<Scalar>* error);

/// Largest error of the table against the model at joint angles `q`, for the worst wrench within
/// the table's bounds: the second look at a certificate.
template <typename Scalar, int Joints>
TableError<Scalar> table_error_at(const RobotModel<Scalar, Joints>& model, const Table& table,
                                  const JointVector<Scalar, Joints>& q, TableCursor* cursor);

/// Joint angles at a place of the chart: `place` has one number in [0, 1] for the path, or one for
/// each grid axis.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> chart_angles(const Table& table, const Scalar (&place)[kMaxGridAxes]);

}  // namespace flexcomp
