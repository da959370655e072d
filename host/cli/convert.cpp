#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/number_options.hpp"
#include "error.hpp"
#include "files/one_line.hpp"
#include "recording/clock_alignment.hpp"
#include "recording/column_map.hpp"

namespace flexcomp::cli {
namespace {

using recording::LoggedMessage;

struct ConvertOptions {
  std::vector<std::string> inputs;
  std::string out;
  std::vector<std::string> rules;
  recording::ForeignLayout layout;
  std::string interface = "can0";
  double start = 0;
  bool fd = false;
  bool corrected = false;
  bool json = false;
};

enum class Format { csv, candump, lcm };

Format format_of(const std::string& file) {
  const std::string extension = file.substr(std::min(file.rfind('.'), file.size()));
  if (extension == ".csv") {
    return Format::csv;
  }
  if (extension == ".log" || extension == ".candump") {
    return Format::candump;
  }
  if (extension == ".lcm" || extension == ".lcmlog") {
    return Format::lcm;
  }
  for (const char* other : {".mcap", ".db3", ".bag", ".parquet"}) {
    if (extension == other) {
      throw InputError(
          fmt::format("{0}: the Python package reads it: python3 -m flexcomp.convert "
                      "{0} --help",
                      file));
    }
  }
  throw InputError(
      file +
      ": expected a name that ends in .csv, .log (candump -L) or .lcmlog (lcm-logger), or --map");
}

std::vector<LoggedMessage> read_log(const std::string& file, recording::DecodingCounts* counts) {
  std::vector<LoggedMessage> messages =
      format_of(file) == Format::candump
          ? recording::decode(recording::read_candump_log(file), counts)
          : recording::decode(recording::read_lcm_log(file), counts);
  if (messages.empty()) {
    throw InputError(file + ": holds no message of flexcomp");
  }
  return messages;
}

/// All logs in the first one's time, with what each alignment came to.
std::vector<LoggedMessage> read_logs(const ConvertOptions& options,
                                     recording::DecodingCounts* counts,
                                     std::vector<recording::ClockAlignment>* alignments) {
  std::vector<LoggedMessage> all = read_log(options.inputs[0], counts);
  for (std::size_t i = 1; i < options.inputs.size(); ++i) {
    std::vector<LoggedMessage> next = read_log(options.inputs[i], counts);
    try {
      alignments->push_back(recording::align_clocks(all, next));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}, {}: {}", options.inputs[0], options.inputs[i], error.what()));
    }
    // The first log has the setpoints; a second copy of each would be a second row.
    next.erase(std::remove_if(next.begin(), next.end(),
                              [](const LoggedMessage& logged) {
                                return std::holds_alternative<SetpointMessage>(logged.message);
                              }),
               next.end());
    all = recording::merge(all, std::move(next), alignments->back());
  }
  return all;
}

void print(const ConvertOptions& options, std::size_t rows, const recording::DecodingCounts& counts,
           const std::vector<recording::ClockAlignment>& alignments, const std::string& left_out) {
  nlohmann::ordered_json clocks = nlohmann::ordered_json::array();
  for (const recording::ClockAlignment& alignment : alignments) {
    clocks.push_back({{"offset", alignment.offset},
                      {"rate", alignment.rate},
                      {"uncertainty", alignment.uncertainty}});
  }
  if (options.json) {
    const nlohmann::ordered_json json = {{"rows", rows},
                                         {"foreign", counts.foreign},
                                         {"rejected", counts.rejected},
                                         {"clocks", clocks},
                                         {"left_out", left_out}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}: {} rows\n", options.out, rows);
  for (std::size_t i = 0; i < alignments.size(); ++i) {
    fmt::print("{}: its clock is {:.6f} s behind, and {:.1f} ppm slower (± {:.1f} µs)\n",
               options.inputs[i + 1], alignments[i].offset, 1e6 * alignments[i].rate,
               1e6 * alignments[i].uncertainty);
  }
  if (counts.rejected > 0) {
    fmt::print("{} frames or events were damaged, repeated, late or of incomplete sets\n",
               counts.rejected);
  }
  if (!left_out.empty()) {
    fmt::print("left out, because no message carries it: {}\n", left_out);
  }
}

int log_to_csv(const ConvertOptions& options) {
  recording::DecodingCounts counts;
  std::vector<recording::ClockAlignment> alignments;
  const std::vector<LoggedMessage> messages = read_logs(options, &counts, &alignments);
  const recording::Recording rows =
      recording::to_recording(messages, options.corrected, options.inputs[0]);
  recording::write_recording(options.out, rows);
  print(options, static_cast<std::size_t>(rows.size()), counts, alignments, "");
  return kDone;
}

void write_log(const ConvertOptions& options, const std::vector<LoggedMessage>& messages) {
  if (format_of(options.out) == Format::candump) {
    recording::write_candump_log(options.out,
                                 encode_frames(messages, options.interface, options.fd));
  } else {
    recording::write_lcm_log(options.out, recording::encode_events(messages));
  }
}

/// A recording's rows as a log of a bus.
int rows_to_log(const ConvertOptions& options, const recording::Recording& rows) {
  write_log(options, to_messages(rows, std::llround(1e9 * options.start)));
  print(options, static_cast<std::size_t>(rows.size()), {}, {}, groups_without_message(rows));
  return kDone;
}

void print_mapped(const ConvertOptions& options, const recording::Mapped& mapped) {
  if (options.json) {
    const nlohmann::ordered_json json = {{"rows", mapped.recording.size()},
                                         {"left_out", mapped.left_out}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} rows\n", options.out, mapped.recording.size());
  if (!mapped.left_out.empty()) {
    constexpr std::size_t kLongest = 400;
    fmt::print("left out, because no rule names it: {}\n",
               files::one_line(fmt::format("{}", fmt::join(mapped.left_out, ", ")), kLongest));
  }
}

int foreign_to_csv(const ConvertOptions& options, const recording::Mapped& mapped) {
  recording::write_recording(options.out, mapped.recording);
  print_mapped(options, mapped);
  return kDone;
}

[[noreturn]] void ask_for_rules(const ConvertOptions& options) {
  const recording::ForeignTable table(options.inputs[0], options.layout);
  constexpr std::size_t kLongest = 400;
  throw InputError(
      fmt::format("{}: which column is which? Say it with --map, as in --map t=time:ms --map "
                  "'q_meas_*=joint*:deg'; it has {}",
                  options.inputs[0],
                  files::one_line(fmt::format("{}", fmt::join(table.columns(), ", ")), kLongest)));
}

int from_rows(const ConvertOptions& options) {
  const bool to_csv = format_of(options.out) == Format::csv;
  if (options.rules.empty()) {
    if (to_csv) {
      ask_for_rules(options);
    }
    return rows_to_log(options, recording::read_recording(options.inputs[0]));
  }
  const recording::Mapped mapped = recording::map_columns(
      recording::ForeignTable(options.inputs[0], options.layout), options.rules);
  return to_csv ? foreign_to_csv(options, mapped) : rows_to_log(options, mapped.recording);
}

int log_to_log(const ConvertOptions& options) {
  recording::DecodingCounts counts;
  std::vector<recording::ClockAlignment> alignments;
  const std::vector<LoggedMessage> messages = read_logs(options, &counts, &alignments);
  write_log(options, messages);
  print(options, messages.size(), counts, alignments, "");
  return kDone;
}

int run(const ConvertOptions& options) {
  const auto is_csv = [](const std::string& file) { return format_of(file) == Format::csv; };
  const bool has_rows = !options.rules.empty() || is_csv(options.inputs[0]);
  if (has_rows && options.inputs.size() > 1) {
    throw InputError("expected one recording, or logs of buses");
  }
  if (has_rows) {
    return from_rows(options);
  }
  for (const std::string& input : options.inputs) {
    if (is_csv(input)) {
      throw InputError(input + ": expected logs of buses only, or one recording");
    }
  }
  return is_csv(options.out) ? log_to_csv(options) : log_to_log(options);
}

}  // namespace

void add_convert(CLI::App* app, Action* action) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app->add_subcommand(
      "convert",
      "Between recordings and logs of buses, by the end of the names: .csv, .log or .candump\n"
      "(candump -L, classic and FD), .lcm or .lcmlog (lcm-logger). From a log: a row for every\n"
      "setpoint, with the wrench, joints and position that came before it. Several logs of one "
      "run:\n"
      "their clocks are aligned by the setpoints that all have seen.\n"
      "Example: flexcomp convert can.log force.lcmlog --out run.csv\n"
      "A table that others wrote becomes a recording by rules, one a column, or with * one for "
      "all\n"
      "joints; separator and decimal comma are found.\n"
      "Example: flexcomp convert axes.txt --map t=Time:ms --map 'q_meas_*=A*_pos:deg' --out "
      "run.csv\n"
      "ROS bags, MCAP and Parquet: python3 -m flexcomp.convert");
  command->add_option("inputs", options->inputs, "a recording, a table of others, or logs")
      ->required();
  command->add_option("--out", options->out, "file to write")->required();
  command
      ->add_option(
          "--map", options->rules,
          "COLUMN=NAME:UNIT, a column of the recording from one of the table; no unit is SI; "
          ":UNIT*FACTOR scales; :UNIT*-1-90 turns round and moves the zero")
      ->allow_extra_args(false);
  CLI::Option* header =
      command->add_option("--header-line", options->layout.header_line, "line of the table's names")
          ->check(above_zero());
  command
      ->add_option("--names", options->layout.names,
                   "NAME,NAME,… of the first columns, where no line of the table has them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes(header);
  command->add_option("--first-row", options->layout.first_row,
                      "line of the table's first row, where it is not the next");
  command->add_flag("--corrected", options->corrected,
                    "q_cmd is the corrected setpoint, not the one before correction");
  command->add_option("--interface", options->interface, "name to write into a candump log");
  command->add_flag("--fd", options->fd, "write CAN FD frames");
  command->add_option("--start", options->start, "s since the epoch, of the first row of a log")
      ->check(zero_or_above());
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
