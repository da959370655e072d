#include "cli/plan_program.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/frame_option.hpp"
#include "cli/milling_options.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "model/frame_numbers.hpp"
#include "planning/program_plan.hpp"
#include "planning/wrench_along.hpp"
#include "programs/read_program.hpp"
#include "programs/shapes.hpp"
#include "recording/plausible_angles.hpp"

namespace flexcomp::cli {
namespace {

using programs::Program;

struct ProgramOptions {
  RobotChoice model;
  std::string out;
  std::vector<double> frame;
  planning::ProgramPlan plan;
  std::array<double, 3> force = kStudyForce;
  std::array<double, 3> moment = kStudyMoment;
  MillingOptions milling;
  bool has_milling = false;
  std::string along;
  bool json = false;

  std::string file;
  programs::Pocket pocket;
  std::array<double, 3> size{0.2, 0.1, 0.01};
  std::array<double, 3> from{};
  std::array<double, 3> to{};
  std::array<double, 3> tool_axis{0, 0, -1};
};

/// Along the feed, to the left of it, up the spindle; the options give {to the right, along, up}.
Vector3<double> in_cutting_frame(const std::array<double, 3>& given) {
  return {given[1], -given[0], given[2]};
}

Wrench<double> cutting_wrench(const ProgramOptions& options) {
  if (options.has_milling) {
    return study::mean_wrench(milling_of(options.milling));
  }
  Wrench<double> wrench;
  wrench << in_cutting_frame(options.force), in_cutting_frame(options.moment);
  return wrench;
}

void refuse_impossible(const ProgramOptions& options) {
  const planning::PathSampling& sampling = options.plan.sampling;
  const planning::FeedLimits& limits = options.plan.limits;
  if (!(sampling.chord_error > 0 && sampling.largest_step > 0 && limits.feed > 0 &&
        limits.rapid > 0 && limits.acceleration > 0 && limits.corner > 0)) {
    throw InputError(
        "--chord-error, --step, --feed, --rapid, --acceleration and --corner must be above zero");
  }
}

nlohmann::ordered_json to_json(const Program& program, const planning::PlannedProgram& planned) {
  nlohmann::ordered_json notes = nlohmann::ordered_json::array();
  for (const programs::Note& note : program.notes) {
    notes.push_back({{"line", note.line}, {"text", note.text}});
  }
  const recording::Recording& recording = planned.recording;
  return {{"motions", program.motions.size()},
          {"rows", recording.size()},
          {"duration", recording.time[recording.size() - 1]},
          {"frame", model::frame_numbers(planned.path.frame)},
          {"spin", planned.path.spin},
          {"joint_margin", planned.path.joint_margin},
          {"least_singular_value", planned.path.singular_value},
          {"notes", notes}};
}

void print(const ProgramOptions& options, const Program& program,
           const planning::PlannedProgram& planned) {
  constexpr std::size_t kMostNotes = 10;
  for (std::size_t i = 0; i < std::min(program.notes.size(), kMostNotes); ++i) {
    fmt::print("{}:{}: {}\n", program.file, program.notes[i].line, program.notes[i].text);
  }
  if (program.notes.size() > kMostNotes) {
    fmt::print("... and {} notes more (--json has all)\n", program.notes.size() - kMostNotes);
  }
  const std::array<double, 6> frame = model::frame_numbers(planned.path.frame);
  fmt::print(
      "{}: {} motions, {} rows, {:.1f} s\nwork frame {:.6g} (m, rad: x,y,z,roll,pitch,yaw); tool "
      "turned {:.3f} rad about its axis\n{:.2f} rad from the joint limits and more; least singular "
      "value {:.3f}\n",
      options.out, program.motions.size(), planned.recording.size(),
      planned.recording.time[planned.recording.size() - 1], fmt::join(frame, ","),
      planned.path.spin, planned.path.joint_margin, planned.path.singular_value);
}

int run(const ProgramOptions& options, const Program& program) {
  refuse_impossible(options);
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  planning::ProgramPlan plan = options.plan;
  plan.frame = frame_of(options.frame);
  plan.cutting = cutting_wrench(options);
  for (std::size_t i = 0; i < 6; ++i) {
    plan.limits.joint_speed[static_cast<Eigen::Index>(i)] = robot.dynamics[i].velocity;
  }
  std::optional<recording::Recording> along;
  if (!options.along.empty()) {
    along = recording::read_recording_of(robot.elastic, options.along);
    plan.near = recording::require(*along, along->q_cmd, "q_cmd_1..q_cmd_6").row(0).transpose();
  }
  std::optional<Progress> progress;
  planning::PlannedProgram planned =
      planning::plan_program(elastic, program, plan, [&](std::size_t done, std::size_t all) {
        if (!progress) {
          progress.emplace("planning", all);
        }
        progress->show(done);
      });
  if (along) {
    planned.recording.wrench = planning::wrench_along(elastic, *planned.recording.q_cmd, *along);
  }
  recording::write_recording(options.out, planned.recording);
  if (options.json) {
    fmt::print("{}\n", to_json(program, planned).dump(2));
  } else {
    print(options, program, planned);
  }
  return kDone;
}

void add_limits(CLI::App* command, planning::ProgramPlan* plan) {
  command->add_option("--feed", plan->limits.feed, "m/s, where the program does not say");
  command->add_option("--rapid", plan->limits.rapid, "m/s, of rapids");
  command->add_option("--acceleration", plan->limits.acceleration, "m/s²");
  command->add_option("--corner", plan->limits.corner,
                      "m, by which a corner would be rounded at the speed it is passed at");
  command->add_option("--step", plan->sampling.largest_step, "m, from one row to the next at most");
  command->add_option("--chord-error", plan->sampling.chord_error,
                      "m, of arcs between one row and the next");
}

void add_common(CLI::App* command, ProgramOptions* options) {
  add_robot(command, &options->model)->required();
  command->add_option("--out", options->out, "recording to write: t, q_cmd, wrench, line")
      ->required();
  add_frame(command, &options->frame);
  add_limits(command, &options->plan);
  add_vector(command, "--force", &options->force,
             "N on the tool where it cuts: to the right of the feed, along it, up the spindle");
  add_vector(command, "--moment", &options->moment, "N·m, in the same directions");
  add_milling(command, &options->milling);
  command->add_flag("--json", options->json, "one JSON object, m, s and rad");
}

CLI::App* add_file(CLI::App* plan, ProgramOptions* options) {
  CLI::App* command = plan->add_subcommand(
      "program",
      "A program of a machine or robot as a path: G-code (.nc, .ngc, .gcode, .tap), KUKA KRL "
      "(.src),\n"
      "ABB RAPID (.mod) or CSV (x,y,z with i,j,k or qw,qx,qy,qz, feed). Joint angles by inverse\n"
      "kinematics on one branch; where the tool may be turned about its own axis, that keeps "
      "joints\n"
      "away from their limits and from singularities. Without --frame and a work frame in the\n"
      "program, one in front of the robot is taken.\n"
      "The wrench is --force and --moment, or with --shear the mean of milling (flexcomp force).\n"
      "Example: flexcomp plan program pocket.nc --model robot.yaml --out path.csv");
  command->add_option("program", options->file, "file to read")->required();
  add_common(command, options);
  command->add_option("--along", options->along,
                      "recording that goes the same way, such as a corrected path: its posture, "
                      "and its wrench in place of all of these");
  return command;
}

CLI::App* add_line(CLI::App* plan, ProgramOptions* options) {
  CLI::App* command = plan->add_subcommand(
      "line",
      "A straight cut.\nExample: flexcomp plan line --model robot.yaml --from 1.5,-0.2,1 "
      "--to 1.5,0.2,1 --out path.csv");
  add_vector(command, "--from", &options->from, "m, work frame")->required();
  add_vector(command, "--to", &options->to, "m, work frame")->required();
  add_vector(command, "--tool-axis", &options->tool_axis, "where the tool points, work frame");
  add_common(command, options);
  return command;
}

CLI::App* add_pocket(CLI::App* plan, ProgramOptions* options) {
  CLI::App* command = plan->add_subcommand(
      "pocket",
      "A rectangular pocket, level by level from the middle outwards; its surface is z = 0 of the\n"
      "work frame, its middle the origin.\n"
      "Example: flexcomp plan pocket --model robot.yaml --size 0.2,0.1,0.01 --out path.csv");
  add_vector(command, "--size", &options->size, "length, width and depth, m");
  command->add_option("--step-over", options->pocket.step_over, "of the tool's diameter");
  command->add_option("--step-down", options->pocket.step_down, "m, at most");
  command->add_option("--clearance", options->pocket.clearance, "m, of rapids over the surface");
  add_common(command, options);
  return command;
}

Program shape_of_pocket(const ProgramOptions& options, bool has_diameter) {
  programs::Pocket pocket = options.pocket;
  pocket.length = options.size[0];
  pocket.width = options.size[1];
  pocket.depth = options.size[2];
  if (has_diameter) {
    pocket.diameter = options.milling.milling.diameter;
  }
  return programs::pocket_program(pocket);
}

Program shape_of_line(const ProgramOptions& options) {
  const Vector3<double> axis = -Vector3<double>(options.tool_axis.data());
  if (!(axis.norm() > 0) || !axis.allFinite()) {
    throw InputError("--tool-axis: expected a direction, not zero");
  }
  Program program = programs::line_program(Vector3<double>(options.from.data()),
                                           Vector3<double>(options.to.data()), axis.normalized());
  program.frame = Pose<double>{};
  return program;
}

}  // namespace

void add_plan_program(CLI::App* plan, Action* action) {
  auto options = std::make_shared<ProgramOptions>();
  CLI::App* file = add_file(plan, options.get());
  file->callback([=] {
    options->has_milling = file->count("--shear") > 0;
    *action = [=] { return run(*options, programs::read_program(options->file)); };
  });
  auto line_options = std::make_shared<ProgramOptions>();
  CLI::App* line = add_line(plan, line_options.get());
  line->callback([=] {
    line_options->has_milling = line->count("--shear") > 0;
    *action = [=] { return run(*line_options, shape_of_line(*line_options)); };
  });
  auto pocket_options = std::make_shared<ProgramOptions>();
  CLI::App* pocket = add_pocket(plan, pocket_options.get());
  pocket->callback([=] {
    pocket_options->has_milling = pocket->count("--shear") > 0;
    const bool has_diameter = pocket->count("--diameter") > 0;
    *action = [=] { return run(*pocket_options, shape_of_pocket(*pocket_options, has_diameter)); };
  });
}

}  // namespace flexcomp::cli
