#include "linux/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "linux/build_info.hpp"
#include "linux/complaint.hpp"
#include "linux/config_lines.hpp"
#include "linux/option_list.hpp"
#include "linux/whole_file.hpp"
#include "node/default_config.hpp"
#include "node/settings_numbers.hpp"

namespace flexcomp {
namespace {

constexpr int kUnusableInput = 2;

constexpr const char* kDescription =
    "flexcompd corrects joint setpoints for the deflection of a robot, in real time, on CAN, LCM "
    "or "
    "a\nKUKA's RSI.\n\n"
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
  std::map<std::string, std::vector<float>> of_joints;  ///< by the option's name
  bool without_identity = false;
};

const char* described(SettingRange range) {
  switch (range) {
    case SettingRange::above_zero:
      return "a number above zero";
    case SettingRange::zero_or_above:
      return "a number of zero or above";
    case SettingRange::zero_to_one:
      return "a number from 0 to 1";
    default:
      return "a number";
  }
}

/// CLI11's own ranges name their far end too, which is none for most numbers.
CLI::Validator in_range(SettingRange range) {
  if (range == SettingRange::up_to_six) {
    return CLI::Range(0, 6);
  }
  return {[=](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && is_in_range(value, range)
                       ? std::string()
                       : std::string("expected ") + described(range) + ", not " + text;
          },
          ""};
}

void add_links(OptionList* app, Options* options, Typed* typed) {
  app->add_fixed("--can", &options->can, "CAN interface, such as can0");
  app->add_fixed("--fd", &options->fd, "answer with CAN FD frames");
  app->add_fixed("--lcm", &options->lcm, "LCM address, such as udpm://239.255.76.67:7667?ttl=0");
  add_rsi(app, &options->rsi);
  add_sensor(app, &options->sensor);
  app->add_fixed(
      "--key", &options->key,
      "file with a key of 32 hexadecimal digits: take and send only messages that are\n"
      "authenticated with it, and take only tables signed with it (CAN only; SECURITY.md)");
  app->add_fixed("--trigger", &typed->trigger, "what makes a tick: setpoint, clock or lockstep")
      ->transform(
          CLI::IsMember(std::set<std::string>{"setpoint", "clock", "lockstep"}, CLI::ignore_case));
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

/// Adds an option for each number of the settings.
class NumberOptions {
 public:
  NumberOptions(OptionList* list, Typed* typed) : list_(list), typed_(typed) {}

  template <typename About, typename Number>
  void operator()(About shown, Number* value) {
    const SettingNumber about = shown();
    const std::string name = std::string("--") + about.name;
    (about.only_at_start ? list_->add_fixed(name, value, about.help)
                         : list_->add_changeable(name, value, about.help))
        ->check(in_range(about.range));
  }
  /// One for all joints, or six.
  template <typename About>
  void operator()(About shown, const JointNumbers<float>& values) {
    const SettingNumber about = shown();
    std::vector<float>& typed = typed_->of_joints[about.name];
    typed = {*values[0]};
    list_->add_changeable(std::string("--") + about.name, &typed, about.help)
        ->check(in_range(about.range))
        ->expected(1, 6)
        ->delimiter(',');
  }

 private:
  OptionList* list_;
  Typed* typed_;
};

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

/// Gives the joints what was typed for them.
struct JointTransfer {
  const Typed* typed;

  template <typename About, typename Number>
  void operator()(About /*shown*/, Number* /*value*/) const {}
  template <typename About>
  void operator()(About shown, const JointNumbers<float>& values) const {
    const SettingNumber about = shown();
    const std::vector<float>& given = typed->of_joints.at(about.name);
    if (given.size() != 1 && given.size() != values.size()) {
      throw CLI::ValidationError(std::string("--") + about.name, "expected one number, or six");
    }
    for (std::size_t joint = 0; joint < values.size(); ++joint) {
      *values[joint] = given[given.size() == 1 ? 0 : joint];
    }
  }
};

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
  visit_numbers(&options->settings, JointTransfer{&typed});
  auto& core = options->settings.node.compensator;
  core.model_hash = parse_hash(typed.model_hash);
  options->settings.trigger = typed.trigger == "clock"      ? Trigger::clock
                              : typed.trigger == "lockstep" ? Trigger::lockstep
                                                            : Trigger::setpoint;
  options->settings.node.require_identity = !typed.without_identity;
  options->settings.node.use_timestamps = options->settings.trigger != Trigger::lockstep;
}

/// Over RSI alone the telegrams must bring all that is needed.
void check_alone(const Options& options) {
  if (options.rsi.wrench.empty() && options.sensor.address.empty()) {
    throw CLI::ValidationError("--rsi-wrench",
                               "expected it, or the wrench over --sensor, --can or --lcm");
  }
  if (options.rsi.armed.empty()) {
    throw CLI::ValidationError("--rsi-arm", "expected it, or commands over --can or --lcm");
  }
  if (options.settings.node.require_identity) {
    throw CLI::ValidationError(
        "--without-identity",
        "expected it with --rsi alone: no telegram says which robot it is of; --rsi-type does, "
        "which the controller compares");
  }
}

/// The option by which a node refuses numbers that are each in their range.
std::string refused_option(const NodeConfig& config) {
  const char* member = unusable_member(config.compensator);
  std::string name = member == nullptr ? "heartbeat" : member;
  std::replace(name.begin(), name.end(), '_', '-');
  return name == "limits" ? "--correction-limit, -rate or -acceleration" : "--" + name;
}

/// A sensor's wrench is one at the TCP only with the arm's geometry.
void check_sensor(const Options& options) {
  if (options.sensor.address.empty()) {
    return;
  }
  if (const std::optional<OptionFault> fault = fault_in(options.sensor)) {
    throw CLI::ValidationError(fault->option, fault->fault);
  }
  if (!options.rsi.wrench.empty()) {
    throw CLI::ValidationError("--sensor", "expected one wrench: not together with --rsi-wrench");
  }
}

/// Do the options make sense together?
void check_together(const Options& options) {
  if (!is_usable(options.settings.node)) {
    throw CLI::ValidationError(refused_option(options.settings.node), describe(Result::bad_config));
  }
  if (!options.settings_out.empty()) {
    return;  // the microcontroller has its own bus
  }
  const bool has_bus = !options.can.empty() || !options.lcm.empty();
  if (!has_bus && options.rsi.address.empty()) {
    throw CLI::ValidationError("--can, --lcm or --rsi", "expected at least one of them");
  }
  if (!options.key.empty() && (!options.lcm.empty() || !options.rsi.address.empty())) {
    throw CLI::ValidationError("--key", "authenticates CAN only: not together with --lcm or --rsi");
  }
  if (!has_bus) {
    check_alone(options);
  }
  check_sensor(options);
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
    visit_numbers(&options_.settings, NumberOptions(&list_, &typed_));
    add_process(&list_, &options_);
  }

  Options parse(int argc, const char* const* argv) {
    app_.parse(argc, argv);
    transfer(typed_, &options_);
    check_together(options_);
    refuse_repeated_names();
    find_table_beside_file();
    options_.fixed = list_.fixed();
    return options_;
  }

  /// Says what is wrong with one option, whatever the others are; empty if nothing.
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

  /// A table by a relative path that is not there is looked for beside the configuration file, so
  /// that both can be moved together.
  void find_table_beside_file() {
    const std::filesystem::path table = options_.table;
    const std::string file = config_file();
    std::error_code ignored;
    if (table.empty() || table.is_absolute() || file.empty() ||
        std::filesystem::exists(table, ignored)) {
      return;
    }
    const std::filesystem::path beside = std::filesystem::path(file).parent_path() / table;
    options_.table = std::filesystem::exists(beside, ignored) ? beside.string() : options_.table;
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
