#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "src/calibrate/board.h"
#include "src/calibrate/intrinsics.h"
#include "src/calibrate/mount.h"
#include "src/calibrate/odometry.h"
#include "src/command.h"
#include "src/input/camera_file.h"
#include "src/input/image_input.h"
#include "src/input/pose_file.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using geometry::Pose;

constexpr double kDegrees = 180.0 / 3.14159265358979;
/// A view counts as new when its corners moved by so much of the image's width (mean) since every one that was taken.
constexpr float kNewView = 0.03F;

struct Options {
  std::string input;
  std::string board = "9x6";
  double square_m = 0.025;
  std::string name = "camera";
  std::string output;
  std::string picture;
  int every = 1;
  int most = 60;
  bool third_radial = false;
  bool json = false;

  std::string camera;
  std::vector<double> board_at;
  std::string board_poses;
  std::string poses;
  std::string odometry;
  double stretch_m = 2.0;
};

struct Views {
  std::vector<BoardView> views;
  cv::Mat backdrop;  ///< the last image in which a board was seen, in colour.
  cv::Size size;
  int images = 0;
  int without = 0;
  int damaged = 0;
};

cv::Mat luma_of(const ImageView& image) {
  cv::Mat grey(image.height_px, image.width_px, CV_8U);
  const int step = image.format == PixelFormat::kYuyv ? 2 : 1;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) grey.at<std::uint8_t>(y, x) = image.row(y)[step * x];
  return grey;
}

bool is_new(const std::vector<BoardView>& views, const std::vector<cv::Point2f>& corners, int width) {
  const auto moved = [&](const BoardView& view) {
    float sum = 0.0F;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const cv::Point2f step = corners[i] - view.corners[i];
      sum += std::hypot(step.x, step.y);
    }
    return sum / static_cast<float>(corners.size()) >= kNewView * static_cast<float>(width);
  };
  return std::all_of(views.begin(), views.end(), moved);
}

/// Looks for the board in every `every`-th image. \param only_new  leaves out views that show what another one showed.
Result<Views> find_views(const Options& options, const Board& board, bool only_new) {
  auto input = ImageInput::open({options.input, 0, 0, 0, 0});
  if (!input) return tl::unexpected(input.error());
  Views out;
  for (int number = 0;; ++number) {
    const auto next = input->next();
    if (next.end) break;
    if (!next.image) {
      ++out.damaged;
      continue;
    }
    if (number % options.every != 0 || static_cast<int>(out.views.size()) >= options.most) continue;
    ++out.images;
    const cv::Mat grey = luma_of(next.image.view());
    out.size = grey.size();
    auto corners = find_board(grey, board);
    if (!corners) {
      ++out.without;
      continue;
    }
    if (only_new && !is_new(out.views, *corners, grey.cols)) continue;
    out.views.push_back({number, std::move(*corners)});
    cv::cvtColor(grey, out.backdrop, cv::COLOR_GRAY2BGR);
  }
  return out;
}

bool write_picture(const std::string& file, const cv::Mat& picture) {
  try {
    return cv::imwrite(file, picture);
  } catch (const cv::Exception&) {  // an ending that it does not know
    return false;
  }
}

/// All corners over the last image that shows a board: green where they were used, red where left out.
cv::Mat draw_corners(const Views& found, const std::vector<bool>& used) {
  constexpr int kShift = 4;
  cv::Mat picture = found.backdrop.clone();
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    const cv::Scalar color = used.empty() || used[i] ? cv::Scalar(60, 200, 60) : cv::Scalar(40, 40, 220);
    for (const cv::Point2f& corner : found.views[i].corners) {
      const cv::Point at(cvRound(16.0F * corner.x), cvRound(16.0F * corner.y));
      cv::circle(picture, at, 2 << kShift, color, 1, cv::LINE_AA, kShift);
    }
  }
  return picture;
}

nlohmann::json three(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

int run_camera(const Options& options) {
  const auto board = parse_board(options.board, options.square_m);
  if (!board) return report(board.error());
  const auto found = find_views(options, *board, true);
  if (!found) return report(found.error());
  IntrinsicsOptions settings;
  settings.third_radial = options.third_radial;
  const auto result = calibrate_intrinsics(found->views, *board, found->size, settings);
  if (!options.picture.empty() && !found->views.empty() &&
      !write_picture(options.picture, draw_corners(*found, result ? result->used : std::vector<bool>{}))) {
    return report(Error{fmt::format("{}: the picture cannot be written", options.picture)});
  }
  if (!result) {
    return report(Error{fmt::format("{}: {} (looked at {} images, {} without a board, {} damaged)", options.input,
                                    result.error().message, found->images, found->without, found->damaged)});
  }
  if (const auto written = write_file(options.output, camera_as_yaml(result->camera, options.name)); !written) {
    return report(written.error());
  }
  const geometry::Camera& c = result->camera;
  const geometry::Camera& s = result->sigma;
  const auto used = std::count(result->used.begin(), result->used.end(), true);
  if (options.json) {
    nlohmann::json views = nlohmann::json::array();
    for (std::size_t i = 0; i < found->views.size(); ++i) {
      views.push_back({{"image", found->views[i].image},
                       {"rms_px", result->view_rms_px[i]},
                       {"used", static_cast<bool>(result->used[i])}});
    }
    const auto numbers = [](const geometry::Camera& k) {
      return nlohmann::json{{"fx_px", k.fx_px}, {"fy_px", k.fy_px}, {"cx_px", k.cx_px},
                            {"cy_px", k.cy_px}, {"k1", k.k1},       {"k2", k.k2},
                            {"p1", k.p1},       {"p2", k.p2},       {"k3", k.k3}};
    };
    fmt::print("{}\n", nlohmann::json{{"camera", numbers(c)},
                                      {"sigma", numbers(s)},
                                      {"rms_px", result->rms_px},
                                      {"coverage", result->coverage},
                                      {"width_px", c.width_px},
                                      {"height_px", c.height_px},
                                      {"views", views}}
                           .dump(1));
    return kSuccess;
  }
  fmt::print("{} images, {} views of the board taken, {} used\n", found->images, found->views.size(), used);
  fmt::print("image     {}x{} px, boards cover {:.0f} % of it\n", c.width_px, c.height_px, 100.0 * result->coverage);
  fmt::print("fx, fy    {:.2f} +- {:.2f}, {:.2f} +- {:.2f} px\n", c.fx_px, s.fx_px, c.fy_px, s.fy_px);
  fmt::print("cx, cy    {:.2f} +- {:.2f}, {:.2f} +- {:.2f} px\n", c.cx_px, s.cx_px, c.cy_px, s.cy_px);
  fmt::print("lens      k1 {:.4f}  k2 {:.4f}  p1 {:.5f}  p2 {:.5f}  k3 {:.4f}\n", c.k1, c.k2, c.p1, c.p2, c.k3);
  fmt::print("residual  {:.3f} px RMS\n", result->rms_px);
  for (std::size_t i = 0; i < found->views.size(); ++i) {
    fmt::print("image {:5}  {:.3f} px{}\n", found->views[i].image, result->view_rms_px[i],
               result->used[i] ? "" : "  left out");
  }
  fmt::print("written   {}\n", options.output);
  return kSuccess;
}

void print_mount(const Mount& mount) {
  const Eigen::Vector3d& p = mount.X_RC.translation();
  const Eigen::Vector3d forward = mount.X_RC.linear().col(2);
  fmt::print("camera    {:.4f}, {:.4f}, {:.4f} m in the robot's frame, +- {:.4f}, {:.4f}, {:.4f}\n", p.x(), p.y(),
             p.z(), mount.sigma_m.x(), mount.sigma_m.y(), mount.sigma_m.z());
  fmt::print("looks     {:.2f} degrees to the left, {:.2f} down, +- {:.3f}, {:.3f}, {:.3f} about the robot's axes\n",
             kDegrees * std::atan2(forward.y(), forward.x()), -kDegrees * std::asin(std::clamp(forward.z(), -1.0, 1.0)),
             kDegrees * mount.sigma_rad.x(), kDegrees * mount.sigma_rad.y(), kDegrees * mount.sigma_rad.z());
}

nlohmann::json mount_as_json(const Mount& mount) {
  const Eigen::Quaterniond q(mount.X_RC.linear());
  return {{"position_m", three(mount.X_RC.translation())},
          {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"sigma_m", three(mount.sigma_m)},
          {"sigma_deg", three(kDegrees * mount.sigma_rad)}};
}

/// The rows of both files that belong to the same image.
struct Pairs {
  std::vector<Pose> first;
  std::vector<Pose> second;
  std::vector<std::int64_t> frames;
};

Result<Pairs> read_pairs(const std::string& first_file, const std::string& second_file) {
  const auto first = read_poses(first_file);
  if (!first) return tl::unexpected(first.error());
  const auto second = read_poses(second_file);
  if (!second) return tl::unexpected(second.error());
  Pairs pairs;
  auto other = second->begin();
  for (const PoseRow& row : *first) {
    if (!row.frame || !other->frame) {
      return fail(fmt::format("{}: no column 'frame': it says which poses belong together",
                              row.frame ? second_file : first_file));
    }
    while (other != second->end() && *other->frame < *row.frame) ++other;
    if (other == second->end()) break;
    if (*other->frame != *row.frame) continue;
    pairs.first.push_back(row.X);
    pairs.second.push_back(other->X);
    pairs.frames.push_back(*row.frame);
  }
  if (pairs.frames.empty()) {
    return fail(fmt::format("{} and {} have no frame number in common", first_file, second_file));
  }
  return pairs;
}

Result<std::vector<Pose>> poses_of_boards(const Options& options, const std::vector<BoardView>& views) {
  if (options.board_poses.empty()) {
    return std::vector<Pose>(views.size(),
                             board_on_floor(options.board_at[0], options.board_at[1], options.board_at[2] / kDegrees));
  }
  const auto rows = read_poses(options.board_poses);
  if (!rows) return tl::unexpected(rows.error());
  if (rows->size() == 1 && !rows->front().frame) return std::vector<Pose>(views.size(), rows->front().X);
  std::vector<Pose> out;
  out.reserve(views.size());
  for (const BoardView& view : views) {
    const auto row = std::find_if(rows->begin(), rows->end(), [&](const PoseRow& r) { return r.frame == view.image; });
    if (row == rows->end()) {
      return fail(fmt::format("{}: no row with frame {}, in which the board is seen", options.board_poses, view.image));
    }
    out.push_back(row->X);
  }
  return out;
}

int finish_mount(const Options& options, const Mount& mount, nlohmann::json json) {
  if (!options.output.empty()) {
    if (const auto written = write_file(options.output, mount_as_toml(mount)); !written) return report(written.error());
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
cv::Mat draw_fit(const Views& found, const Mount& mount, const Pose& X_RB, const Board& board,
                 const geometry::Camera& camera) {
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
  const auto board = parse_board(options.board, options.square_m);
  if (!board) return report(board.error());
  const auto camera = read_camera(options.camera);
  if (!camera) return report(camera.error());
  const auto found = find_views(options, *board, false);
  if (!found) return report(found.error());
  if (found->views.empty()) {
    return report(Error{fmt::format("{}: the board of {} inner corners is in none of {} images", options.input,
                                    options.board, found->images)});
  }
  if (found->size != cv::Size(camera->width_px, camera->height_px)) {
    return report(
        Error{fmt::format("{}: images of {}x{} px, but {} is of a camera of {}x{}", options.input, found->size.width,
                          found->size.height, options.camera, camera->width_px, camera->height_px)});
  }
  const auto X_RB = poses_of_boards(options, found->views);
  if (!X_RB) return report(X_RB.error());
  const auto mount = mount_from_boards(found->views, *X_RB, *board, *camera);
  if (!mount) return report(mount.error());
  if (!options.picture.empty() &&
      !write_picture(options.picture, draw_fit(*found, *mount, X_RB->back(), *board, *camera))) {
    return report(Error{fmt::format("{}: the picture cannot be written", options.picture)});
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
  const auto mount = mount_from_poses(pairs->first, pairs->second);
  if (!mount) return report(mount.error());
  if (!options.json) {
    fmt::print("residual  {:.2f} cm, {:.2f} degrees RMS over {} pairs of poses\n", 100.0 * mount->rms,
               kDegrees * mount->rms_rad, pairs->frames.size());
  }
  return finish_mount(options, *mount,
                      {{"rms_m", mount->rms}, {"rms_deg", kDegrees * mount->rms_rad}, {"pairs", pairs->frames.size()}});
}

int run_mount(const Options& options) {
  const bool from_boards = !options.input.empty();
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

int run_odometry(const Options& options) {
  const auto pairs = read_pairs(options.odometry, options.poses);
  if (!pairs) return report(pairs.error());
  const auto scales = calibrate_odometry(pairs->first, pairs->second, options.stretch_m);
  if (!scales) return report(scales.error());
  const std::string text = fmt::format(
      "# By what the odometry's way and turn are to be multiplied.\n[odometry]\nscale_forward = {:.6f}\nscale_turn = "
      "{:.6f}\n",
      scales->forward, scales->turn);
  if (!options.output.empty()) {
    if (const auto written = write_file(options.output, text); !written) return report(written.error());
  }
  if (!options.picture.empty() &&
      !write_picture(
          options.picture,
          draw_ways(pairs->first, scaled_odometry(pairs->first, scales->forward, scales->turn), pairs->second))) {
    return report(Error{fmt::format("{}: the picture cannot be written", options.picture)});
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
                                      {"stretches", scales->stretches}}
                           .dump(1));
    return kSuccess;
  }
  fmt::print("round     {:.1f} m, turns of {:.0f} degrees, {} stretches\n", scales->way_m,
             kDegrees * scales->turned_rad, scales->stretches);
  fmt::print("forward   {:.5f} +- {:.5f}\nturn      {:.5f} +- {:.5f}\n", scales->forward, scales->sigma_forward,
             scales->turn, scales->sigma_turn);
  fmt::print("residual  {:.2f} cm, {:.2f} degrees RMS per stretch; before {:.2f} cm, {:.2f} degrees\n",
             100.0 * scales->rms_m, kDegrees * scales->rms_rad, 100.0 * scales->rms_before_m,
             kDegrees * scales->rms_before_rad);
  if (!options.output.empty()) fmt::print("written   {}\n", options.output);
  return kSuccess;
}

void add_board_options(CLI::App& command, Options& options) {
  command.add_option("--board", options.board, "the chessboard's inner corners, COLUMNSxROWS")->capture_default_str();
  command.add_option("--square", options.square_m, "side of a square in metres")
      ->check(CLI::Range(1e-3, 1.0))
      ->capture_default_str();
  command.add_option("--every", options.every, "look at every n-th image only")->check(CLI::Range(1, 1000000));
  command.add_option("--most", options.most, "views of the board to take at most")->check(CLI::Range(1, 1000));
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("calibrate", "camera, its place on the robot, its probes, and odometry, with residuals");
  command->require_subcommand(1);

  auto* camera = command->add_subcommand("camera", "intrinsics and lens from images of a chessboard");
  camera->add_option("--input", options->input, "video or image folder")->required();
  add_board_options(*camera, *options);
  camera->add_option("--output", options->output, "camera file to write (YAML, as ROS writes it)")->required();
  camera->add_option("--name", options->name, "the camera's name in it")->capture_default_str();
  camera->add_option("--picture", options->picture, "picture of all corners");
  camera->add_flag("--k3", options->third_radial, "a third radial term too, for wide lenses");
  camera->add_flag("--json", options->json, "as JSON");
  camera->callback([options, &exit_code] { exit_code = run_camera(*options); });

  auto* mount = command->add_subcommand(
      "mount",
      "where the camera is on the robot: from a chessboard at a stated place, or from corrected poses beside odometry");
  mount->add_option("--input", options->input, "images of the board: video, image folder or image");
  add_board_options(*mount, *options);
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
  mount->callback([options, &exit_code] { exit_code = run_mount(*options); });

  add_calibrate_probes(*command, exit_code);

  auto* odometry =
      command->add_subcommand("odometry", "scales of way and turn, from a round with true or localised poses");
  odometry->add_option("--odometry", options->odometry, "the odometry's poses of the robot, CSV with frame")
      ->required();
  odometry->add_option("--poses", options->poses, "true or localised poses of the robot, CSV with frame")->required();
  odometry->add_option("--stretch", options->stretch_m, "way in metres after which ends are compared")
      ->check(CLI::Range(0.2, 100.0))
      ->capture_default_str();
  odometry->add_option("--output", options->output, "TOML to write, section [odometry]");
  odometry->add_option("--picture", options->picture, "picture of the ways");
  odometry->add_flag("--json", options->json, "as JSON");
  odometry->callback([options, &exit_code] { exit_code = run_odometry(*options); });
}

}  // namespace cgsr::app
