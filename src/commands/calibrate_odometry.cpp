#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/calibration/odometry.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/input/pose_pairs.h"
#include "src/input/robot_calibration.h"
#include "src/output/picture.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using geometry::Pose;

constexpr double kDegrees = 180.0 / 3.14159265358979;

struct Options {
  std::string odometry;
  std::string poses;
  std::string mount;
  double stretch_m = 2.0;
  std::string output;
  std::string picture;
  bool json = false;
  bool force = false;
};

/// The way by the odometry before (red) and after (green), over the true one (black).
cv::Mat draw_ways(const std::vector<Pose>& before, const std::vector<Pose>& after, const std::vector<Pose>& truth) {
  constexpr int kSide = 800;
  constexpr int kMargin = 40;
  const auto placed = [&](const std::vector<Pose>& way) {
    std::vector<Eigen::Vector2d> out;
    out.reserve(way.size());
    const Pose X = truth.front() * way.front().inverse();
    for (const Pose& pose : way) out.emplace_back((X * pose.translation()).head<2>());
    return out;
  };
  const std::vector<std::vector<Eigen::Vector2d>> ways = {placed(truth), placed(before), placed(after)};
  Eigen::Vector2d low = ways[0][0];
  Eigen::Vector2d high = low;
  for (const auto& way : ways) {
    for (const Eigen::Vector2d& at : way) {
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  }
  const double scale = (kSide - 2 * kMargin) / std::max((high - low).maxCoeff(), 0.1);
  cv::Mat picture(kSide, kSide, CV_8UC3, cv::Scalar::all(255));
  const cv::Scalar colors[] = {{0, 0, 0}, {40, 40, 220}, {60, 160, 60}};
  for (std::size_t k = 0; k < ways.size(); ++k) {
    std::vector<cv::Point> points;
    points.reserve(ways[k].size());
    for (const Eigen::Vector2d& at : ways[k]) {
      points.emplace_back(kMargin + cvRound(scale * (at.x() - low.x())),
                          kSide - kMargin - cvRound(scale * (at.y() - low.y())));
    }
    cv::polylines(picture, points, false, colors[k], k == 0 ? 2 : 1, cv::LINE_AA);
  }
  return picture;
}

/// The odometry's poses and the robot's true ones, those of its camera turned into them where a mount is given.
Result<PosePairs> poses_of_robot(const Options& options) {
  auto pairs = read_pairs(options.odometry, options.poses);
  if (!pairs || options.mount.empty()) return pairs;
  const auto X_RC = read_mount(options.mount);
  if (!X_RC) return tl::unexpected(X_RC.error());
  const Pose X_CR = X_RC->inverse();
  for (Pose& X : pairs->second) X = X * X_CR;
  return pairs;
}

Result<void> claim_outputs(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.odometry, "--odometry");
  files.reads(options.poses, "--poses");
  files.reads(options.mount, "--mount");
  files.writes(options.output, "--output", toml_with({"odometry"}));
  files.writes(options.picture, "--picture", picture_file());
  return files.claim();
}

int run_odometry(const Options& options) {
  if (const auto claimed = claim_outputs(options); !claimed) return report(claimed.error());
  const auto pairs = poses_of_robot(options);
  if (!pairs) return report(pairs.error());
  const auto scales = calibration::calibrate_odometry(pairs->first, pairs->second, options.stretch_m);
  if (!scales) return report(scales.error());
  const std::string text = fmt::format(
      "# By what the odometry's way and turn are to be multiplied.\n[odometry]\nscale_forward = {:.6f}\nscale_turn = "
      "{:.6f}\n",
      scales->forward, scales->turn);
  if (!options.output.empty()) {
    if (const auto written = write_file(options.output, text); !written) return report(written.error());
  }
  if (!options.picture.empty()) {
    if (const auto written = write_picture(
            options.picture,
            draw_ways(pairs->first, calibration::scaled_odometry(pairs->first, scales->forward, scales->turn),
                      pairs->second));
        !written)
      return report(written.error());
  }
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"scale_forward", scales->forward},
                                      {"scale_turn", scales->turn},
                                      {"sigma_forward", scales->sigma_forward},
                                      {"sigma_turn", scales->sigma_turn},
                                      {"rms_m", scales->rms_m},
                                      {"rms_deg", kDegrees * scales->rms_rad},
                                      {"rms_before_m", scales->rms_before_m},
                                      {"rms_before_deg", kDegrees * scales->rms_before_rad},
                                      {"way_m", scales->way_m},
                                      {"turned_deg", kDegrees * scales->turned_rad},
                                      {"stretches", scales->stretches},
                                      {"predicted", pairs->predicted}}
                           .dump(1));
    return kSuccess;
  }
  fmt::print("round     {:.1f} m, turns of {:.0f} degrees, {} stretches\n", scales->way_m,
             kDegrees * scales->turned_rad, scales->stretches);
  if (pairs->predicted > 0) fmt::print("left out  {} pairs with a predicted pose (corrected = 0)\n", pairs->predicted);
  fmt::print("forward   {:.5f} +- {:.5f}\nturn      {:.5f} +- {:.5f}\n", scales->forward, scales->sigma_forward,
             scales->turn, scales->sigma_turn);
  fmt::print("residual  {:.2f} cm, {:.2f} degrees RMS per stretch; before {:.2f} cm, {:.2f} degrees\n",
             100.0 * scales->rms_m, kDegrees * scales->rms_rad, 100.0 * scales->rms_before_m,
             kDegrees * scales->rms_before_rad);
  if (!options.output.empty()) fmt::print("written   {}\n", options.output);
  return kSuccess;
}

}  // namespace

void add_calibrate_odometry(CLI::App& calibrate, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* odometry =
      calibrate.add_subcommand("odometry", "scales of way and turn, from a round with true or localised poses");
  odometry->add_option("--odometry", options->odometry, "the odometry's poses of the robot, CSV with frame")
      ->required();
  odometry
      ->add_option("--poses", options->poses,
                   "true or localised poses, CSV with frame: the robot's, or with --mount the camera's, as cgsr "
                   "localize writes them")
      ->required();
  odometry->add_option("--mount", options->mount,
                       "robot.toml with [mount], as cgsr calibrate mount writes it: --poses are the camera's");
  odometry->add_option("--stretch", options->stretch_m, "way in metres after which ends are compared")
      ->check(in_range(0.2, 100.0))
      ->capture_default_str();
  odometry->add_option("--output", options->output, "TOML to write, section [odometry]");
  odometry->add_option("--picture", options->picture, "picture of the ways");
  odometry->add_flag("--json", options->json, "as JSON");
  add_force_option(*odometry, options->force);
  odometry->callback([options, &exit_code] { exit_code = run_odometry(*options); });
}

}  // namespace cgsr::app
