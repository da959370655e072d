#include "programs/csv_writer.hpp"

#include <Eigen/Geometry>

#include "programs/rewriting.hpp"
#include "recording/csv.hpp"

namespace flexcomp::programs {
namespace {

void add_row(const Pose<double>& pose, const Motion& motion, std::string* text) {
  const Eigen::Quaterniond q(pose.rotation);
  for (const double value :
       {pose.position.x(), pose.position.y(), pose.position.z(), q.w(), q.x(), q.y(), q.z()}) {
    recording::append_number(value, text);
    *text += ',';
  }
  if (motion.feed > 0) {
    recording::append_number(motion.feed, text);
  }
  *text += motion.kind == MotionKind::rapid ? ",1\n" : ",0\n";
}

}  // namespace

std::string csv_text(const CorrectedProgram& program) {
  std::string text = "x,y,z,qw,qx,qy,qz,feed,rapid\n";
  for (std::size_t i = 0; i < program.in_place.size(); ++i) {
    visit_in_place(program, i, [&](const Pose<double>& start, const Motion& each, bool) {
      const int steps = chords_of(start, each);
      for (int step = 1; step <= steps; ++step) {
        add_row(pose_at(start, each, static_cast<double>(step) / steps), each, &text);
      }
    });
  }
  return text;
}

}  // namespace flexcomp::programs
