#include <algorithm>
#include <csignal>
#include <cstring>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include "platform/cpu_pin.h"
#include "platform/log.h"
#include "platform/memory.h"
#include "platform/stop.h"
#include "src/boot/robot.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/commands/run_robot.h"
#include "src/config/load.h"
#include "src/input/identities_file.h"
#include "src/input/pose_file.h"
#include "src/output/text_file.h"
#include "src/sinks/csv_sink.h"
#include "src/sinks/profile.h"

namespace cgsr::app {
namespace {

std::string ended_by(const boot::Robot& robot) {
  if (const int signal = StopOnSignals::received(); signal != 0) return fmt::format("SIG{}", sigabbrev_np(signal));
  if (robot.state().links.images_ended.load()) return "the last image";
  return "the duration";
}

/// The person task instead of the one that the file names. A name is looked up here: further on there are numbers alone.
Result<void> follow(const FollowedPerson& person, const std::string& robot_file, config::Robot& config) {
  if (!person.identities.empty()) config.person.identities = person.identities;
  if (!config.person.enabled() || !(person.name.empty() || config.person.knows_faces())) {
    return fail(fmt::format("{}: person.identities is empty and no --identities is given: who is known?", robot_file));
  }
  config.task.kind = config::TaskKind::kPerson;
  if (person.name.empty()) return {};
  const auto identities = load_identities(config.person.identities);
  if (!identities) return tl::unexpected(identities.error());
  const auto one = std::ranges::find(identities->people, person.name, &person::Identity::name);
  if (one == identities->people.end()) {
    return fail(fmt::format("{}: there is no '{}'", config.person.identities, person.name));
  }
  config.task.person.number = one->number;
  return {};
}

Result<void> apply(const RunCommand& options, config::Robot& config) {
  if (!options.input.empty()) config.camera.replay.path = options.input;
  if (!options.model.empty()) config.run.model = options.model;
  if (options.seed >= 0) config.sim.seed = options.seed;
  if (options.person) {
    if (auto followed = follow(*options.person, options.config, config); !followed) return followed;
  }
  if (config.needs_object() && config.run.model.empty() && config.run.learn.empty()) {
    return fail(
        fmt::format("{}: run.model is empty and no --model is given: what shall be followed? (cgsr learn makes a "
                    "model, or run.learn "
                    "names a region of the first image)",
                    options.config));
  }
  return {};
}

std::string profile_of(const sinks::Summary& summary) {
  return sinks::profile_text(summary.json["profile"]) +
         fmt::format("\nconfiguration {}\n", summary.json["config_sha256"].get<std::string>());
}

/// A service that is told to end while it waits for a device has not failed.
int stopped_before_the_start(const Error& awaited) {
  fmt::print("ended by SIG{} before the robot was there: {}\n", sigabbrev_np(StopOnSignals::received()),
             awaited.message);
  return kSuccess;
}

Result<void> claim_outputs(const RunCommand& options, const config::Robot& config) {
  OutputClaims files(options.force);
  reads_robot(files, config);
  files.writes(options.run.csv, "--csv", csv_file(sinks::csv_file_header()));
  files.writes(options.run.video, "--video", video_file());
  files.writes(options.run.trace, "--trace", json_list());
  files.writes(options.run.recording, "--recording", mcap_file());
  files.writes(options.run.status, "--status", json_object());
  files.writes(options.json, "--json", json_object());
  if (auto claimed = files.claim(); !claimed) return claimed;
  // Read at the start and written at the end: the one file for which both is meant.
  OutputClaims left(options.force);
  left.writes(config.localization.start.file, "localization.start.file", csv_file(kPoseColumns));
  return left.claim();
}

}  // namespace

int run_robot(const RunCommand& options) {
  // Before the first thread, and before anything that takes time: a signal at any moment ends the program in order.
  StopRequest stop;
  const StopOnSignals signals(stop);
  keep_heap_pages();
  cv::setNumThreads(1);
  if (auto log = set_up_log(options.log_level); !log) return report(log.error());

  auto config = config::load_robot(options.config);
  if (!config) return report(config.error());
  if (auto applied = apply(options, *config); !applied) return report(applied.error());
  if (auto claimed = claim_outputs(options, *config); !claimed) return report(claimed.error());
  boot::RunOptions run = options.run;
  if (options.wait_for_devices) run.wait_for_devices = &stop;
  auto robot = boot::Robot::build(*config, run);
  if (!robot) return stop.requested() ? stopped_before_the_start(robot.error()) : report(robot.error());
  const boot::RobotState& state = (*robot)->state();
  for (const std::string& note : state.report.notes) spdlog::info("{}", note);
  for (const std::string& problem : state.report.problems) spdlog::error("{}", problem);
  spdlog::info("schedule:\n{}", runtime::to_text(state.vision.runner->schedule()));

  if (auto done = (*robot)->run(stop); !done) return report(done.error());
  const sinks::Summary summary = (*robot)->summary(ended_by(**robot));
  if (!options.json.empty()) {  // first: whoever reads the terminal's output may be gone
    if (auto written = write_file(options.json, summary.json.dump(1) + "\n"); !written) return report(written.error());
  }
  fmt::print("{}", options.run.profile ? profile_of(summary) : summary.text);
  return state.outputs.sinks.problem().empty() ? kSuccess : kFailure;
}

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunCommand>();
  auto* command = app.add_subcommand("run", "run the robot in the foreground, from camera to wheels");
  command->add_option("--config", options->config, "the robot's file")->capture_default_str();
  command->add_option("--input", options->input, "images to replay instead of those that the file names");
  command->add_option("--model", options->model, "object to follow instead of the one that the file names");
  command->add_option("--seed", options->seed, "of the simulation instead of the one that the file names")
      ->check(whole_number());
  command->add_option("--duration", options->run.duration_s, "end after that many seconds")->check(in_range(1e-3, 1e6));
  command->add_flag("--dry-run", options->run.dry_run, "compute and record, command nothing");
  command->add_flag("--arm", options->run.arm, "arm as soon as nothing speaks against it: the robot will move");
  command->add_flag("--wait-for-devices", options->wait_for_devices,
                    "wait for a camera, CAN interface or line of this computer that is not there yet, as the service "
                    "does");
  command->add_option("--csv", options->run.csv, "write a row per image");
  command->add_option("--video", options->run.video, "write a video of what the robot saw and did");
  command->add_option("--trace", options->run.trace, "write a trace of stages and control cycles (ui.perfetto.dev)");
  command->add_option("--recording", options->run.recording,
                      "write a recording in MCAP (Foxglove): outputs and images");
  command->add_flag("--record-images", options->run.record_images,
                    "keep the images in the recording although people are identified in them");
  command->add_option("--status", options->run.status, "rewrite this file every second, for cgsr top");
  command->add_option("--json", options->json, "write the summary for machines");
  add_force_option(*command, options->force);
  command->add_option("--log-level", options->log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run_robot(*options); });
}

}  // namespace cgsr::app
