#include "cli/table_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>

#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/loop_gain.hpp"
#include "messages/table_trailer.hpp"

namespace flexcomp::cli {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: {}", path.string(), why));
}

}  // namespace

TableFile read_any_table(const std::filesystem::path& path) {
  const std::string bytes = files::read_file(path, std::size_t{1} << 30);
  TableFile file;
  file.words.resize((bytes.size() + 3) / 4);
  std::memcpy(file.words.data(), bytes.data(), bytes.size());
  const Result opened =
      Table::open(file.words.data(), bytes_of_table(bytes.data(), bytes.size()), &file.table);
  if (opened != Result::ok) {
    refuse(path, describe(opened));
  }
  return file;
}

TableFile read_unproven_table(const std::filesystem::path& path, const model::Robot& robot) {
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  TableFile file = read_any_table(path);
  if (file.table.model_hash() != model_hash(elastic)) {
    refuse(path, describe(Result::table_other_model));
  }
  switch (check_against_model<double, 6>(elastic, file.table)) {
    case Result::ok:
      return file;
    case Result::table_other_model:
      refuse(path,
             "bears the model's fingerprint, but its springs, joint limits, contents or first axis "
             "are not the model's");
    default:
      refuse(path,
             "no table: its header holds what flexcomp never writes, or a largest gain that does "
             "not follow from the process beside it");
  }
}

Certificate derive_certificate(const std::filesystem::path& path, const model::Robot& robot,
                               const Table& table) {
  Certificate certificate;
  const Result derived = flexcomp::derive_certificate<double, 6>(model::six_axis_model(robot),
                                                                 table, &certificate.error);
  if (derived != Result::ok) {
    refuse(path, fmt::format("no table of this model: {}", describe(derived)));
  }
  const InsideError stated = inside_error(table.header());
  certificate.states_inside = stated.position > 0 || table.header().position_error == 0;
  if (table.chart() == Chart::path &&
      derive_inside_error<double, 6>(model::six_axis_model(robot), table, &certificate.inside) !=
          Result::ok) {
    refuse(path, "no table of this model: its bound for angles off the program is no builder's");
  }
  certificate.inside_holds =
      !certificate.states_inside || (certificate.inside.position <= stated.position &&
                                     certificate.inside.orientation <= stated.orientation);
  certificate.holds = certificate.inside_holds &&
                      certificate.error.position <= table.header().position_error &&
                      certificate.error.orientation <= table.header().orientation_error;
  return certificate;
}

nlohmann::ordered_json to_json(const Table& table) {
  const TableHeader& header = table.header();
  const InsideError inside = inside_error(header);
  const GainBasis basis = gain_basis(header);
  nlohmann::ordered_json json = {{"chart", table.chart() == Chart::path ? "path" : "joint_grid"},
                                 {"nodes", header.node_count},
                                 {"bytes", header.size},
                                 {"model_hash", fmt::format("{:016x}", table.model_hash())},
                                 {"force_bound", header.force_bound},
                                 {"moment_bound", header.moment_bound},
                                 {"certified_position_error", header.position_error},
                                 {"certified_orientation_error", header.orientation_error},
                                 {"certified_inside_position_error", inside.position},
                                 {"certified_inside_orientation_error", inside.orientation},
                                 {"largest_gain", header.largest_gain}};
  if (!is_empty(basis)) {
    json["gain_basis"] = {{"least_push", basis.least_push},       {"most_push", basis.most_push},
                          {"depth_of_cut", basis.depth_of_cut},   {"period", basis.period},
                          {"filter_cutoff", basis.filter_cutoff}, {"delay", basis.delay}};
  }
  return json;
}

TableFile read_table(const std::filesystem::path& path, const model::Robot& robot) {
  TableFile file = read_unproven_table(path, robot);
  if (!derive_certificate(path, robot, file.table).holds) {
    refuse(path, "its certificate does not hold for this model (flexcomp table verify)");
  }
  return file;
}

}  // namespace flexcomp::cli
