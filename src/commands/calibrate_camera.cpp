#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/calibration/intrinsics.h"
#include "src/commands/board_views.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/input/camera_file.h"
#include "src/output/picture.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

struct Options {
  BoardOptions look;
  std::string name = "camera";
  std::string output;
  std::string picture;
  bool third_radial = false;
  bool json = false;
  bool force = false;
};

Result<void> claim_outputs(const Options& options) {
  OutputClaims files(options.force);
  files.reads(options.look.input, "--input");
  files.writes(options.output, "--output", camera_yaml());
  files.writes(options.picture, "--picture", picture_file());
  return files.claim();
}

int run_camera(const Options& options) {
  if (const auto claimed = claim_outputs(options); !claimed) return report(claimed.error());
  const auto board = calibration::parse_board(options.look.board, options.look.square_m);
  if (!board) return report(board.error());
  const auto found = find_views(options.look, *board, true);
  if (!found) return report(found.error());
  calibration::IntrinsicsOptions settings;
  settings.third_radial = options.third_radial;
  const auto result = calibration::calibrate_intrinsics(found->views, *board, found->size, settings);
  if (!options.picture.empty() && !found->views.empty()) {
    if (const auto written =
            write_picture(options.picture, draw_corners(*found, result ? result->used : std::vector<bool>{}));
        !written)
      return report(written.error());
  }
  if (!result) {
    return report(Error{fmt::format("{}: {} (looked at {} images, {} without a board, {} damaged)", options.look.input,
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

}  // namespace

void add_calibrate_camera(CLI::App& calibrate, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* camera = calibrate.add_subcommand("camera", "intrinsics and lens from images of a chessboard");
  camera->add_option("--input", options->look.input, "video or image folder")->required();
  add_board_options(*camera, options->look);
  camera->add_option("--output", options->output, "camera file to write (YAML, as ROS writes it)")->required();
  camera->add_option("--name", options->name, "the camera's name in it")->capture_default_str();
  camera->add_option("--picture", options->picture, "picture of all corners");
  camera->add_flag("--k3", options->third_radial, "a third radial term too, for wide lenses");
  camera->add_flag("--json", options->json, "as JSON");
  add_force_option(*camera, options->force);
  camera->callback([options, &exit_code] { exit_code = run_camera(*options); });
}

}  // namespace cgsr::app
