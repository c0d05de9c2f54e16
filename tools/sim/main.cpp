// cgsr-sim: what `cgsr sim` starts. Looks at simulated worlds and writes them down; the ray tracer lives here, not in the robot's program.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include "src/commands/option_checks.h"
#include "src/commands/parse_error.h"
#include "src/output/output_claims.h"
#include "tools/sim/export_world.h"
#include "tools/sim/generate_home.h"
#include "tools/sim/home_report.h"
#include "tools/sim/render_world.h"
#include "tools/sim/run_scenario.h"
#include "tools/sim/words.h"
#include "tools/sim/world_file.h"

namespace cgsr::sim {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
}

struct RenderWords {
  std::string world, pose, from, to, size;
  double at_s = 0.0;
  bool no_noise = false;
  bool no_lens = false;
  bool force = false;
  PictureRequest request;
  PictureFiles files;
};

struct ExportWords {
  std::string world, folder;
  ExportRequest request;
};

void add_world(CLI::App& command, std::string& world) {
  command.add_option("--world", world, "a name in config/worlds, such as home, or a file")->required();
}

void add_render(CLI::App& command, RenderWords& words) {
  add_world(command, words.world);
  auto* pose = command.add_option("--pose", words.pose, "tx,ty,tz,qw,qx,qy,qz: the camera in the world, metres");
  auto* from = command.add_option("--from", words.from, "X,Y,Z: the camera, metres")->excludes(pose);
  auto* to =
      command.add_option("--to", words.to, "X,Y,Z: what is in the middle of the image")->excludes(pose)->needs(from);
  from->needs(to);
  auto* view =
      command.add_option("--view", words.request.view, "a view that the world's file names")->excludes(pose, from);
  command
      .add_option("--robot", words.request.robot, "whose camera; without a place of its own the picture is its view")
      ->excludes(view);
  command.add_option("--time", words.at_s, "when, seconds")->check(cgsr::app::in_range(0.0, 86400.0));
  command.add_option("--on", words.request.on, "switch this line on; a lamp that a robot carries only in its own view")
      ->allow_extra_args(false);
  command.add_option("--off", words.request.off, "switch this line off: room lamps are on, a robot's own are off")
      ->allow_extra_args(false);
  command.add_option("--seed", words.request.seed, "of the noise")
      ->check(cgsr::app::whole_number())
      ->capture_default_str();
  command.add_option("--size", words.size, "WIDTHxHEIGHT; the camera's 640x480 when not given");
  command.add_flag("--no-noise", words.no_noise, "without the sensor's noise");
  command.add_flag("--no-lens", words.no_lens, "without the lens's distortion");
  command.add_option("--edge-samples", words.request.edge_samples, "rays for a pixel at an edge")
      ->check(CLI::IsMember({1, 4, 16}))
      ->capture_default_str();
  command.add_option("--threads", words.request.threads, "the picture does not depend on it")
      ->check(cgsr::app::in_range(1, 64))
      ->capture_default_str();
  command.add_option("--output", words.files.output, "the picture, .png")->required();
  command.add_option("--truth", words.files.truth_folder,
                     "also write what is there into this folder: truth.csv, depth, parts, shadow masks");
  cgsr::app::add_force_option(command, words.force);
  command.add_option("--lamp", words.files.lamp, "whose shadows --truth means; the first one's when not given");
}

void add_export(CLI::App& command, ExportWords& words) {
  add_world(command, words.world);
  command.add_option("--output", words.folder, "folder")->required();
  command.add_option("--robot", words.request.robot, "whose camera, mount and probes; the first one's when not given");
  command.add_option("--seed", words.request.seed, "of the errors")
      ->check(cgsr::app::whole_number())
      ->capture_default_str();
  command.add_option("--errors", words.request.error_factor, "so many times the errors that are usual; 0: none")
      ->capture_default_str();
}

struct HomeWords {
  std::uint32_t seed = 0;
  int report = 0;
  std::string folder;
  bool force = false;
};

void add_home(CLI::App& command, HomeWords& words) {
  command.add_option("--seed", words.seed, "which home: the same number, the same home")
      ->check(cgsr::app::in_range(0, kMaxHomeSeed))
      ->required();
  command.add_option("--output", words.folder, "folder for world, map, camera, robot and round; or for the report")
      ->required();
  command
      .add_option("--report", words.report,
                  "no home, but how so many of them are distributed, from --seed on, and twelve from above")
      ->check(cgsr::app::in_range(1, 10000));
  cgsr::app::add_force_option(command, words.force);
}

int home(const HomeWords& words) {
  if (words.report > 0) {
    const auto text = report_homes({words.seed, words.report, words.folder, words.force});
    if (!text) return complain(text.error());
    fmt::print("{}", *text);
    return 0;
  }
  const auto home = generate_home_to({words.seed, words.folder, words.force});
  if (!home) return complain(home.error());
  fmt::print("{}", describe_home(*home));
  return 0;
}

struct RunWords {
  std::string scenario, size;
  bool force = false;
  ScenarioRun run;
};

void add_run(CLI::App& command, RunWords& words) {
  command.add_option("--scenario", words.scenario, "a name in config/scenarios, such as home-follow, or a file")
      ->required();
  command.add_option("--seed", words.run.seed, "of noise, slip and how far actors go astray")
      ->check(cgsr::app::in_range(0, 1000000000))
      ->capture_default_str();
  command.add_option("--duration", words.run.duration_s, "end after that many seconds")
      ->check(cgsr::app::in_range(1e-3, 1e6));
  command.add_option("--size", words.size, "WIDTHxHEIGHT; 640x480 when not given");
  command.add_option("--threads", words.run.threads, "the images do not depend on it")
      ->check(cgsr::app::in_range(1, 64))
      ->capture_default_str();
  command.add_option("--video", words.run.video, "the camera's images beside a plan of the home: .mkv, .avi or .mp4");
  command.add_option("--truth", words.run.truth, "what is really there, a row an image: .csv");
  cgsr::app::add_force_option(command, words.force);
}

int run(RunWords& words) {
  const auto file = find_scenario(words.scenario);
  if (!file) return complain(file.error());
  words.run.scenario = *file;
  app::OutputClaims files(words.force);
  files.reads(*file, "--scenario");
  files.writes(words.run.video, "--video", app::video_file());
  files.writes(words.run.truth, "--truth", app::csv_file(kTruthColumns));
  if (const auto claimed = files.claim(); !claimed) return complain(claimed.error());
  if (!words.size.empty()) {
    const auto size = parse_image_size(words.size);
    if (!size) return complain(size.error());
    words.run.width_px = size->width_px;
    words.run.height_px = size->height_px;
  }
  const auto played = run_scenario(words.run);
  if (!played) return complain(played.error());
  fmt::print("{}: {} images, {:.2f} s; the object is in view in {}\n", words.scenario, played->images, played->seconds,
             played->images_with_object);
  return 0;
}

Result<void> claim_picture(const RenderWords& words) {
  const auto world = find_world(words.world);
  if (!world) return tl::unexpected(world.error());
  app::OutputClaims files(words.force);
  files.reads(*world, "--world");
  files.writes(words.files.output, "--output", app::picture_file());
  return files.claim();
}

int render(RenderWords& words, bool time_given) {
  if (const auto claimed = claim_picture(words); !claimed) return complain(claimed.error());
  const auto world = load_world(words.world);
  if (!world) return complain(world.error());
  if (!words.pose.empty() || !words.from.empty()) {
    const auto X_WC = words.pose.empty() ? parse_view(words.from, words.to) : parse_pose(words.pose);
    if (!X_WC) return complain(X_WC.error());
    words.request.X_WC = *X_WC;
  }
  if (!words.size.empty()) {
    const auto size = parse_image_size(words.size);
    if (!size) return complain(size.error());
    words.request.size = *size;
  }
  if (time_given) words.request.at_s = words.at_s;
  words.request.noise = !words.no_noise;
  words.request.lens = !words.no_lens;
  const auto done = render_world(*world, words.request, words.files);
  return done ? 0 : complain(done.error());
}

int export_to_folder(const ExportWords& words) {
  const auto done = load_world(words.world).and_then([&](const World& world) {
    return export_world(world, words.request, words.folder);
  });
  return done ? 0 : complain(done.error());
}

int info(const std::string& name) {
  const auto world = load_world(name);
  if (!world) return complain(world.error());
  fmt::print("{}", describe_world(*world));
  return 0;
}

int run_command_line(int argc, char** argv) {
  CLI::App app{"Simulated worlds: look at them, write them down.", "cgsr sim"};
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  RenderWords render_words;
  CLI::App* render_command = app.add_subcommand("render", "a picture of a world, from any place at any time");
  add_render(*render_command, render_words);
  ExportWords export_words;
  CLI::App* export_command = app.add_subcommand(
      "export", "a world's geometry as a map, and a calibrated copy of it, camera, mount and probes");
  add_export(*export_command, export_words);
  RunWords run_words;
  CLI::App* run_command =
      app.add_subcommand("run", "a scenario, played with a robot that nobody commands: video and truth");
  add_run(*run_command, run_words);
  HomeWords home_words;
  CLI::App* home_command =
      app.add_subcommand("home", "a home drawn from a seed: world, map, camera, robot and a round through it");
  add_home(*home_command, home_words);
  std::string world;
  CLI::App* info_command =
      app.add_subcommand("info", "what is in a world: robots, views, lamps and their lines, actors");
  add_world(*info_command, world);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return cgsr::app::report_parse_error(app, wrong, argc, argv);
  }
  if (*render_command) return render(render_words, render_command->count("--time") > 0);
  if (*run_command) return run(run_words);
  if (*home_command) return home(home_words);
  if (*export_command) return export_to_folder(export_words);
  return info(world);
}

}  // namespace
}  // namespace cgsr::sim

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  try {
    return cgsr::sim::run_command_line(argc, argv);
  } catch (const std::exception& surprise) {
    return cgsr::sim::complain(cgsr::Error{std::string("unexpected: ") + surprise.what()});
  }
}
