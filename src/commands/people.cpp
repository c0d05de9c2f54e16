#include <memory>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "platform/stop.h"
#include "src/commands/command.h"
#include "src/commands/option_checks.h"
#include "src/commands/people_run.h"
#include "src/commands/run_robot.h"
#include "src/output/progress.h"

namespace cgsr::app {
namespace {

int run_enroll(const PeopleOptions& options) {
  const auto enrolled = enroll(options);
  if (!enrolled) return report(enrolled.error());
  if (!enrolled->note.empty()) fmt::print(stderr, "warning: {}\n", enrolled->note);
  fmt::print("{} is number {}: {} views; a single face in {} of {} images\n", options.name, enrolled->number,
             enrolled->views, enrolled->with_one_face, enrolled->images);
  if (enrolled->views < person::FaceMatchParameters{}.min_views) {
    fmt::print(stderr, "warning: who has a single view counts as a stranger; --more adds views\n");
  }
  return kSuccess;
}

int run_identify(const PeopleOptions& options) {
  auto run = IdentifyRun::open(options);
  if (!run) return report(run.error());
  StopRequest stop;
  const StopOnSignals signals(stop);
  Progress progress;
  bool ended = false;
  while (!stop.requested() && !ended) {
    const auto more = run->step();
    if (!more) return report(more.error());
    ended = !*more;
    progress.show(fmt::format("image {}: {} faces", run->images(), run->faces()));
  }
  fmt::print("{} images{}, {} faces\n", run->images(), ended ? "" : " until it was stopped", run->faces());
  for (const std::string& line : run->summary()) fmt::print("{}\n", line);
  if (!options.csv.empty()) fmt::print("rows     {}\n", options.csv);
  return ended ? kSuccess : kInterrupted;
}

int run_forget(const PeopleOptions& options) {
  const auto forgotten = forget(options);
  if (!forgotten) return report(forgotten.error());
  fmt::print("{} is forgotten\n", options.name);
  for (const auto& copy : forgotten->copies)
    fmt::print(stderr, "warning: {} was damaged and kept; it may hold {} still: delete it\n", copy.string(),
               options.name);
  return kSuccess;
}

using Options = std::shared_ptr<PeopleOptions>;

void add_follow(CLI::App& people, int& exit_code) {
  const auto run = std::make_shared<RunCommand>();
  run->person.emplace();
  auto* command = people.add_subcommand(
      "follow", "run a robot whose task is to follow somebody (6.4): cgsr run with more of its options");
  command->add_option("--config", run->config, "the robot's file")->required();
  command->add_option("--identities", run->person->identities,
                      "the identities file instead of the one that the file names");
  command->add_option("--name", run->person->name, "whom; nobody named: whoever is identified first");
  command->add_option("--seed", run->seed, "of the simulation instead of the one that the file names")
      ->check(whole_number());
  command->add_option("--duration", run->run.duration_s, "end after that many seconds")->check(in_range(1e-3, 1e6));
  command->add_flag("--dry-run", run->run.dry_run, "compute and record, command nothing");
  command->add_flag("--arm", run->run.arm, "arm as soon as nothing speaks against it: the robot will move");
  command->add_option("--csv", run->run.csv, "write a row per image");
  command->add_option("--video", run->run.video, "write a video of what the robot saw and did, with numbers");
  command->add_option("--json", run->json, "write the summary for machines");
  add_force_option(*command, run->force);
  command->add_option("--log-level", run->log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
  command->callback([run, &exit_code] { exit_code = run_robot(*run); });
}

CLI::App* add(CLI::App& people, const char* name, const char* meaning, const Options& options) {
  auto* command = people.add_subcommand(name, meaning);
  command
      ->add_option("--identities", options->identities,
                   "the identities file: personal data, readable by its owner alone")
      ->required();
  return command;
}

void add_images(CLI::App* command, const Options& options) {
  command->add_option("--input", options->input, "video, image folder or image")->required();
  command->add_option("--cascade", options->cascade, "OpenCV's face cascade")->capture_default_str();
  command
      ->add_option("--eye-cascade", options->eye_cascade,
                   "its eye cascade: what has no eye is no stranger's face; empty: eyes are not looked for")
      ->capture_default_str();
  command->add_option("--min-face", options->min_face_px, "smallest face that is sought, pixels")
      ->check(in_range(20, 400))
      ->capture_default_str();
}

}  // namespace

void add_people_command(CLI::App& app, int& exit_code) {
  auto* people = app.add_subcommand("people", "who is that: enrol faces, name them, forget them (chapter 6)");
  people->require_subcommand(1);
  const auto options = std::make_shared<PeopleOptions>();

  auto* enrolling = add(*people, "enroll", "learn somebody's face from images in which it is alone", options);
  enrolling->add_option("--name", options->name, "of the person")->required();
  enrolling->add_flag("--more", options->more, "add views to somebody who is enrolled already");
  enrolling->add_flag("--alike", options->alike,
                      "enrol somebody although the face is taken for that of somebody who is enrolled: two look alike");
  add_images(enrolling, options);
  enrolling->callback([options, &exit_code] { exit_code = run_enroll(*options); });

  auto* identifying = add(*people, "identify", "say whose faces are in the images (6.2.1)", options);
  add_images(identifying, options);
  identifying->add_option("--csv", options->csv,
                          "write a row for each face: the person's number, 0 for a stranger's; names stand only in the "
                          "identities file and on the terminal");
  add_force_option(*identifying, options->force);
  identifying->callback([options, &exit_code] { exit_code = run_identify(*options); });

  add_follow(*people, exit_code);

  auto* forgetting = add(*people, "forget", "delete somebody's face and name", options);
  forgetting->add_option("--name", options->name, "of the person")->required();
  forgetting->callback([options, &exit_code] { exit_code = run_forget(*options); });
}

}  // namespace cgsr::app
