#include "cli/milling_options.hpp"

namespace flexcomp::cli {

std::vector<CLI::Option*> add_milling(CLI::App* command, MillingOptions* options) {
  study::EndMilling& milling = options->milling;
  std::vector<CLI::Option*> needed;
  needed.push_back(command->add_option("--diameter", milling.diameter, "of the tool, m"));
  needed.push_back(command->add_option("--teeth", milling.teeth, "of the tool"));
  command->add_option("--helix", milling.helix, "rad");
  needed.push_back(command->add_option("--depth", milling.depth, "of the cut, along the tool, m"));
  command->add_option("--mode", options->mode, "slot: the whole width; up: chips begin thin")
      ->check(CLI::IsMember({"slot", "up", "down"}));
  command->add_option("--width", milling.width, "of the cut, across the tool, m; not for slots");
  needed.push_back(command->add_option("--feed-per-tooth", milling.feed_per_tooth, "m"));
  command->add_option("--runout", milling.runout, "tool axis off the spindle's, m");
  command->add_option("--runout-angle", milling.runout_angle, "from the first tooth, rad");
  needed.push_back(
      command->add_option("--shear", options->shear, "shear coefficients Ktc, Krc, Kac, N/m²")
          ->delimiter(',')
          ->type_name("T,R,A"));
  command->add_option("--edge", options->edge, "edge coefficients Kte, Kre, Kae, N/m")
      ->delimiter(',')
      ->type_name("T,R,A");
  return needed;
}

study::EndMilling milling_of(const MillingOptions& options) {
  study::EndMilling milling = options.milling;
  milling.coefficients = {options.shear[0], options.shear[1], options.shear[2],
                          options.edge[0],  options.edge[1],  options.edge[2]};
  milling.mode = options.mode == "slot" ? study::MillingMode::slot
                 : options.mode == "up" ? study::MillingMode::up
                                        : study::MillingMode::down;
  study::check(milling);
  return milling;
}

}  // namespace flexcomp::cli
