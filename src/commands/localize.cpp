#include <memory>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "platform/config/canonical.h"
#include "platform/stop.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/localize_run.h"
#include "src/commands/map_options.h"
#include "src/commands/option_checks.h"
#include "src/output/progress.h"

namespace cgsr::app {
namespace {

int run_localize(const LocalizeOptions& options) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  auto run = LocalizeRun::open(options);
  if (!run) return report(run.error());
  Progress progress;
  bool ended = false;
  while (!stop.requested() && !ended) {
    const auto more = run->step();
    if (!more) return report(more.error());
    ended = !*more;
    progress.show(fmt::format("image {}: {} corrected", run->images(), run->corrected()));
  }
  if (auto finished = run->finish(); !finished) return report(finished.error());
  for (const std::string& note : run->notes()) fmt::print(stderr, "note: {}\n", note);
  const std::string hash = config::hash(run->config());
  if (!options.json.empty()) {
    nlohmann::ordered_json json{{"images", run->images()},
                                {"corrected", run->corrected()},
                                {"edges", run->map().edges.size()},
                                {"max_units", run->max_units()},
                                {"config_sha256", hash}};
    if (options.anywhere) {
      json["first_pose"] = to_string(run->first_pose_phase());
      json["found_in"] = run->found_in() ? nlohmann::ordered_json(*run->found_in()) : nlohmann::ordered_json(nullptr);
    }
    if (auto written = write_file(options.json, json.dump(1) + "\n"); !written) return report(written.error());
  }
  fmt::print("{} images{}, pose corrected in {}\n", run->images(), ended ? "" : " until it was stopped",
             run->corrected());
  if (!options.csv.empty()) fmt::print("poses    {}\n", options.csv);
  if (!options.video.empty()) fmt::print("video    {}\n", options.video);
  if (!options.plan.empty()) fmt::print("plan     {}\n", options.plan);
  fmt::print("configuration {}\n", hash);
  return ended ? kSuccess : kInterrupted;
}

void add_output_options(CLI::App& command, LocalizeOptions& options, CLI::Option* anywhere) {
  command.add_option("--csv", options.csv, "write a row for each image");
  command.add_option("--video", options.video, "write a video with the map's edges over the images");
  command
      .add_option("--plan", options.plan,
                  "with --anywhere: draw where the robot may be into a picture of the map from above")
      ->needs(anywhere);
  command.add_option("--json", options.json, "write the summary for machines");
  add_force_option(command, options.force);
}

}  // namespace

void add_localize_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LocalizeOptions>();
  auto* command = app.add_subcommand("localize", "correct a camera's pose against a map of edges (chapter 4)");
  command->add_option("--map", options->map, "OBJ, glTF, ViSP .cao, or what cgsr map import wrote")->required();
  add_map_frame_options(*command, options->load);
  command->add_option("--camera", options->camera, "YAML of ROS's camera_calibration")->required();
  command->add_option("--input", options->input, "video, image folder or image")->required();
  auto* pose = command->add_option("--pose", options->pose, "CSV with the pose of image 0: follow from there");
  auto* priors = command->add_option("--priors", options->priors, "CSV with a pose for each image: correct each one");
  pose->excludes(priors);
  auto* anywhere = command
                       ->add_flag("--anywhere", options->anywhere,
                                  "no pose is known: the robot turns on the spot, once and up to a sixth more, and "
                                  "stands then; the search over the whole "
                                  "map goes on until it is found, and it is followed from there")
                       ->excludes(pose)
                       ->excludes(priors);
  auto* odometry = command
                       ->add_option("--odometry", options->odometry,
                                    "CSV with the robot's pose in its odometry's frame, a row for each image")
                       ->excludes(priors);
  auto* mount =
      command
          ->add_option(
              "--mount", options->mount,
              "the camera's pose on the robot: CSV, or the TOML that cgsr calibrate mount writes; without it the "
              "odometry is the camera's own")
          ->excludes(priors);
  command
      ->add_option("--sigma-m", options->sigma_m,
                   "standard deviation of the given poses along every axis, instead of the configuration's; for --pose "
                   "instead of 1 % of the distance to the map's middle, at most 2 cm")
      ->check(in_range(1e-4, 10.0));
  command
      ->add_option("--sigma-deg", options->sigma_deg,
                   "standard deviation of the given poses about every axis, instead of the configuration's; for --pose "
                   "instead of half a degree, on a floor of one")
      ->check(in_range(0.01, 90.0));
  command->add_option("--method", options->method, "instead of the configuration's")
      ->check(CLI::IsMember({"glcorrect", "stronger", "paper"}));
  command->add_option("--config", options->config,
                      "a file as config/localization/floor.toml, or a robot's file; without it six free numbers");
  command
      ->add_option(
          "--units", options->units,
          "with --odometry: most looks at the map and rounds of matching for an image after the first; a search "
          "goes on over the images that follow; 0: all it asks for")
      ->check(in_range(0, 1'000'000))
      ->capture_default_str()
      ->needs(odometry);
  anywhere->needs(odometry)->needs(mount);
  add_output_options(*command, *options, anywhere);
  command->callback([command, options, &exit_code] {
    if (!options->anywhere && options->pose.empty() == options->priors.empty()) {
      throw CLI::ValidationError(command->get_name(), "give either --pose, --priors or --anywhere");
    }
    exit_code = run_localize(*options);
  });
}

}  // namespace cgsr::app
