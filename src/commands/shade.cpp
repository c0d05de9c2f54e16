#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "pipeline/stages/shade_stage.h"
#include "pipeline/world/index.h"
#include "pipeline/world/load.h"
#include "platform/work_budget.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "src/output/map_view.h"
#include "src/output/picture.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string map;
  std::string camera;
  std::string pose;
  std::vector<double> lamp;
  std::string output;
  std::string image;
  double lamp_sigma_m = 0.0;
  stages::ShadeStageParameters shade;
  bool force = false;
};

/// Darkens what lies in shade and tints blue what may: the masks as the robot has them, cell by cell.
void draw_masks(const shade::ShadeMasks& masks, cv::Mat& picture) {
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const int column = std::min(x * masks.width / picture.cols, masks.width - 1);
      const int row = std::min(y * masks.height / picture.rows, masks.height - 1);
      const auto cell = static_cast<std::size_t>(row * masks.width + column);
      auto& pixel = picture.at<cv::Vec3b>(y, x);
      if (masks.surface_shaded[cell] != 0) pixel *= 0.45;
      if (masks.possibly_shaded[cell] != 0) pixel = pixel * 0.7 + cv::Vec3b(70, 20, 0);
    }
  }
}

double share(const std::vector<std::uint8_t>& mask) {
  const auto lit = std::count(mask.begin(), mask.end(), std::uint8_t{0});
  return 100.0 * (1.0 - static_cast<double>(lit) / static_cast<double>(mask.size()));
}

Result<void> claim_output(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.map, "--map");
  files.reads(options.camera, "--camera");
  files.reads(options.pose, "--pose");
  files.reads(options.image, "--image");
  files.writes(options.output, "--output", picture_file());
  return files.claim();
}

/// The lamp as the command line gives it.
Result<illumination::KnownLamp> lamp_of(const Options& options) {
  illumination::KnownLamp lamp;
  lamp.p_WL = {options.lamp[0], options.lamp[1], options.lamp[2]};
  if (!lamp.p_WL.allFinite()) return fail("--lamp: three finite numbers are expected, in metres");
  lamp.covariance = options.lamp_sigma_m * options.lamp_sigma_m * Eigen::Matrix3d::Identity();
  return lamp;
}

/// The masks as a robot at rest gets them: the stage's first turn prepares the lamp's place, the next one renders.
Result<stages::ShadowMasks> masks_of(const Options& options, std::shared_ptr<const world::Map> map,
                                     const geometry::Camera& camera, const geometry::Pose& X_WC) {
  const auto lamp = lamp_of(options);
  if (!lamp) return tl::unexpected(lamp.error());
  stages::ShadeStage stage(std::move(map), camera, options.shade);
  UnlimitedBudget budget;
  const geometry::Matrix6d exact = geometry::Matrix6d::Zero();
  stage.update(budget, X_WC, exact, &*lamp);
  auto masks = stage.update(budget, X_WC, exact, &*lamp);
  if (!masks || !masks->masks) {
    return fail(fmt::format("no masks: {}", to_string(masks ? masks->status : stages::ShadeStatus::kPreparing)));
  }
  return std::move(*masks);
}

int run_shade(const Options& options) {
  if (const auto claimed = claim_output(options); !claimed) return report(claimed.error());
  auto loaded = world::load_map(options.map);
  if (!loaded) return report(loaded.error());
  const auto map = std::make_shared<const world::Map>(std::move(*loaded));
  const auto camera = read_camera(options.camera);
  if (!camera) return report(camera.error());
  const auto X_WC = read_pose(options.pose);
  if (!X_WC) return report(X_WC.error());

  cv::Mat picture;
  if (options.image.empty()) {
    picture = draw_surfaces(*map, world::Index(*map), *X_WC, *camera);
  } else {
    auto image = read_picture(options.image, *camera, options.camera);
    if (!image) return report(image.error());
    picture = std::move(*image);
  }
  const auto shade = masks_of(options, map, *camera, *X_WC);
  if (!shade) return report(shade.error());
  const shade::ShadeMasks& masks = *shade->masks;
  draw_masks(masks, picture);
  if (const auto written = write_picture(options.output, picture); !written) return report(written.error());
  fmt::print("{}: {:.1f} % of the surfaces seen lie in shade, {:.1f} % of the image may\n", options.output,
             share(masks.surface_shaded), share(masks.possibly_shaded));
  return kSuccess;
}

}  // namespace

void add_shade_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("shade", "which parts of an image lie in a lamp's shade, or may");
  command->add_option("--map", options->map, ".obj, .gltf, .glb, .cao or .cgsrmap")->required();
  command->add_option("--camera", options->camera, "intrinsics (YAML, as ROS writes them)")->required();
  command->add_option("--pose", options->pose, "where the camera is in the map: CSV of one row")->required();
  command->add_option("--lamp", options->lamp, "the lamp's centre in the map, X,Y,Z in metres")
      ->required()
      ->delimiter(',')
      ->expected(3);
  command->add_option("--output", options->output, "the picture")->required();
  command->add_option("--image", options->image, "drawn over this instead of the map's surfaces");
  command->add_option("--width", options->shade.masks.width, "columns of the masks")
      ->check(in_range(16, 1024))
      ->capture_default_str();
  command->add_option("--height", options->shade.masks.height, "rows of the masks")
      ->check(in_range(16, 1024))
      ->capture_default_str();
  command
      ->add_option("--lamp-sigma", options->lamp_sigma_m,
                   "standard deviation of each coordinate of the lamp, in metres: the mask of what may lie in shade "
                   "widens with it")
      ->check(in_range(0.0, 10.0))
      ->capture_default_str();
  command
      ->add_option("--sigmas", options->shade.masks.sigmas,
                   "standard deviations of lamp and map by which that mask is widened; 0: not at all")
      ->check(in_range(0.0, 10.0))
      ->capture_default_str();
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run_shade(*options); });
}

}  // namespace cgsr::app
