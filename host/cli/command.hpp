#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>

namespace flexcomp::cli {

/// Exit codes of every command; InputError makes 2.
enum ExitCode : int {
  kDone = 0,
  kDoesNotHold = 1,    ///< the thing checked does not hold
  kUnusableInput = 2,  ///< or unusable arguments; one line on standard error
  kInternalFault = 3,
};

/// Runs what the command line asked for, once it has been read in full.
using Action = std::function<int()>;

/// Each adds one subcommand, which sets `action` when it is chosen.
void add_place(CLI::App* app, Action* action);
void add_plan(CLI::App* app, Action* action);
void add_table(CLI::App* app, Action* action);
void add_compensate(CLI::App* app, Action* action);
void add_simulate(CLI::App* app, Action* action);
void add_check(CLI::App* app, Action* action);
void add_contour(CLI::App* app, Action* action);
void add_circularity(CLI::App* app, Action* action);
void add_export(CLI::App* app, Action* action);
void add_force(CLI::App* app, Action* action);
void add_form(CLI::App* app, Action* action);
void add_help(CLI::App* app, Action* action);
void add_identify(CLI::App* app, Action* action);
void add_map(CLI::App* app, Action* action);
void add_select(CLI::App* app, Action* action);
void add_report(CLI::App* app, Action* action);
void add_configure(CLI::App* app, Action* action);
void add_convert(CLI::App* app, Action* action);
void add_design_arc(CLI::App* app, Action* action);
void add_arc_demo(CLI::App* app, Action* action);
void add_diagnose(CLI::App* app, Action* action);
void add_node(CLI::App* app, Action* action);
void add_plant(CLI::App* app, Action* action);

/// An option of three numbers, "x,y,z".
CLI::Option* add_vector(CLI::App* command, const std::string& name, std::array<double, 3>* value,
                        const std::string& help);

}  // namespace flexcomp::cli
