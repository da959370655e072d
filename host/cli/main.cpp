#include <fmt/format.h>
#include <malloc.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "build_info.hpp"
#include "cli/command.hpp"
#include "cli/help.hpp"
#include "cli/number_options.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "linux/printable_line.hpp"

namespace {

using flexcomp::cli::Action;

/// Ctrl-C leaves nothing half-written, and the shell sees what ended the program.
void end_cleanly(int signal) {
  flexcomp::files::remove_unfinished_file();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// One printable line, whatever the message holds. All that flexcomp complains of goes through
/// here.
void complain(const std::string& message) {
  fmt::print(stderr, "flexcomp: {}\n", flexcomp::printable_line(message));
}

/// Memory that is given back to the system comes again page by page, cleared: for the large
/// matrices of a diagnosis a tenth of its time (glibc only; elsewhere the defaults stay).
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargest = 32 << 20;  // bytes; glibc takes no larger threshold for what it maps
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, 16 * kLargest);
#endif
}

int run(const Action& action) {
  try {
    const int code = action();
    if (std::fflush(stdout) != 0) {
      complain("standard output cannot be written");
      return flexcomp::cli::kUnusableInput;
    }
    return code;
  } catch (const flexcomp::InputError& error) {
    complain(error.what());
    return flexcomp::cli::kUnusableInput;
  } catch (const std::bad_alloc&) {
    complain("out of memory: the input is too large for this machine");
    return flexcomp::cli::kUnusableInput;
  } catch (const std::exception& error) {
    complain(fmt::format("internal fault: {}", error.what()));
    return flexcomp::cli::kInternalFault;
  }
}

constexpr const char* kOverview =
    "flexcomp corrects the path of industrial robots that bend under cutting forces.\n\n"
    "  flexcomp help COMMAND    what a command does and takes\n"
    "  flexcomp help effects    what else a robot.yaml may say of a machine\n"
    "  flexcomp check …         what is wrong or suspicious in model, path, table or "
    "recording\n\n"
    "From model to corrected path:\n"
    "  flexcomp plan …          a path with its cutting force, of a program or a shape, or bring "
    "your\n"
    "                           own recording\n"
    "  flexcomp table …         the compliance along that path, with a certified error\n"
    "  flexcomp compensate …    the path, corrected\n"
    "  flexcomp export …        the corrected program, as KRL, RAPID, G-code or CSV\n"
    "  flexcomp simulate …      where the bending robot really goes\n"
    "  flexcomp contour …       how far that is from the path's contour\n"
    "  flexcomp circularity …   how round that is\n"
    "  flexcomp form …          how straight, how flat, how round both ways\n"
    "  flexcomp report …        all of it on one page\n\n"
    "Before there is a path:\n"
    "  flexcomp map …           how round this robot mills, where it stands best\n"
    "  flexcomp select …        which robots mill to which circularity at which force\n"
    "  flexcomp place …         where a job is displaced least\n"
    "  flexcomp identify …      compliances from load tests, and which tests to make\n"
    "  flexcomp force …         the force of milling, and a path with it\n\n"
    "The joints' own control, springs included:\n"
    "  flexcomp design-arc …    adaptive robust control for what is uncertain of a robot\n"
    "  flexcomp arc-demo …      what it is worth, in simulation\n\n"
    "On the bus, with flexcompd:\n"
    "  flexcomp configure …     a configuration file for flexcompd\n"
    "  flexcomp node …          arm it, disarm it, send it a table\n"
    "  flexcomp plant …         the bending robot in the cut, for hardware-in-the-loop tests\n"
    "  flexcomp convert …       logs of candump and lcm-logger to recordings, and back; tables "
    "of\n"
    "                           other programs to recordings\n"
    "  flexcomp diagnose …      where a recording and the model differ, and why\n\n"
    "SI units everywhere: m, rad, s, N, N·m. Exit codes: 0 done, 1 the thing checked does not "
    "hold,\n"
    "2 unusable input or arguments, 3 internal fault.";

void add_commands(CLI::App* app, Action* action) {
  flexcomp::cli::add_help(app, action);
  flexcomp::cli::add_check(app, action);
  flexcomp::cli::add_plan(app, action);
  flexcomp::cli::add_table(app, action);
  flexcomp::cli::add_compensate(app, action);
  flexcomp::cli::add_export(app, action);
  flexcomp::cli::add_simulate(app, action);
  flexcomp::cli::add_contour(app, action);
  flexcomp::cli::add_circularity(app, action);
  flexcomp::cli::add_force(app, action);
  flexcomp::cli::add_form(app, action);
  flexcomp::cli::add_identify(app, action);
  flexcomp::cli::add_map(app, action);
  flexcomp::cli::add_place(app, action);
  flexcomp::cli::add_select(app, action);
  flexcomp::cli::add_report(app, action);
  flexcomp::cli::add_design_arc(app, action);
  flexcomp::cli::add_arc_demo(app, action);
  flexcomp::cli::add_configure(app, action);
  flexcomp::cli::add_node(app, action);
  flexcomp::cli::add_plant(app, action);
  flexcomp::cli::add_convert(app, action);
  flexcomp::cli::add_diagnose(app, action);
  flexcomp::cli::expect_finite_numbers(app);
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(kOverview);
  app.name("flexcomp");
  app.formatter(std::make_shared<flexcomp::cli::OptionFormat>());
  app.set_version_flag("--version", FLEXCOMP_BUILD_INFO);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  Action action;
  add_commands(&app, &action);
  const auto is_asked_for = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_asked_for).empty()) {
    complain(fmt::format("unknown command '{}' (see --help)", argv[1]));
    return flexcomp::cli::kUnusableInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app.exit(error);
    }
    complain(fmt::format("{} (see --help)", error.what()));
    return flexcomp::cli::kUnusableInput;
  }
  return run(action);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, end_cleanly);
  std::signal(SIGTERM, end_cleanly);
  keep_freed_memory();
  try {
    return parse_and_run(argc, argv);
  } catch (...) {
    std::fputs("flexcomp: internal fault\n", stderr);
    return flexcomp::cli::kInternalFault;
  }
}
