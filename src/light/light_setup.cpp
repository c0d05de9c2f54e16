#include "src/light/light_setup.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "platform/config/reader.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"

namespace cgsr::app {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

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

geometry::Pose MountParameters::X_RC() const {
  const double down = down_deg / kDegPerRad;
  const double s = std::sin(down);
  const double c = std::cos(down);
  geometry::Pose X = geometry::Pose::Identity();
  X.linear().col(0) = Eigen::Vector3d(0.0, -1.0, 0.0);
  X.linear().col(1) = Eigen::Vector3d(-s, 0.0, -c);
  X.linear().col(2) = Eigen::Vector3d(c, 0.0, -s);
  const Eigen::Vector3d turn(turn_deg[0], turn_deg[1], turn_deg[2]);
  X.linear() = geometry::rotation_of(turn / kDegPerRad) * X.linear();
  X.translation() = Eigen::Vector3d(position_m[0], position_m[1], position_m[2]);
  return X;
}

Result<LightSetup> open_light_setup(const std::string& config_file, const std::string& camera_file,
                                    const std::string& mount_file, const std::string& images) {
  auto config = config::read_file<LightConfig>(config_file, config::Missing::kTakesDefault);
  if (!config) return tl::unexpected(config.error());
  const auto camera = read_camera(camera_file);
  if (!camera) return tl::unexpected(camera.error());
  geometry::Pose X_RC = config->mount.X_RC();
  if (!mount_file.empty()) {
    const auto mount = read_mount(mount_file);
    if (!mount) return tl::unexpected(mount.error());
    X_RC = *mount;
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
