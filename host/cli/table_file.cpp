#include "cli/table_file.hpp"

#include <fmt/format.h>

#include <cstring>

#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::cli {

TableFile read_table(const std::filesystem::path& path, const model::Robot& robot) {
  const std::string bytes = files::read_file(path, std::size_t{1} << 30);
  TableFile file;
  file.words.resize((bytes.size() + 3) / 4);
  std::memcpy(file.words.data(), bytes.data(), bytes.size());
  const Result opened = Table::open(file.words.data(), bytes.size(), &file.table);
  if (opened != Result::ok) {
    throw InputError(fmt::format("{}: {}", path.string(), describe(opened)));
  }
  if (file.table.model_hash() != model_hash(robot.elastic)) {
    throw InputError(fmt::format("{}: {}", path.string(), describe(Result::table_other_model)));
  }
  return file;
}

}  // namespace flexcomp::cli
