#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexcomp/types.hpp"

/// Programs of machines and robots: read from a file, and written with what was corrected.
namespace flexcomp::programs {

/// Units of programs in SI units.
constexpr double kDegree = 3.14159265358979323846 / 180;  ///< rad
constexpr double kMillimetre = 1e-3;                      ///< m
constexpr double kInch = 0.0254;                          ///< m

enum class Format { gcode, krl, rapid, csv };

enum class MotionKind {
  rapid,     ///< to the end as fast as may be; no cut
  linear,    ///< straight, the orientation by one rotation
  circular,  ///< round an axis; a helix where the end is higher than the start
};

/// The circle of a circular motion.
struct Arc {
  Vector3<double> center = Vector3<double>::Zero();   ///< m, work frame
  Vector3<double> normal = Vector3<double>::UnitZ();  ///< unit
  double angle = 0;                                   ///< rad, above zero: anticlockwise about it
};

/// One motion, from the end of the motion before it.
struct Motion {
  MotionKind kind = MotionKind::rapid;
  /// TCP in the work frame, m; its z axis is where the tool points: into the work.
  Pose<double> end;
  Arc arc;
  double feed = 0;          ///< m/s; zero where the program does not say
  double turn_feed = 0;     ///< rad/s, of the orientation at most; zero where it does not say
  bool is_cutting = false;  ///< spindle on, and no rapid
  /// Does the program tell the place that it comes from? Else it is planned as straight from the
  /// end of the motion before it.
  bool has_known_start = true;
  std::size_t line = 0;  ///< of the file, from 1
  /// Bytes of the file's text that the motion's statement is: [begin, finish).
  std::size_t begin = 0;
  std::size_t finish = 0;
};

/// Something in a program that flexcomp leaves as it is, and a person should know of.
struct Note {
  std::size_t line = 0;
  std::string text;
};

struct Program {
  Format format = Format::gcode;
  std::string file;
  std::string text;  ///< the whole file, for writing it again
  std::vector<Motion> motions;
  /// Does it say where the tool points but not how it is turned about its own axis?
  bool has_free_spin = false;
  std::optional<Pose<double>> frame;  ///< the work frame in the robot base frame, if it says
  /// Does it load its work frame by a name or a number, or again behind its first motion? One that
  /// is written before that motion would then not last.
  bool loads_frame = false;
  /// External axes E1 to E6 as KRL tells them, mm or degrees. None of them moves.
  std::array<std::optional<double>, 6> external{};
  std::vector<Note> notes;
};

/// Where the TCP is at a share (0 to 1) of a motion that begins at `start`.
Pose<double> pose_at(const Pose<double>& start, const Motion& motion, double share);

/// Length of the TCP's way along a motion, m.
double length_of(const Pose<double>& start, const Motion& motion);

/// The angle of the rotation between two orientations, rad.
double turn_between(const Matrix3<double>& from, const Matrix3<double>& to);

/// Turning by a radian counts as much as going this far (m): rapids, accelerations, tolerances.
constexpr double kTurningLever = 0.1;

/// How far a motion goes, m: its length, or what its turning counts if that is more.
double way_of(const Pose<double>& start, const Motion& motion);

/// The arc from one point to another by a third between; nothing if they lie on a line, or are the
/// same.
std::optional<Arc> arc_through(const Vector3<double>& start, const Vector3<double>& between,
                               const Vector3<double>& end);

/// Turns a circular motion's end and arc to an angle (rad) round from its start; backwards where it
/// is below zero.
void go_round(const Pose<double>& start, double angle, Motion* motion);

/// Where the smallest rotation turns a tool that points down (against z) to where `axis` (unit,
/// from the tip towards the spindle, as CAM systems give it) asks for. The TCP's x axis is the work
/// frame's where the axis is z.
Matrix3<double> orientation_by_axis(const Vector3<double>& axis);

/// A program whose text is known and whose motions are not read yet. `file`: for messages.
Program unread(Format format, const std::string& file, std::string text);

/// Adds a motion to a program; throws InputError with its line if it goes to a place (100 km) or at
/// a feed (10 km/s) beyond those of any machine, which no later step needs to compute with.
void append(const Motion& motion, Program* program);

/// Throws InputError: "file:line: why".
[[noreturn]] void refuse(const std::string& file, std::size_t line, const std::string& why);

}  // namespace flexcomp::programs
