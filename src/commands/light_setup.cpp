#include "src/commands/light_setup.h"

#include <utility>

#include <fmt/format.h>

#include "src/config/load.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"

namespace cgsr::app {
namespace {

/// Takes the probe board that a robot.toml states, where it states one.
Result<void> take_board(const std::string& robot_file, illumination::BoardParameters& board) {
  const auto stated = read_board(robot_file);
  if (!stated) return tl::unexpected(stated.error());
  if (!*stated) return {};
  const CalibratedBoard& calibrated = **stated;
  board.position_m = calibrated.position_m;
  board.turn_deg = calibrated.turn_deg;
  board.width_m = calibrated.width_m;
  board.depth_m = calibrated.depth_m;
  board.probes = static_cast<int>(calibrated.probe.size());
  for (std::size_t i = 0; i < calibrated.probe.size(); ++i) {
    illumination::ProbeParameters& probe = i == 0 ? board.left : board.right;
    probe.apex_m = calibrated.probe[i].apex_m;
    probe.foot_m = calibrated.probe[i].foot_m;
    probe.base_radius_m = calibrated.probe[i].base_radius_m;
  }
  return {};
}

}  // namespace

Result<LightSetup> open_light_setup(const std::string& config_file, const std::string& camera_file,
                                    const std::string& mount_file, const std::string& images) {
  auto config = config::load_light(config_file);
  if (!config) return tl::unexpected(config.error());
  const auto camera = read_camera(camera_file);
  if (!camera) return tl::unexpected(camera.error());
  geometry::Pose X_RC = config->mount.X_RC();
  const std::string& calibrated = mount_file.empty() ? config->mount_file : mount_file;
  if (!calibrated.empty()) {
    const auto mount = read_mount(calibrated);
    if (!mount) return tl::unexpected(mount.error());
    X_RC = *mount;
  }
  if (!mount_file.empty()) {
    if (const auto taken = take_board(mount_file, config->probes.board); !taken) return tl::unexpected(taken.error());
  }
  auto board = illumination::make_board(config->probes.board, X_RC, *camera);
  if (!board) return fail(fmt::format("{}: {}", config_file, board.error().message));
  auto input = ImageInput::open({images});
  if (!input) return tl::unexpected(input.error());
  if (input->mode().width_px != camera->width_px || input->mode().height_px != camera->height_px) {
    return fail(fmt::format("{}: images of {}x{}, but {} is of a camera of {}x{}", images, input->mode().width_px,
                            input->mode().height_px, camera_file, camera->width_px, camera->height_px));
  }
  return LightSetup{*config, *board, std::move(*input)};
}

}  // namespace cgsr::app
