#include "linux/rsi_options.hpp"

#include <algorithm>
#include <set>

#include "linux/option_list.hpp"

namespace flexcomp {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_name_character(char c) {
  return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Nothing if XML can hold it without quoting, and an answer has room for it.
std::string complaint_about_name(const std::string& name) {
  const bool is_name = !name.empty() && name.size() <= RsiAnswerText::kLongestName &&
                       is_letter(name.front()) &&
                       std::all_of(name.begin(), name.end(), is_name_character);
  return is_name ? "" : "expected a name of up to 32 letters, digits, _ and -, not '" + name + "'";
}

const CLI::Validator kName(complaint_about_name, "");

std::array<double, 6> six(const std::vector<double>& numbers) {
  std::array<double, 6> result{};
  std::copy_n(numbers.begin(), result.size(), result.begin());
  return result;
}

void add_elements(OptionList* app, RsiOptions* options) {
  app->add_fixed("--rsi-type", &options->type, "SENTYPE of the controller's configuration")
      ->check(kName);
  app->add_fixed(
         "--rsi-correction", &options->correction,
         "element of the answer with the corrections, as the controller's configuration has it")
      ->check(kName);
  app->add_fixed("--rsi-wrench", &options->wrench,
                 "element of the telegram with the wrench on the tool at the TCP, base frame, in\n"
                 "attributes Fx Fy Fz Mx My Mz (N, N m); else it comes over CAN or LCM")
      ->check(kName);
  app->add_fixed(
         "--rsi-arm", &options->armed,
         "element of the telegram with an output of the robot's program, 1 or 0: arms as it\n"
         "rises, disarms as it falls; else commands come over CAN or LCM")
      ->check(kName);
  app->add_fixed("--rsi-applied", &options->applied,
                 "element of the telegram with the correction that the controller moves by, in\n"
                 "attributes A1 to A6 (degrees): a restart goes on from there")
      ->check(kName);
  app->add_fixed("--rsi-state", &options->state, "element of the answer with the state, 0 to 5")
      ->check(kName);
}

void add_axes(OptionList* app, RsiOptions* options) {
  app->add_fixed("--rsi-sign", &options->sign,
                 "six of 1 or -1: the controller's axes against the joints of the URDF")
      ->check(CLI::IsMember(std::set<double>{-1, 1}))
      ->expected(6)
      ->delimiter(',');
  app->add_fixed(
         "--rsi-zero", &options->zero,
         "six angles in degrees that the controller shows where the URDF's joint is at zero")
      ->check(CLI::Range(-360.0, 360.0))
      ->expected(6)
      ->delimiter(',');
}

}  // namespace

void add_rsi(OptionList* app, RsiOptions* options) {
  app->add_fixed(
      "--rsi", &options->address,
      "listen for a KUKA's RSI at this address, such as udp://192.168.1.10:49152 (RSI.md)");
  app->add_fixed("--rsi-mode", &options->mode,
                 "absolute or relative corrections, as RSI_ON of the robot's program says")
      ->check(CLI::IsMember(std::set<std::string>{"absolute", "relative"}));
  add_elements(app, options);
  app->add_fixed("--rsi-limit", &options->largest, "degrees, largest correction of an axis")
      ->check(CLI::Range(1e-6, 10.0));
  app->add_fixed("--rsi-step", &options->largest_step,
                 "degrees, largest change of a correction from one answer to the next")
      ->check(CLI::Range(1e-6, 1.0));
  add_axes(app, options);
}

RsiConfig to_config(const RsiOptions& options, std::uint32_t tolerated_losses) {
  RsiConfig config;
  config.axes.sign = six(options.sign);
  config.axes.zero = six(options.zero);
  config.mode = options.mode == "relative" ? RsiMode::relative : RsiMode::absolute;
  config.largest = options.largest;
  config.largest_step = options.largest_step;
  config.schema.wrench = options.wrench;
  config.schema.armed = options.armed;
  config.schema.applied = options.applied;
  config.schema.needs_late = config.mode == RsiMode::relative;
  config.type = options.type;
  config.correction_name = options.correction;
  config.state_name = options.state;
  config.tolerated_losses = tolerated_losses;
  return config;
}

}  // namespace flexcomp
