// The commands that simulate and correct programs, linked without the diagnosis.
#include "cli/command.hpp"

int main(int count, char** words) {
  CLI::App app("flexcomp");
  flexcomp::cli::Action action;
  flexcomp::cli::add_compensate(&app, &action);
  flexcomp::cli::add_simulate(&app, &action);
  flexcomp::cli::add_table(&app, &action);
  CLI11_PARSE(app, count, words);
  return action ? action() : 0;
}
