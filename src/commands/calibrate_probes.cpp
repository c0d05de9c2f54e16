#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/calibration/probes.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/light_setup.h"
#include "src/commands/option_checks.h"
#include "src/input/pose_file.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string input;
  std::string camera;
  std::string config;
  std::string mount;
  std::string poses;
  std::vector<double> lamp;
  std::string output;
  bool json = false;
  bool force = false;
};

nlohmann::json three(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// \param predicted  images left out: their pose is a prediction.
Result<calibration::ProbeCalibration> probes_from(const Options& options, int& predicted) {
  auto setup = open_light_setup(options.config, options.camera, options.mount, options.input);
  if (!setup) return tl::unexpected(setup.error());
  const auto poses = read_poses(options.poses);
  if (!poses) return tl::unexpected(poses.error());
  const illumination::Board& board = setup->board;
  const Eigen::Vector3d p_WL(options.lamp[0], options.lamp[1], options.lamp[2]);
  illumination::ProbeObserver observer(board, setup->config.probes, p_WL.z() - board.X_RB.translation().z());
  std::vector<calibration::ProbeView> views;
  std::string_view cause = "no image";
  for (int number = 0;; ++number) {
    const auto next = setup->input.next();
    if (next.end) break;
    if (!next.image) continue;
    calibration::ProbeView view;
    view.image = number;
    const PoseRow* row = nullptr;
    for (std::size_t i = 0; i < poses->size(); ++i) {
      const PoseRow& one = (*poses)[i];
      if (one.frame ? *one.frame == number : static_cast<int>(i) == number) row = &one;
    }
    if (row == nullptr) return fail(fmt::format("{}: no pose of image {}", options.poses, number));
    if (!row->corrected) {
      ++predicted;
      continue;
    }
    view.X_WR = row->X;
    view.observation = observer.observe(next.image.view());
    if (view.observation.status != illumination::ObservationStatus::kSeen) {
      cause = illumination::to_string(view.observation.status);
    }
    views.push_back(view);
  }
  auto calibrated = calibration::calibrate_probes(board, setup->config.probes.board, views, p_WL);
  if (!calibrated) {
    return fail(fmt::format("{}: {} (the last image without a shadow: {}; left out, corrected = 0 in {}: {})",
                            options.input, calibrated.error().message, cause, options.poses, predicted));
  }
  return calibrated;
}

Result<void> claim_output(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.input, "--input");
  files.reads(options.camera, "--camera");
  reads_configuration(files, options.config, "--config");
  files.reads(options.mount, "--mount");
  files.reads(options.poses, "--poses");
  files.writes(options.output, "--output", toml_with({"mount", "board", "board.probe"}));
  return files.claim();
}

int run_probes(const Options& options) {
  if (const auto claimed = claim_output(options); !claimed) return report(claimed.error());
  int predicted = 0;
  const auto calibration = probes_from(options, predicted);
  if (!calibration) return report(calibration.error());
  if (!options.output.empty()) {
    if (const auto written = write_file(options.output, calibration::probes_as_toml(*calibration)); !written)
      return report(written.error());
  }
  const illumination::BoardParameters& board = calibration->board;
  if (options.json) {
    nlohmann::json probes = nlohmann::json::array();
    for (int i = 0; i < board.probes; ++i) {
      const auto& probe = i == 0 ? board.left : board.right;
      probes.push_back({{"apex_m", probe.apex_m},
                        {"foot_m", probe.foot_m},
                        {"apex_sigma_m", three(calibration->tip_sigma_m[static_cast<std::size_t>(i)])}});
    }
    fmt::print("{}\n", nlohmann::json{{"rms_m", calibration->rms_m},
                                      {"rms_before_m", calibration->rms_before_m},
                                      {"images", calibration->views},
                                      {"predicted", predicted},
                                      {"shadows", calibration->shadows},
                                      {"board", {{"turn_deg", board.turn_deg}, {"probe", probes}}}}
                           .dump(1));
    return kSuccess;
  }
  fmt::print("{} images, {} shadows of tips\n", calibration->views, calibration->shadows);
  if (predicted > 0) fmt::print("left out  {} images with a predicted pose (corrected = 0)\n", predicted);
  fmt::print("residual  {:.2f} mm RMS on the board, {:.2f} mm before\n", 1e3 * calibration->rms_m,
             1e3 * calibration->rms_before_m);
  fmt::print("board     turned {:.3f}, {:.3f}, {:.3f} degrees, +- {:.3f}, {:.3f}, {:.3f}\n", board.turn_deg[0],
             board.turn_deg[1], board.turn_deg[2], calibration->turn_sigma_deg.x(), calibration->turn_sigma_deg.y(),
             calibration->turn_sigma_deg.z());
  for (int i = 0; i < board.probes; ++i) {
    const auto& probe = i == 0 ? board.left : board.right;
    const auto& sigma = calibration->tip_sigma_m[static_cast<std::size_t>(i)];
    fmt::print("tip {}     {:.4f}, {:.4f}, {:.4f} m in the robot's frame, +- {:.4f}, {:.4f}, {:.4f}\n", i,
               probe.apex_m[0], probe.apex_m[1], probe.apex_m[2], sigma.x(), sigma.y(), sigma.z());
  }
  if (!options.output.empty()) fmt::print("written   {}\n", options.output);
  return kSuccess;
}

}  // namespace

void add_calibrate_probes(CLI::App& calibrate, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* probes = calibrate.add_subcommand(
      "probes", "board, probes and the camera against them, from images with a lamp at a known place");
  probes->add_option("--input", options->input, "images of the probes: video or image folder")->required();
  probes->add_option("--camera", options->camera, "intrinsics (YAML)")->required();
  probes
      ->add_option("--config", options->config,
                   "what was measured by hand: a file as config/illumination/lamp-robot.toml, or a robot's file")
      ->required();
  probes->add_option("--mount", options->mount, "robot.toml with [mount], instead of the configuration's");
  probes->add_option("--poses", options->poses, "poses of the robot in the world, CSV, a row per image")->required();
  probes->add_option("--lamp", options->lamp, "X,Y,Z of the lamp in metres, world frame")
      ->delimiter(',')
      ->expected(3)
      ->required();
  probes->add_option("--output", options->output, "robot file to write (TOML, sections [mount] and [board])");
  probes->add_flag("--json", options->json, "as JSON");
  add_force_option(*probes, options->force);
  probes->callback([options, &exit_code] { exit_code = run_probes(*options); });
}

}  // namespace cgsr::app
