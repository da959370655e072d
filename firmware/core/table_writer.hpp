#pragma once

#include <limits>

#include "table_certificate.hpp"

namespace flexcomp {

/// A limit that no float can hold is none, and a table holds finite numbers only.
template <typename Scalar>
float nearest_finite(Scalar value) {
  constexpr auto kMost = static_cast<Scalar>(std::numeric_limits<float>::max());
  return static_cast<float>(value < -kMost ? -kMost : value > kMost ? kMost : value);
}

/// A table under construction in the caller's buffer.
class TableWriter {
 public:
  /// Starts a table; `capacity` in bytes. `fits(n)` tells whether n nodes have room.
  template <typename Scalar, int Joints>
  TableWriter(const RobotModel<Scalar, Joints>& model,
              const TableRequirements<Scalar>& requirements, Chart chart, void* buffer,
              std::size_t capacity);

  const RecordLayout& layout() const { return layout_; }
  TableHeader& header() { return *header_; }
  bool fits(std::uint64_t nodes) const;
  float* record(std::uint32_t node) const {
    return records_ + static_cast<std::size_t>(node) * layout_.size;
  }

  /// Path: the error at all angles that a lookup takes for inside.
  template <typename Scalar>
  void state_inside_error(const TableError<Scalar>& error);

  /// Sets sizes, the certificate (rounded up to float) and the CRC; the buffer now holds a table.
  template <typename Scalar>
  void finish(std::uint32_t nodes, const TableError<Scalar>& error);

 private:
  RecordLayout layout_;
  TableHeader* header_;
  float* records_;
  std::size_t capacity_;
};

/// Are the arguments that all builders share in order?
template <typename Scalar, int Joints>
Result check_build_arguments(const RobotModel<Scalar, Joints>& model,
                             const TableRequirements<Scalar>& requirements, const void* buffer,
                             std::size_t capacity, const std::size_t* size);

}  // namespace flexcomp
