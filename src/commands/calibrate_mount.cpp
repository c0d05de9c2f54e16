#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/calibration/mount.h"
#include "src/commands/board_views.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "src/input/pose_pairs.h"
#include "src/output/picture.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using geometry::Pose;

constexpr double kDegrees = 180.0 / 3.14159265358979;

struct Options {
  BoardOptions look;
  std::string camera;
  std::vector<double> board_at;
  std::string board_poses;
  std::string poses;
  std::string odometry;
  std::string output;
  std::string picture;
  bool json = false;
  bool force = false;
};

nlohmann::json three(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void print_mount(const calibration::Mount& mount) {
  const Eigen::Vector3d& p = mount.X_RC.translation();
  const Eigen::Vector3d forward = mount.X_RC.linear().col(2);
  fmt::print("camera    {:.4f}, {:.4f}, {:.4f} m in the robot's frame, +- {:.4f}, {:.4f}, {:.4f}\n", p.x(), p.y(),
             p.z(), mount.sigma_m.x(), mount.sigma_m.y(), mount.sigma_m.z());
  fmt::print("looks     {:.2f} degrees to the left, {:.2f} down, +- {:.3f}, {:.3f}, {:.3f} about the robot's axes\n",
             kDegrees * std::atan2(forward.y(), forward.x()), -kDegrees * std::asin(std::clamp(forward.z(), -1.0, 1.0)),
             kDegrees * mount.sigma_rad.x(), kDegrees * mount.sigma_rad.y(), kDegrees * mount.sigma_rad.z());
}

nlohmann::json mount_as_json(const calibration::Mount& mount) {
  const Eigen::Quaterniond q(mount.X_RC.linear());
  return {{"position_m", three(mount.X_RC.translation())},
          {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"sigma_m", three(mount.sigma_m)},
          {"sigma_deg", three(kDegrees * mount.sigma_rad)}};
}

Result<std::vector<Pose>> poses_of_boards(const Options& options, const std::vector<calibration::BoardView>& views) {
  if (options.board_poses.empty()) {
    return std::vector<Pose>(views.size(), calibration::board_on_floor(options.board_at[0], options.board_at[1],
                                                                       options.board_at[2] / kDegrees));
  }
  const auto rows = read_poses(options.board_poses);
  if (!rows) return tl::unexpected(rows.error());
  if (rows->size() == 1 && !rows->front().frame) return std::vector<Pose>(views.size(), rows->front().X);
  std::vector<Pose> out;
  out.reserve(views.size());
  for (const calibration::BoardView& view : views) {
    const auto row = std::find_if(rows->begin(), rows->end(), [&](const PoseRow& r) { return r.frame == view.image; });
    if (row == rows->end()) {
      return fail(fmt::format("{}: no row with frame {}, in which the board is seen", options.board_poses, view.image));
    }
    out.push_back(row->X);
  }
  return out;
}

int finish_mount(const Options& options, const calibration::Mount& mount, nlohmann::json json) {
  if (!options.output.empty()) {
    if (const auto written = write_file(options.output, calibration::mount_as_toml(mount)); !written)
      return report(written.error());
  }
  if (options.json) {
    json.update(mount_as_json(mount));
    fmt::print("{}\n", json.dump(1));
    return kSuccess;
  }
  print_mount(mount);
  if (!options.output.empty()) fmt::print("written   {}\n", options.output);
  return kSuccess;
}

/// Where the board's axes and corners lie by the fitted mount, over the last image.
cv::Mat draw_fit(const BoardViews& found, const calibration::Mount& mount, const Pose& X_RB,
                 const calibration::Board& board, const geometry::Camera& camera) {
  cv::Mat picture = draw_corners(found, {});
  const Pose X_CB = mount.X_RC.inverse() * X_RB;
  for (const cv::Point3f& point : board.points()) {
    const auto at =
        camera.pixel_of(X_CB * Eigen::Vector3d(static_cast<double>(point.x), static_cast<double>(point.y), 0.0));
    if (at) cv::drawMarker(picture, {cvRound(at->x()), cvRound(at->y())}, {40, 40, 220}, cv::MARKER_CROSS, 5);
  }
  return picture;
}

int run_mount_from_boards(const Options& options) {
  const auto board = calibration::parse_board(options.look.board, options.look.square_m);
  if (!board) return report(board.error());
  const auto camera = read_camera(options.camera);
  if (!camera) return report(camera.error());
  const auto found = find_views(options.look, *board, false);
  if (!found) return report(found.error());
  if (found->views.empty()) {
    return report(Error{fmt::format("{}: the board of {} inner corners is in none of {} images", options.look.input,
                                    options.look.board, found->images)});
  }
  if (found->size != cv::Size(camera->width_px, camera->height_px)) {
    return report(
        Error{fmt::format("{}: images of {}x{} px, but {} is of a camera of {}x{}", options.look.input,
                          found->size.width, found->size.height, options.camera, camera->width_px, camera->height_px)});
  }
  const auto X_RB = poses_of_boards(options, found->views);
  if (!X_RB) return report(X_RB.error());
  const auto mount = calibration::mount_from_boards(found->views, *X_RB, *board, *camera);
  if (!mount) return report(mount.error());
  if (!options.picture.empty()) {
    if (const auto written = write_picture(options.picture, draw_fit(*found, *mount, X_RB->back(), *board, *camera));
        !written)
      return report(written.error());
  }
  nlohmann::json views = nlohmann::json::array();
  for (std::size_t i = 0; i < found->views.size(); ++i) {
    views.push_back({{"image", found->views[i].image}, {"rms_px", mount->view_rms[i]}});
    if (!options.json) fmt::print("image {:5}  {:.3f} px\n", found->views[i].image, mount->view_rms[i]);
  }
  if (!options.json) fmt::print("residual  {:.3f} px RMS over {} views\n", mount->rms, found->views.size());
  return finish_mount(options, *mount, {{"rms_px", mount->rms}, {"views", views}});
}

int run_mount_from_poses(const Options& options) {
  const auto pairs = read_pairs(options.poses, options.odometry);
  if (!pairs) return report(pairs.error());
  const auto mount = calibration::mount_from_poses(pairs->first, pairs->second);
  if (!mount) return report(mount.error());
  if (!options.json) {
    fmt::print("residual  {:.2f} cm, {:.2f} degrees RMS over {} pairs of poses\n", 100.0 * mount->rms,
               kDegrees * mount->rms_rad, pairs->frames.size());
    if (pairs->predicted > 0)
      fmt::print("left out  {} pairs with a predicted pose (corrected = 0)\n", pairs->predicted);
  }
  return finish_mount(options, *mount,
                      {{"rms_m", mount->rms},
                       {"rms_deg", kDegrees * mount->rms_rad},
                       {"pairs", pairs->frames.size()},
                       {"predicted", pairs->predicted}});
}

Result<void> claim_outputs(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.look.input, "--input");
  files.reads(options.camera, "--camera");
  files.reads(options.board_poses, "--board-poses");
  files.reads(options.poses, "--poses");
  files.reads(options.odometry, "--odometry");
  files.writes(options.output, "--output", toml_with({"mount"}));
  files.writes(options.picture, "--picture", picture_file());
  return files.claim();
}

int run_mount(const Options& options) {
  if (const auto claimed = claim_outputs(options); !claimed) return report(claimed.error());
  const bool from_boards = !options.look.input.empty();
  const bool from_poses = !options.poses.empty() && !options.odometry.empty();
  if (from_boards == from_poses) {
    report(Error{"a mount comes from --input (views of a board) or from --poses and --odometry; expected one of both"});
    return kUsage;
  }
  if (from_poses) return run_mount_from_poses(options);
  if (options.camera.empty() || options.board_at.empty() == options.board_poses.empty()) {
    report(Error{"views of a board need --camera and where the board lies: --board-at or --board-poses"});
    return kUsage;
  }
  return run_mount_from_boards(options);
}

}  // namespace

void add_calibrate_mount(CLI::App& calibrate, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* mount = calibrate.add_subcommand(
      "mount",
      "where the camera is on the robot: from a chessboard at a stated place, or from corrected poses beside odometry");
  mount->add_option("--input", options->look.input, "images of the board: video, image folder or image");
  add_board_options(*mount, options->look);
  mount->add_option("--camera", options->camera, "intrinsics (YAML)");
  mount
      ->add_option("--board-at", options->board_at,
                   "the board lies on the floor: X,Y in metres of its first inner corner (the one whose square towards "
                   "the board's "
                   "middle is black) and HEADING in degrees of its rows, all in the robot's frame")
      ->delimiter(',')
      ->expected(3);
  mount->add_option("--board-poses", options->board_poses,
                    "or: poses of the board in the robot's frame, CSV: one row, or a row per image with its frame");
  mount->add_option("--poses", options->poses, "camera poses in the map, CSV with frame, as cgsr localize writes them");
  mount->add_option("--odometry", options->odometry, "odometry's poses of the robot, CSV with frame");
  mount->add_option("--output", options->output, "robot file to write (TOML, section [mount])");
  mount->add_option("--picture", options->picture, "picture of corners seen and fitted");
  mount->add_flag("--json", options->json, "as JSON");
  add_force_option(*mount, options->force);
  mount->callback([options, &exit_code] { exit_code = run_mount(*options); });
}

}  // namespace cgsr::app
