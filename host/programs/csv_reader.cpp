#include "programs/csv_reader.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "recording/csv.hpp"

namespace flexcomp::programs {
namespace {

using Row = std::vector<double>;

class CsvReader {
 public:
  CsvReader(const recording::NumberTable& table, Program* program)
      : table_(table), program_(*program) {}

  void read() {
    refuse_unknown_columns();
    position_ = group<3>({"x", "y", "z"});
    axis_ = group<3>({"i", "j", "k"});
    quaternion_ = group<4>({"qw", "qx", "qy", "qz"});
    feed_ = column("feed");
    rapid_ = column("rapid");
    if (!position_) {
      refuse(table_.file, 1, "columns x, y and z are missing");
    }
    if (axis_ && quaternion_) {
      refuse(table_.file, 1, "either i,j,k or qw,qx,qy,qz, not both");
    }
    program_.has_free_spin = !quaternion_;
    program_.motions.reserve(table_.rows.size());
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      read_row(row);
    }
  }

 private:
  static constexpr std::array<const char*, 12> kColumns = {"x",  "y",  "z",  "i",  "j",    "k",
                                                           "qw", "qx", "qy", "qz", "feed", "rapid"};

  void refuse_unknown_columns() const {
    for (const std::string& name : table_.columns) {
      if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end()) {
        refuse(table_.file, 1,
               fmt::format("column '{}' is unknown; expected x,y,z, i,j,k or qw,qx,qy,qz, feed, "
                           "rapid",
                           files::one_line(name)));
      }
    }
  }

  std::optional<std::size_t> column(const std::string& name) const {
    const auto found = std::find(table_.columns.begin(), table_.columns.end(), name);
    return found == table_.columns.end()
               ? std::nullopt
               : std::optional<std::size_t>(found - table_.columns.begin());
  }

  template <std::size_t Count>
  std::optional<std::array<std::size_t, Count>> group(
      const std::array<const char*, Count>& names) const {
    std::array<std::size_t, Count> columns{};
    std::size_t found = 0;
    std::string missing;
    for (std::size_t i = 0; i < Count; ++i) {
      if (const auto at = column(names[i])) {
        columns[i] = *at;
        ++found;
      } else {
        missing = names[i];
      }
    }
    if (found == 0) {
      return std::nullopt;
    }
    if (found < Count) {
      refuse(table_.file, 1,
             fmt::format("column '{}' is missing; {} to {} belong together", missing, names.front(),
                         names.back()));
    }
    return columns;
  }

  double cell(std::size_t row, std::size_t at) const {
    const double value = table_.rows[row][at];
    if (std::isnan(value)) {
      refuse(table_.file, table_.line(row),
             fmt::format("column '{}': a number is missing", table_.columns[at]));
    }
    return value;
  }

  void read_row(std::size_t row) {
    Motion motion;
    motion.kind = rapid_ && cell(row, *rapid_) != 0 ? MotionKind::rapid : MotionKind::linear;
    for (std::size_t i = 0; i < 3; ++i) {
      motion.end.position[static_cast<Eigen::Index>(i)] = cell(row, (*position_)[i]);
    }
    motion.end.rotation = orientation(row);
    if (feed_ && !std::isnan(table_.rows[row][*feed_])) {
      last_feed_ = table_.rows[row][*feed_];
      if (!(last_feed_ > 0)) {
        refuse(table_.file, table_.line(row), "column 'feed': a feed must be above zero");
      }
    }
    motion.feed = motion.kind == MotionKind::rapid ? 0 : last_feed_;
    motion.is_cutting = motion.kind != MotionKind::rapid;
    motion.line = table_.line(row);
    append(motion, &program_);
  }

  Matrix3<double> orientation(std::size_t row) const {
    if (quaternion_) {
      const auto& at = *quaternion_;
      const Eigen::Quaterniond q(cell(row, at[0]), cell(row, at[1]), cell(row, at[2]),
                                 cell(row, at[3]));
      refuse_unless_direction(row, q.norm(), "qw");
      return q.normalized().toRotationMatrix();
    }
    Vector3<double> axis = Vector3<double>::UnitZ();
    if (axis_) {
      axis = {cell(row, (*axis_)[0]), cell(row, (*axis_)[1]), cell(row, (*axis_)[2])};
      refuse_unless_direction(row, axis.norm(), "i");
    }
    return orientation_by_axis(axis.normalized());
  }

  void refuse_unless_direction(std::size_t row, double length, const char* name) const {
    if (!(length > 1e-6 && length < 1e6)) {
      refuse(table_.file, table_.line(row),
             fmt::format("column '{}': no direction has this length", name));
    }
  }

  const recording::NumberTable& table_;
  Program& program_;
  std::optional<std::array<std::size_t, 3>> position_;
  std::optional<std::array<std::size_t, 3>> axis_;
  std::optional<std::array<std::size_t, 4>> quaternion_;
  std::optional<std::size_t> feed_;
  std::optional<std::size_t> rapid_;
  double last_feed_ = 0;
};

}  // namespace

Program read_cartesian_csv(const std::filesystem::path& file) {
  const recording::NumberTable table = recording::read_csv(file);
  Program program;
  program.format = Format::csv;
  program.file = file.string();
  CsvReader(table, &program).read();
  return program;
}

}  // namespace flexcomp::programs
