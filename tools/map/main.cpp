// cgsr-map: what `cgsr map refine` starts, and `cgsr map refine accept`. Links Ceres, the robot's program does not.
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "src/commands/option_checks.h"
#include "src/commands/parse_error.h"
#include "tools/map/accept_run.h"
#include "tools/map/refine_run.h"

namespace cgsr::app {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
}

int accept_command_line(int argc, char** argv) {
  CLI::App app{"Draw edges that refine proposed, and that a person has looked at, into the map.",
               "cgsr map refine accept"};
  app.get_formatter()->column_width(34);
  AcceptOptions options;
  app.add_option("map", options.map, "the refined map: OBJ, metres, z up")->required();
  app.add_option("--proposals", options.proposals, "lines that cgsr map refine --proposals wrote: .obj")->required();
  app.add_option("--edges", options.numbers, "numbers of those that are real, as on the picture: 1,4")
      ->required()
      ->delimiter(',');
  app.add_option("--output", options.output, "the map as the robot loads it: .cgsrmap")->required();
  add_force_option(app, options.force);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return report_parse_error(app, wrong, argc, argv);
  }
  const auto done = run_accept(options);
  return done ? 0 : complain(done.error());
}

int refine_command_line(int argc, char** argv) {
  CLI::App app{"Move a map's parts to where the images of a drive show them, and propose edges that it lacks.",
               "cgsr map refine"};
  app.get_formatter()->column_width(34);
  RefineOptions options;
  app.add_option("map", options.map, "OBJ, metres, z up")->required();
  app.add_option("--camera", options.camera, "YAML of ROS's camera_calibration")->required();
  app.add_option("--input", options.input, "video or image folder of the drive")->required();
  app.add_option("--poses", options.poses,
                 "CSV with a pose of the camera for each image, as cgsr localize --csv writes it")
      ->required();
  app.add_option("--odometry", options.odometry,
                 "CSV with the robot's pose in its odometry's frame, a row for each image");
  app.add_option("--mount", options.mount, "the camera's pose on the robot, for --odometry: CSV or TOML");
  app.add_option("--output", options.output, "the refined map: .obj")->required();
  app.add_option("--proposals", options.proposals, "edges that the map lacks, as lines: .obj");
  app.add_option("--picture", options.picture,
                 "each of these edges in the image that shows it longest, numbered: .png");
  app.add_option("--json", options.json, "what came of each part, and the proposals");
  app.add_option("--map-sigma", options.parameters.map_sigma_m, "how far the map's parts are off, metres")
      ->check(in_range(1e-3, 1.0))
      ->capture_default_str();
  app.add_option("--shape-sigma", options.parameters.shape_sigma_m, "how far corners of one part are off, metres")
      ->check(in_range(1e-4, 1.0))
      ->capture_default_str();
  app.add_option("--sigma-m", options.sigma_m, "of the given poses where their file does not say, metres")
      ->check(in_range(1e-4, 10.0))
      ->capture_default_str();
  app.add_option("--sigma-deg", options.sigma_deg, "likewise, degrees")
      ->check(in_range(0.01, 90.0))
      ->capture_default_str();
  add_force_option(app, options.force);
  app.footer("cgsr map refine accept --help: how proposals that are real get into the map.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return report_parse_error(app, wrong, argc, argv);
  }
  const auto done = run_refine(options);
  return done ? 0 : complain(done.error());
}

}  // namespace
}  // namespace cgsr::app

int main(int argc, char** argv) {
  try {
    const bool accepts = argc > 1 && std::string_view(argv[1]) == "accept";
    return accepts ? cgsr::app::accept_command_line(argc - 1, argv + 1) : cgsr::app::refine_command_line(argc, argv);
  } catch (const std::exception& surprise) {
    return cgsr::app::complain(cgsr::Error{std::string("unexpected: ") + surprise.what()});
  }
}
