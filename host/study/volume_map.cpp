#include "study/volume_map.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <ostream>
#include <system_error>
#include <thread>

#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/compliance.hpp"
#include "geometry/circularity.hpp"
#include "parallel/in_parallel.hpp"
#include "planning/inverse_kinematics.hpp"

namespace flexcomp::study {
namespace {

constexpr double kMostCircles = 1e8;
constexpr double kLargestTurn = 0.35;  // rad from point to point: no change of branch
constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

using Angles = JointVector<double, 6>;

/// Directions in the plane across a tool axis: first × second = −tool axis.
Matrix3<double> plane_across(const Vector3<double>& tool_axis) {
  const Vector3<double> normal = -tool_axis;
  const Vector3<double> aim =
      std::abs(normal.x()) < 0.9 ? Vector3<double>::UnitX() : Vector3<double>::UnitZ();
  Matrix3<double> frame;
  frame.col(0) = (aim - aim.dot(normal) * normal).normalized();
  frame.col(1) = normal.cross(frame.col(0));
  frame.col(2) = normal;
  return frame;
}

/// Circles of one direction of the tool, each in the posture farthest from the joint limits that
/// can mill all of it.
class Miller {
 public:
  Miller(const RobotModel<double, 6>& model, const MilledCircle& circle,
         const Vector3<double>& tool_axis)
      : model_(model), circle_(circle), plane_(plane_across(tool_axis)) {
    orientation_.col(2) = tool_axis;
    orientation_.col(0) = plane_.col(0);
    orientation_.col(1) = tool_axis.cross(plane_.col(0));
  }

  /// m; NaN where out of reach.
  double circularity(const Vector3<double>& center) const {
    for (const Angles& start : planning::solve_all(model_, first_pose(center))) {
      const double value = from(start, center);
      if (!std::isnan(value)) {
        return value;
      }
    }
    return kNowhere;
  }

 private:
  Vector3<double> offset(int point) const {
    const double angle = 2 * M_PI * point / circle_.points;
    return circle_.radius * (std::cos(angle) * plane_.col(0) + std::sin(angle) * plane_.col(1));
  }

  Pose<double> first_pose(const Vector3<double>& center) const {
    return {orientation_, circle_.is_first_order ? center : center + offset(0)};
  }

  double from(const Angles& start, const Vector3<double>& center) const {
    geometry::Points points;
    std::optional<Angles> q = start;
    for (int i = 0; i < circle_.points; ++i) {
      if (i > 0 && !circle_.is_first_order) {
        const Angles before = *q;
        q = planning::solve_near(model_, {orientation_, center + offset(i)}, before);
        if (q && (*q - before).cwiseAbs().maxCoeff() > kLargestTurn) {
          return kNowhere;
        }
      }
      if (!q) {
        return kNowhere;
      }
      const Vector3<double> bent =
          offset(i) + deflection<double, 6>(model_, *q, wrench(i)).tcp.template head<3>();
      points.emplace_back(plane_.col(0).dot(bent), plane_.col(1).dot(bent));
    }
    return geometry::least_squares_circularity(points).value();
  }

  Wrench<double> wrench(int point) const {
    const double sense = circle_.sense == WrenchSense::with_path ? 1 : -1;
    const double angle = sense * 2 * M_PI * point / circle_.points;
    const Matrix3<double> turned =
        plane_ * Eigen::AngleAxisd(angle, Vector3<double>::UnitZ()).toRotationMatrix();
    Wrench<double> all;
    all << turned * circle_.force, turned * circle_.moment;
    return all;
  }

  const RobotModel<double, 6>& model_;
  const MilledCircle& circle_;
  Matrix3<double> plane_;
  Matrix3<double> orientation_;
};

std::filesystem::path layer_file(const std::filesystem::path& folder, std::size_t layer) {
  return folder / fmt::format("layer-{:06}", layer);
}

std::optional<std::vector<double>> read_layer(const std::filesystem::path& file,
                                              std::size_t count) {
  std::error_code ignored;
  if (std::filesystem::file_size(file, ignored) != count * sizeof(double) || ignored) {
    return std::nullopt;
  }
  const std::string bytes = files::read_file(file, count * sizeof(double));
  std::vector<double> values(count);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

void write_layer(const std::filesystem::path& file, const std::vector<double>& values) {
  files::write_file(file, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(double)));
  });
}

}  // namespace

VolumeMap::VolumeMap(RobotModel<double, 6> model, VolumeRequest request)
    : model_(std::move(model)), request_(std::move(request)) {
  const Vector3<double> size = request_.upper - request_.lower;
  if (!(request_.step > 0) || !size.allFinite() || !(size.minCoeff() >= 0) ||
      !request_.lower.allFinite()) {
    throw InputError("the box must not be turned inside out, and its step must be above zero");
  }
  const Eigen::Array3d counts = (size.array() / request_.step + 1e-9).floor() + 1;
  if (!(counts.prod() * static_cast<double>(request_.tool_axes.size()) < kMostCircles)) {
    throw InputError("the box has too many nodes: at most 1e8 circles");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    count_[i] = static_cast<int>(counts[static_cast<Eigen::Index>(i)]);
  }
  for (Vector3<double>& axis : request_.tool_axes) {
    if (!(axis.norm() > 0) || !axis.allFinite()) {
      throw InputError("a tool axis must be a direction, not zero");
    }
    axis.normalize();
  }
  if (request_.tool_axes.empty()) {
    throw InputError("a volume needs tool axes");
  }
  check(request_.circle);
  if (!request_.circle.has_limits) {
    for (Joint<double>& joint : model_.joints) {
      joint.lower = -M_PI;
      joint.upper = M_PI;
    }
  }
}

std::size_t VolumeMap::layers() const {
  return static_cast<std::size_t>(count_[2]) * request_.tool_axes.size();
}

std::size_t VolumeMap::circles() const {
  return layers() * static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]);
}

const Vector3<double>& VolumeMap::tool_axis(std::size_t layer) const {
  return request_.tool_axes[layer / static_cast<std::size_t>(count_[2])];
}

Vector3<double> VolumeMap::node(std::size_t layer, std::size_t index) const {
  const auto columns = static_cast<std::size_t>(count_[0]);
  const auto heights = static_cast<std::size_t>(count_[2]);
  const std::size_t row = index / columns;
  const Vector3<double> steps(static_cast<double>(index % columns), static_cast<double>(row),
                              static_cast<double>(layer % heights));
  return request_.lower + request_.step * steps;
}

std::vector<double> VolumeMap::layer(std::size_t layer) const {
  const Miller miller(model_, request_.circle, tool_axis(layer));
  std::vector<double> values(static_cast<std::size_t>(count_[0]) *
                             static_cast<std::size_t>(count_[1]));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = miller.circularity(node(layer, i));
  }
  return values;
}

std::string VolumeMap::fingerprint() const {
  std::uint64_t hash = model_hash(model_);
  const auto add = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3;
    hash ^= hash >> 29;
  };
  const MilledCircle& circle = request_.circle;
  const auto add_vector = [&](const Vector3<double>& vector) {
    std::for_each(vector.data(), vector.data() + 3, add);
  };
  for (const Vector3<double>& vector :
       {request_.lower, request_.upper, circle.force, circle.moment}) {
    add_vector(vector);
  }
  for (const Vector3<double>& axis : request_.tool_axes) {
    add_vector(axis);
  }
  for (const double value :
       {request_.step, circle.radius, static_cast<double>(circle.points),
        static_cast<double>(circle.sense == WrenchSense::with_path),
        static_cast<double>(circle.is_first_order), static_cast<double>(circle.has_limits)}) {
    add(value);
  }
  return fmt::format("{:016x}", hash);
}

namespace {

bool reads_as(const char* text, int* value) {
  const char* const end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, *value);
  return error == std::errc() && rest == end;
}

}  // namespace

Ranks ranks_from_environment() {
  constexpr std::array<std::array<const char*, 2>, 3> kNames = {
      {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
       {"PMI_RANK", "PMI_SIZE"},
       {"SLURM_PROCID", "SLURM_NTASKS"}}};
  for (const auto& [rank_name, size_name] : kNames) {
    const char* rank = std::getenv(rank_name);
    const char* size = std::getenv(size_name);
    if (rank != nullptr && size != nullptr) {
      Ranks ranks;
      if (reads_as(rank, &ranks.rank) && reads_as(size, &ranks.size) && ranks.rank >= 0 &&
          ranks.rank < ranks.size) {
        return ranks;
      }
    }
  }
  return {};
}

std::vector<std::vector<double>> compute_layers(
    const VolumeMap& map, const std::filesystem::path& folder, const Ranks& ranks,
    const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::size_t layers = map.layers();
  const std::size_t count =
      static_cast<std::size_t>(map.columns()) * static_cast<std::size_t>(map.rows());
  std::vector<std::size_t> missing;
  for (std::size_t i = static_cast<std::size_t>(ranks.rank); i < layers;
       i += static_cast<std::size_t>(ranks.size)) {
    if (!read_layer(layer_file(folder, i), count)) {
      missing.push_back(i);
    }
  }
  std::mutex writing;
  in_parallel(missing.size(), progress, [&](std::size_t i) {
    const std::vector<double> values = map.layer(missing[i]);
    const std::lock_guard<std::mutex> lock(writing);
    write_layer(layer_file(folder, missing[i]), values);
  });
  std::vector<std::vector<double>> all;
  // The others may still be at work; if one of them fails, mpirun ends this one too.
  while (ranks.rank == 0 && all.size() < layers) {
    std::optional<std::vector<double>> next = read_layer(layer_file(folder, all.size()), count);
    if (next) {
      all.push_back(std::move(*next));
      progress(all.size(), layers);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  return all;
}

}  // namespace flexcomp::study
