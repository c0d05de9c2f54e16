// `cgsr devices camera --setup`: fixed exposure and white balance for what a camera sees.
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "hal/v4l2/find_camera.h"
#include "hal/v4l2/video_device.h"
#include "src/commands/command.h"
#include "src/commands/option_checks.h"
#include "src/config/load.h"
#include "src/devices/camera_setup.h"
#include "src/output/output_claims.h"
#include "src/output/terminal_picture.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

struct Options {
  bool setup = false;
  std::string config;
  std::string device;
  std::string output;
  bool force = false;
  int columns = 80;
};

std::string histogram_text(const devices::LumaHistogram& histogram) {
  constexpr int kBins = 16;
  std::vector<Bar> bars(kBins);
  for (int bin = 0; bin < kBins; ++bin) {
    double sum = 0.0;
    for (int luma = 16 * bin; luma < 16 * (bin + 1); ++luma) sum += histogram.counts[static_cast<std::size_t>(luma)];
    const double percent = histogram.pixels > 0 ? 100.0 * sum / histogram.pixels : 0.0;
    bars[static_cast<std::size_t>(bin)] = {fmt::format("{}..{}", 16 * bin, 16 * bin + 15), percent,
                                           fmt::format("{:.1f} %", percent)};
  }
  return bar_chart(bars);
}

Result<hal::v4l2::V4l2Parameters> parameters_of(const Options& options) {
  hal::v4l2::V4l2Parameters parameters;
  if (!options.config.empty()) {
    auto robot = config::load_sections(options.config);
    if (!robot) return tl::unexpected(robot.error());
    parameters = robot->camera.v4l2;
  }
  if (!options.device.empty()) parameters.device = options.device;
  return parameters;
}

int run_setup(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.config, "--config");
  files.writes(options.output, "--output", toml_with({"camera"}));
  if (auto claimed = files.claim(); !claimed) return report(claimed.error());
  const auto parameters = parameters_of(options);
  if (!parameters) return report(parameters.error());
  const bool colors = isatty(STDOUT_FILENO) != 0;
  const auto show = [&](const ImageView& image, const std::string& label) {
    fmt::print("{}{}\n", terminal_picture(image, options.columns, colors), label);
  };
  const devices::CameraAccess access{hal::v4l2::make_video_device, hal::v4l2::find_camera};
  const auto setup = devices::set_up_camera(*parameters, access, show);
  if (!setup) return report(setup.error());
  fmt::print("\nluma (16 black, 235 white): {:.1f} % black, {:.1f} % cut off\n{}\n",
             100.0 * setup->histogram.black_share(), 100.0 * setup->histogram.saturated_share(),
             histogram_text(setup->histogram));
  for (const std::string& note : setup->notes) fmt::print("note: {}\n", note);
  const std::string lines = devices::setup_lines(*setup);
  if (options.output.empty()) {
    fmt::print("\nThe lines of the robot's file:\n\n{}", lines);
    return kSuccess;
  }
  if (auto written = write_file(options.output, lines); !written) return report(written.error());
  fmt::print("\nwritten to {}: `extends = \"{}\"` takes it over\n", options.output, options.output);
  return kSuccess;
}

}  // namespace

void add_devices_camera(CLI::App& devices, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = devices.add_subcommand("camera", "fix a camera's exposure and white balance for what it sees");
  command->add_flag("--setup", options->setup, "measure, show picture and histogram, and print the lines")->required();
  command->add_option("--device", options->device, "a device node, or an id that cgsr devices prints");
  command->add_option("--config", options->config, "a robot's file whose camera, size and rate are taken");
  command->add_option("--output", options->output, "write the lines to this file");
  add_force_option(*command, options->force);
  command->add_option("--columns", options->columns, "the width of the picture in characters")
      ->check(in_range(8, 400))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run_setup(*options); });
}

}  // namespace cgsr::app
