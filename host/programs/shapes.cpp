#include "programs/shapes.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::programs {
namespace {

class Builder {
 public:
  explicit Builder(const Matrix3<double>& orientation) : orientation_(orientation) {
    program_.file = "the shape";
    program_.has_free_spin = true;
  }

  void add(MotionKind kind, const Vector3<double>& end) {
    Motion motion;
    motion.kind = kind;
    motion.end = {orientation_, end};
    motion.is_cutting = kind != MotionKind::rapid;
    motion.line = program_.motions.size() + 1;
    program_.motions.push_back(motion);
  }

  Program take() { return std::move(program_); }

 private:
  Matrix3<double> orientation_;
  Program program_;
};

void refuse_impossible(const Pocket& pocket) {
  const bool is_possible = pocket.depth > 0 && pocket.diameter > 0 && pocket.step_over > 0 &&
                           pocket.step_over <= 1 && pocket.step_down > 0 && pocket.clearance > 0 &&
                           pocket.length >= pocket.diameter && pocket.width >= pocket.diameter;
  const double rings =
      std::max(pocket.length, pocket.width) / std::max(pocket.step_over * pocket.diameter, 1e-12);
  constexpr double kMost = 1e6;  // rectangles
  if (!is_possible || !(rings * pocket.depth / pocket.step_down < kMost)) {
    throw InputError(
        "the pocket: expected sizes above zero, a tool that fits into it, and steps that are no "
        "larger than it");
  }
}

/// Rectangles from the middle, which is a line or a point, to the wall.
void add_level(const Pocket& pocket, double z, Builder* builder) {
  const double half_length = (pocket.length - pocket.diameter) / 2;
  const double half_width = (pocket.width - pocket.diameter) / 2;
  const double inset = std::min(half_length, half_width);
  const int rings =
      std::max(1, static_cast<int>(std::ceil(inset / (pocket.step_over * pocket.diameter) - 1e-9)));
  for (int ring = 0; ring <= rings; ++ring) {
    const double in = inset * (1 - static_cast<double>(ring) / rings);
    const double x = half_length - in;
    const double y = half_width - in;
    builder->add(MotionKind::linear, {-x, -y, z});
    builder->add(MotionKind::linear, {x, -y, z});
    builder->add(MotionKind::linear, {x, y, z});
    builder->add(MotionKind::linear, {-x, y, z});
    builder->add(MotionKind::linear, {-x, -y, z});
  }
}

}  // namespace

Program pocket_program(const Pocket& pocket) {
  refuse_impossible(pocket);
  Builder builder(orientation_by_axis(Vector3<double>::UnitZ()));
  const int levels = static_cast<int>(std::ceil(pocket.depth / pocket.step_down - 1e-9));
  const double inset = (std::min(pocket.length, pocket.width) - pocket.diameter) / 2;
  const Vector3<double> first(-(pocket.length - pocket.diameter) / 2 + inset,
                              -(pocket.width - pocket.diameter) / 2 + inset, 0);
  const Vector3<double> over = pocket.clearance * Vector3<double>::UnitZ();
  for (int level = 1; level <= levels; ++level) {
    const double z = -pocket.depth * level / levels;
    builder.add(MotionKind::rapid, first + over);
    builder.add(MotionKind::linear, {first.x(), first.y(), z});
    add_level(pocket, z, &builder);
    builder.add(MotionKind::rapid, Vector3<double>(-(pocket.length - pocket.diameter) / 2,
                                                   -(pocket.width - pocket.diameter) / 2, 0) +
                                       over);
  }
  return builder.take();
}

Program line_program(const Vector3<double>& from, const Vector3<double>& to,
                     const Vector3<double>& axis) {
  if (!((to - from).norm() > 1e-6)) {
    throw InputError("the line: expected two points");
  }
  Builder builder(orientation_by_axis(axis));
  builder.add(MotionKind::rapid, from);
  builder.add(MotionKind::linear, to);
  return builder.take();
}

}  // namespace flexcomp::programs
