#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.hpp"
#include "cli/position_columns.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "model/robot.hpp"
#include "report/circle_report.hpp"

namespace flexcomp::cli {
namespace {

struct ReportOptions {
  RobotChoice model;
  std::string table;
  std::string out;
  std::vector<std::string> recordings;
  std::vector<std::string> columns;
};

/// "name=file".
report::NamedCircle read_circle(const std::string& argument,
                                const std::vector<std::string>& columns, std::string* plane) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(fmt::format("--recording: expected NAME=FILE, found '{}'", argument));
  }
  const recording::NumberTable table = recording::read_csv(argument.substr(equals + 1));
  const std::array<std::string, 2> axes = plane_columns(table, columns);
  *plane = axes[0] + ", " + axes[1];
  return {argument.substr(0, equals), points_in(table, axes)};
}

int run(const ReportOptions& options) {
  const model::Robot robot = load_robot(options.model);
  report::CircleReport page;
  page.robot = robot.name;
  for (const std::string& argument : options.recordings) {
    page.circles.push_back(read_circle(argument, options.columns, &page.plane));
  }
  std::optional<TableFile> table;
  if (!options.table.empty()) {
    table = read_table(options.table, robot);
    page.table = &table->table;
  }
  const std::string html = report::circle_report_html(page);
  files::write_text(options.out, html);
  fmt::print("{}: {} circle{}\n", options.out, page.circles.size(),
             page.circles.size() == 1 ? "" : "s");
  return kDone;
}

}  // namespace

void add_report(CLI::App* app, Action* action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app->add_subcommand(
      "report",
      "Recorded circles side by side on one self-contained HTML page: circularity, the polar plot "
      "with\n"
      "deviations magnified, the deviation along the circle, the table's certificate.\n"
      "Example: flexcomp report --model robot.yaml --recording before=a.csv --recording "
      "after=b.csv \\\n"
      "           --columns x,z --table t.fct --out report.html");
  add_robot(command, &options->model)->required();
  command
      ->add_option("--recording", options->recordings,
                   "a circle to show; again for more, compared with the first")
      ->type_name("NAME=FILE")
      ->required();
  command->add_option("--columns", options->columns, "the two columns of the circle's plane")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--table", options->table, "table whose certificate to print");
  command->add_option("--out", options->out, "page to write")->required();
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
