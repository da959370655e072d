#include "linux/options.hpp"

#include <CLI/CLI.hpp>
#include <set>

#include "linux/build_info.hpp"
#include "linux/complaint.hpp"
#include "linux/config_lines.hpp"
#include "linux/option_list.hpp"
#include "linux/whole_file.hpp"
#include "node/default_config.hpp"

namespace flexcomp {
namespace {

constexpr int kUnusableInput = 2;

constexpr const char* kDescription =
    "flexcompd corrects joint setpoints for the deflection of a robot, in real time, on CAN or "
    "LCM.\n\n"
    "It needs the hash of the robot's model and a table (flexcomp table; flexcomp configure writes "
    "a\n"
    "configuration file that has both). It corrects nothing until it is told to arm over the bus,\n"
    "and the sender of setpoints has said which robot it works with.\n\n"
    "  flexcompd --config node.toml --can can0\n\n"
    "SIGTERM and SIGINT: fade to zero, then end. SIGHUP: read the configuration file again (only\n"
    "while nothing is corrected; refused as a whole if it changes what is read at start only).\n"
    "SIGUSR1: write the statistics. Not a safety function.\n"
    "Exit codes: 0 done, 2 unusable input or arguments, 3 internal fault.";

/// Options as they are typed; six numbers may be given as one for all.
struct Typed {
  std::string model_hash;
  std::string trigger = "setpoint";
  std::vector<float> joint_speed = {1.5F};
  std::vector<float> value = {0.01F};
  std::vector<float> rate = {0.1F};
  std::vector<float> acceleration = {5.0F};
  bool without_identity = false;
};

/// A number that `is_good`; CLI11's own ranges name their far end too.
CLI::Validator number(const char* expected, bool (*is_good)(double)) {
  return {[=](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && is_good(value)
                       ? std::string()
                       : std::string("expected ") + expected + ", not " + text;
          },
          ""};
}

CLI::Validator above_zero() {
  return number("a number above zero", [](double value) { return value > 0; });
}

CLI::Validator zero_or_above() {
  return number("a number of zero or above", [](double value) { return value >= 0; });
}

CLI::Validator zero_to_one() {
  return number("a number from 0 to 1", [](double value) { return value >= 0 && value <= 1; });
}

template <typename Number>
void positive(OptionList* app, const char* name, Number* value, const char* help) {
  app->add_changeable(name, value, help)->check(above_zero());
}

template <typename Number>
void not_negative(OptionList* app, const char* name, Number* value, const char* help) {
  app->add_changeable(name, value, help)->check(zero_or_above());
}

void one_or_six(OptionList* app, const char* name, std::vector<float>* values, const char* help) {
  app->add_changeable(name, values, help)->check(above_zero())->expected(1, 6)->delimiter(',');
}

void add_links(OptionList* app, Options* options, Typed* typed) {
  app->add_fixed("--can", &options->can, "CAN interface, such as can0");
  app->add_fixed("--fd", &options->fd, "answer with CAN FD frames");
  app->add_fixed("--lcm", &options->lcm, "LCM address, such as udpm://239.255.76.67:7667?ttl=0");
  app->add_fixed(
      "--key", &options->key,
      "file with a key of 32 hexadecimal digits: take and send only messages that are\n"
      "authenticated with it, and take only tables signed with it (CAN only; SECURITY.md)");
  app->add_fixed("--trigger", &typed->trigger, "what makes a tick: setpoint, clock or lockstep")
      ->transform(
          CLI::IsMember(std::set<std::string>{"setpoint", "clock", "lockstep"}, CLI::ignore_case));
  app->add_fixed("--tolerated-losses", &options->settings.tolerated_losses,
                 "messages in a row that may be lost without a break")
      ->check(CLI::Range(0, 6));
  positive(app, "--heartbeat", &options->settings.node.heartbeat_period,
           "s, from one heartbeat to the next");
}

void add_table(OptionList* app, Options* options, Typed* typed) {
  app->add_changeable("--model-hash", &typed->model_hash,
                      "fingerprint of the robot, 16 hexadecimal digits (flexcomp configure)")
      ->required();
  app->add_fixed("--table", &options->table, "table to start with (flexcomp table)");
  app->add_fixed("--state-directory", &options->state_directory,
                 "where tables that come over the bus are kept; the last one is used at start");
  app->add_changeable("--without-identity", &typed->without_identity,
                      "arm even if the sender has not said which robot it works with");
}

void add_correction(OptionList* app, Options* options, Typed* typed) {
  auto& core = options->settings.node.compensator;
  app->add_fixed("--period", &core.period, "s, from one tick to the next")->check(above_zero());
  app->add_changeable("--gain", &core.gain, "share of the deflection that is corrected")
      ->check(zero_to_one());
  not_negative(app, "--filter-cutoff", &core.filter_cutoff, "Hz, low-pass on the wrench; 0: none");
  one_or_six(app, "--correction-limit", &typed->value,
             "rad, largest correction; one or a joint each");
  one_or_six(app, "--correction-rate", &typed->rate, "rad/s, of the correction");
  one_or_six(app, "--correction-acceleration", &typed->acceleration, "rad/s^2, of the correction");
  positive(app, "--deflection-limit", &core.deflection_limit, "m, largest correction at the TCP");
  positive(app, "--deflection-warning", &options->settings.node.deflection_warning,
           "m, predicted: remark");
  positive(app, "--deflection-error", &options->settings.node.deflection_error,
           "m, predicted: fault");
  positive(app, "--chart-margin", &core.chart_margin,
           "rad, outside the table, over which the correction fades");
  not_negative(app, "--hold-time", &core.hold_time,
               "s, a fault may last before fading out; bad ticks count up, good ones down");
  not_negative(app, "--fade-time", &core.fade_time, "s, from nothing to full correction and back");
  app->add_changeable("--ready-ticks", &core.ready_ticks, "good inputs in a row before arming");
}

void add_plausibility(OptionList* app, Options* options, Typed* typed) {
  auto& core = options->settings.node.compensator;
  positive(app, "--force-range", &core.force_range, "N, largest plausible");
  positive(app, "--moment-range", &core.moment_range, "N m, largest plausible");
  positive(app, "--force-rate", &options->settings.node.wrench.force_rate,
           "N/s, largest plausible change");
  positive(app, "--moment-rate", &options->settings.node.wrench.moment_rate,
           "N m/s, largest plausible");
  not_negative(app, "--wrench-stuck-time", &options->settings.node.wrench.stuck_time,
               "s, the same wrench while the robot moves; 0: not checked");
  positive(app, "--setpoint-age-limit", &core.setpoint_age_limit, "s, beyond it one is stale");
  positive(app, "--wrench-age-limit", &core.wrench_age_limit, "s, beyond it one is stale");
  one_or_six(app, "--joint-speed", &typed->joint_speed, "rad/s, largest plausible");
  positive(app, "--late-ticks", &options->settings.node.late_ticks,
           "late ticks, beyond those on time, that are a fault");
}

void add_process(OptionList* app, Options* options) {
  app->add_fixed("--priority", &options->priority, "SCHED_FIFO priority; 0: ordinary scheduling")
      ->check(CLI::Range(0, 99));
  app->add_fixed("--user", &options->user,
                 "started as root: become this user once sockets, memory and priority are set up");
  app->add_fixed("--statistics", &options->statistics,
                 "file for the statistics, written at the end and on SIGUSR1");
  app->add_fixed("--settings-out", &options->settings_out,
                 "write these settings to a file for a microcontroller's flash, and end");
}

/// `values` at a joint: its own, or the one for all.
float at(const std::vector<float>& values, std::size_t joint) {
  return values[values.size() == 1 ? 0 : joint];
}

void require_one_or_six(const std::vector<float>& values, const char* name) {
  if (values.size() != 1 && values.size() != 6) {
    throw CLI::ValidationError(name, "expected one number, or six");
  }
}

std::uint64_t parse_hash(const std::string& text) {
  const bool is_hash =
      text.size() == 16 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  if (!is_hash) {
    throw CLI::ValidationError("--model-hash", "expected 16 hexadecimal digits");
  }
  return std::stoull(text, nullptr, 16);
}

/// Puts what was typed where it belongs.
void transfer(const Typed& typed, Options* options) {
  require_one_or_six(typed.joint_speed, "--joint-speed");
  require_one_or_six(typed.value, "--correction-limit");
  require_one_or_six(typed.rate, "--correction-rate");
  require_one_or_six(typed.acceleration, "--correction-acceleration");
  auto& core = options->settings.node.compensator;
  for (std::size_t i = 0; i < core.limits.size(); ++i) {
    core.joint_speed[static_cast<Eigen::Index>(i)] = at(typed.joint_speed, i);
    core.limits[i] = {at(typed.value, i), at(typed.rate, i), at(typed.acceleration, i)};
  }
  core.model_hash = parse_hash(typed.model_hash);
  options->settings.trigger = typed.trigger == "clock"      ? Trigger::clock
                              : typed.trigger == "lockstep" ? Trigger::lockstep
                                                            : Trigger::setpoint;
  options->settings.node.require_identity = !typed.without_identity;
  options->settings.node.use_timestamps = options->settings.trigger != Trigger::lockstep;
}

/// Do the options make sense together?
void check_together(const Options& options) {
  if (!is_usable(options.settings.node)) {
    throw CLI::ValidationError("configuration", describe(Result::bad_config));
  }
  if (!options.settings_out.empty()) {
    return;  // the microcontroller has its own bus
  }
  if (options.can.empty() && options.lcm.empty()) {
    throw CLI::ValidationError("--can or --lcm", "expected at least one of them");
  }
  if (!options.key.empty() && !options.lcm.empty()) {
    throw CLI::ValidationError("--key", "authenticates CAN only: not together with --lcm");
  }
}

/// Nothing if the configuration can be read at once and takes little memory: it is read again while
/// the node runs.
std::string complaint_about_file(const std::string& path) {
  constexpr std::size_t kLargest = std::size_t{1} << 20;
  try {
    return read_whole(path, kLargest) ? "" : path + ": there is no such file";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// All options of flexcompd, and where what they are given goes.
class Parser {
 public:
  Parser() : app_(kDescription), list_(&app_) {
    options_.settings.node = default_node_config();
    app_.option_defaults()->always_capture_default();
    app_.set_version_flag("--version", FLEXCOMP_BUILD_INFO);
    app_.set_config("--config", "", "file with any of these options, one a line: name = value")
        ->check(CLI::Validator(complaint_about_file, ""));
    app_.allow_config_extras(CLI::config_extras_mode::error);
    add_links(&list_, &options_, &typed_);
    add_table(&list_, &options_, &typed_);
    add_correction(&list_, &options_, &typed_);
    add_plausibility(&list_, &options_, &typed_);
    add_process(&list_, &options_);
  }

  Options parse(int argc, const char* const* argv) {
    app_.parse(argc, argv);
    transfer(typed_, &options_);
    check_together(options_);
    refuse_repeated_names();
    options_.fixed = list_.fixed();
    return options_;
  }

  /// What is wrong with one option, whatever the others are; empty if nothing.
  std::string complaint_about(const std::string& name, const std::vector<std::string>& values) {
    const CLI::Option* option = app_.get_option_no_throw("--" + name);
    if (option == nullptr || option == app_.get_config_ptr()) {
      return name + " is no option";
    }
    app_.get_option("--model-hash")->required(false);
    typed_.model_hash = std::string(16, '0');
    std::vector<std::string> words(values.rbegin(), values.rend());  // CLI11 takes the last first
    const std::string first = words.empty() ? "" : words.back();
    if (!words.empty()) {
      words.pop_back();
    }
    words.push_back("--" + name + "=" + first);
    try {
      app_.parse(words);
      transfer(typed_, &options_);
      return is_usable(options_.settings.node) ? ""
                                               : "--" + name + ": " + first + " is out of range";
    } catch (const CLI::ParseError& error) {  // which help and version are, too
      return error.get_exit_code() == 0 ? name + " is no option" : error.what();
    }
  }

  /// Ends with help or version, or complains. The exit code.
  int end(const CLI::ParseError& error) const {
    if (error.get_exit_code() == 0) {
      return app_.exit(error);
    }
    complain(where(error.what()) + " (see --help)");
    return kUnusableInput;
  }

 private:
  /// The configuration file that was given and can be read; else empty.
  std::string config_file() const {
    const std::vector<std::string>& given = app_.get_config_ptr()->results();
    return given.size() == 1 && complaint_about_file(given.front()).empty() ? given.front() : "";
  }

  /// A complaint with the line of the configuration file that it is about, if it is about one.
  std::string where(const std::string& complaint) const {
    const auto complaint_about = [](const std::string& name,
                                    const std::vector<std::string>& values) {
      return Parser().complaint_about(name, values);
    };
    const std::string file = config_file();
    for (const auto& at_line :
         {complaint_about_lines(file, complaint_about), complaint_about_repeated_names(file),
          complaint_at_line_of_its_option(file, complaint)}) {
      if (at_line) {
        return *at_line;
      }
    }
    return complaint;
  }

  /// CLI11 takes the first of two and says nothing.
  void refuse_repeated_names() const {
    const std::optional<std::string> complaint = complaint_about_repeated_names(config_file());
    if (complaint) {
      throw CLI::ConversionError(*complaint);
    }
  }

  Options options_;
  Typed typed_;
  CLI::App app_;
  OptionList list_;
};

}  // namespace

std::optional<Options> read_options(int argc, const char* const* argv, int* exit_code) {
  Parser parser;
  try {
    return parser.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    *exit_code = parser.end(error);
    return std::nullopt;
  }
}

std::string refused_changes(const Options& running, const Options& wanted) {
  std::string names;
  for (std::size_t i = 0; i < running.fixed.size(); ++i) {
    if (wanted.fixed.at(i).value != running.fixed[i].value) {
      names += (names.empty() ? "" : ", ") + running.fixed[i].name;
    }
  }
  return names.empty() ? names : names + " cannot change while running; restart flexcompd";
}

}  // namespace flexcomp
