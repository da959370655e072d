#include "table_writer.hpp"

#include <cmath>
#include <limits>

#include "checked_number.hpp"
#include "crc32.hpp"
#include "flexcomp/loop_gain.hpp"
#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// The next float not below `value`: a certificate may only be rounded up.
template <typename Scalar>
float rounded_up(Scalar value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<Scalar>(nearest) < value
             ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
             : nearest;
}

}  // namespace

template <typename Scalar, int Joints>
TableWriter::TableWriter(const RobotModel<Scalar, Joints>& model,
                         const TableRequirements<Scalar>& requirements, Chart chart, void* buffer,
                         std::size_t capacity)
    : layout_(record_layout(chart, has_weight(model), has_structure_springs(model))),
      header_(static_cast<TableHeader*>(buffer)),
      records_(reinterpret_cast<float*>(header_ + 1)),
      capacity_(capacity) {
  *header_ = TableHeader{};
  const std::uint64_t hash = model_hash(model);
  header_->model_hash_low = static_cast<std::uint32_t>(hash);
  header_->model_hash_high = static_cast<std::uint32_t>(hash >> 32);
  header_->chart = static_cast<std::uint32_t>(chart);
  header_->contents =
      (layout_.has_weight ? Table::kWeight : 0U) | (layout_.has_structure ? Table::kStructure : 0U);
  header_->joints = Joints;
  header_->record_size = layout_.size;
  for (std::size_t i = 0; i < Joints; ++i) {
    header_->joint_lower[i] = nearest_finite(model.joints[i].lower);
    header_->joint_upper[i] = nearest_finite(model.joints[i].upper);
    header_->compliance[i] = static_cast<float>(model.joints[i].compliance);
    header_->cubic_compliance[i] = static_cast<float>(model.joints[i].cubic_compliance);
  }
  header_->force_bound = static_cast<float>(requirements.force_bound);
  header_->moment_bound = static_cast<float>(requirements.moment_bound);
  header_->largest_gain = static_cast<float>(requirements.largest_gain);
  if (chart == Chart::path) {
    set_gain_basis(requirements.gain_basis, header_);
  }
}

template <typename Scalar>
void TableWriter::state_inside_error(const TableError<Scalar>& error) {
  set_inside_error({rounded_up(error.position), rounded_up(error.orientation)}, header_);
}

bool TableWriter::fits(std::uint64_t nodes) const {
  return sizeof(TableHeader) + sizeof(float) * layout_.size * nodes <= capacity_;
}

template <typename Scalar>
void TableWriter::finish(std::uint32_t nodes, const TableError<Scalar>& error) {
  header_->node_count = nodes;
  header_->position_error = rounded_up(error.position);
  header_->orientation_error = rounded_up(error.orientation);
  header_->size =
      static_cast<std::uint32_t>(sizeof(TableHeader) + sizeof(float) * layout_.size * nodes);
  header_->magic = Table::kMagic;
  header_->version = kTableVersion;
  header_->crc = 0;
  header_->crc = crc32(header_, header_->size);
}

template <typename Scalar, int Joints>
Result check_build_arguments(const RobotModel<Scalar, Joints>& model,
                             const TableRequirements<Scalar>& requirements, const void* buffer,
                             std::size_t capacity, const std::size_t* size) {
  const bool valid =
      buffer != nullptr && size != nullptr &&
      reinterpret_cast<std::uintptr_t>(buffer) % alignof(TableHeader) == 0 &&
      std::isfinite(requirements.force_bound) && requirements.force_bound >= Scalar(0) &&
      std::isfinite(requirements.moment_bound) && requirements.moment_bound >= Scalar(0) &&
      is_positive(requirements.force_bound + requirements.moment_bound) &&
      is_positive(requirements.position_tolerance) &&
      is_positive(requirements.orientation_tolerance) && std::isfinite(requirements.largest_gain) &&
      requirements.largest_gain >= Scalar(0) &&
      follows_from(static_cast<double>(requirements.largest_gain), requirements.gain_basis);
  if (!valid) {
    return Result::bad_argument;
  }
  if (capacity < sizeof(TableHeader)) {
    return Result::buffer_too_small;
  }
  return validate(model);
}

template void TableWriter::state_inside_error(const TableError<float>&);
template void TableWriter::state_inside_error(const TableError<double>&);
template void TableWriter::finish(std::uint32_t, const TableError<float>&);
template void TableWriter::finish(std::uint32_t, const TableError<double>&);

#define FLEXCOMP_TABLE_WRITER(Scalar, Joints)                                                     \
  template TableWriter::TableWriter(const RobotModel<Scalar, Joints>&,                            \
                                    const TableRequirements<Scalar>&, Chart, void*, std::size_t); \
  template Result check_build_arguments(const RobotModel<Scalar, Joints>&,                        \
                                        const TableRequirements<Scalar>&, const void*,            \
                                        std::size_t, const std::size_t*);
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE_WRITER)

}  // namespace flexcomp
