#include "src/light/light_run.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "platform/config/reader.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using illumination::LampStatus;
using illumination::ObservationStatus;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr const char* kColumns = "frame,found,reason,x,y,z,probes,sigma_m";

std::string unanswered_row(int frame, std::string_view reason) {
  return fmt::format("{},0,{},,,,,\n", frame, reason);
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

LightRun::LightRun(const LightOptions& options, const LightConfig& config, const illumination::Board& board,
                   ImageInput input, std::vector<PoseRow> poses)
    : options_(options),
      config_(config),
      input_(std::move(input)),
      poses_(std::move(poses)),
      observer_(board, config_.probes, config_.lamp.height_m - board.X_RB.translation().z()),
      filter_(board, config_.lamp),
      causes_(static_cast<std::size_t>(ObservationStatus::kSaturated) + 1) {}

Result<LightRun> LightRun::open(const LightOptions& options) {
  auto config = config::read_file<LightConfig>(options.config, config::Missing::kTakesDefault);
  if (!config) return tl::unexpected(config.error());
  const auto camera = read_camera(options.camera);
  if (!camera) return tl::unexpected(camera.error());
  geometry::Pose X_RC = config->mount.X_RC();
  if (!options.mount.empty()) {
    const auto mount = read_mount(options.mount);
    if (!mount) return tl::unexpected(mount.error());
    X_RC = *mount;
    if (const auto taken = take_board(options.mount, config->probes.board); !taken)
      return tl::unexpected(taken.error());
  }
  const auto board = illumination::make_board(config->probes.board, X_RC, *camera);
  if (!board) return fail(fmt::format("{}: {}", options.config, board.error().message));
  if (const auto checked = illumination::check_lamp(*board, config->lamp); !checked) {
    return fail(fmt::format("{}: {}", options.config, checked.error().message));
  }
  std::vector<PoseRow> poses;
  if (!options.pose.empty()) {
    auto read = read_poses(options.pose);
    if (!read) return tl::unexpected(read.error());
    poses = std::move(*read);
  }
  auto input = ImageInput::open({options.input});
  if (!input) return tl::unexpected(input.error());
  if (input->mode().width_px != camera->width_px || input->mode().height_px != camera->height_px) {
    return fail(fmt::format("{}: images of {}x{}, but {} is of a camera of {}x{}", options.input,
                            input->mode().width_px, input->mode().height_px, options.camera, camera->width_px,
                            camera->height_px));
  }
  return LightRun(options, *config, *board, std::move(*input), std::move(poses));
}

Result<bool> LightRun::step() {
  auto next = input_.next();
  if (next.end) return false;
  const int frame = images_++;
  if (!next.image) {
    problems_.push_back(fmt::format("image {}: {}", frame, next.problem));
    rows_ += unanswered_row(frame, "unreadable");
    return true;
  }
  const auto observation = observer_.observe(next.image.view());
  ++causes_[static_cast<std::size_t>(observation.status)];
  const auto lamps = illumination::locate_lamps(observer_.board(), config_.lamp, observation);
  const geometry::Pose* X_WR = pose_of(frame);
  if (X_WR != nullptr) filter_.update(observation, *X_WR, geometry::Matrix6d::Zero());
  bool found = false;
  for (int i = 0; i < lamps.count; ++i) {
    const auto& lamp = lamps.lamp[static_cast<std::size_t>(i)];
    if (lamp.status != LampStatus::kFound) continue;
    found = true;
    const Eigen::Vector3d p = X_WR != nullptr ? Eigen::Vector3d(*X_WR * lamp.p_RL) : lamp.p_RL;
    rows_ += fmt::format("{},1,,{:.4f},{:.4f},{:.4f},{},{:.4f}\n", frame, p.x(), p.y(), p.z(),
                         std::popcount(static_cast<unsigned>(lamp.probes)), std::sqrt(lamp.covariance.trace()));
  }
  if (!found) {
    const bool seen = observation.status == ObservationStatus::kSeen;
    last_cause_ = seen ? illumination::name_of(lamps.status) : illumination::name_of(observation.status);
    rows_ += unanswered_row(frame, last_cause_);
  }
  answered_ += found ? 1 : 0;
  return true;
}

const geometry::Pose* LightRun::pose_of(int frame) const {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const PoseRow& row = poses_[i];
    if (row.frame ? *row.frame == frame : static_cast<int>(i) == frame) return &row.X;
  }
  return nullptr;
}

Result<void> LightRun::finish() {
  if (options_.csv.empty()) return {};
  return write_file(options_.csv, fmt::format("{}\n{}", kColumns, rows_));
}

std::vector<std::string> LightRun::summary() const {
  std::vector<std::string> lines;
  for (std::size_t cause = 0; cause < causes_.size(); ++cause) {
    if (causes_[cause] == 0) continue;
    lines.push_back(
        fmt::format("{:6} images: {}", causes_[cause], illumination::name_of(static_cast<ObservationStatus>(cause))));
  }
  for (int i = 0; i < filter_.count(); ++i) {
    const auto& lamp = filter_.lamp(i);
    if (!lamp.steady) continue;
    const Eigen::Vector3d sigma = lamp.covariance.diagonal().cwiseSqrt();
    lines.push_back(fmt::format(
        "lamp {} at ({:.3f}, {:.3f}, {:.3f}) m in the world, sigma ({:.3f}, {:.3f}, {:.3f}), seen in {} images", i,
        lamp.p_WL.x(), lamp.p_WL.y(), lamp.p_WL.z(), sigma.x(), sigma.y(), sigma.z(), lamp.seen));
  }
  lines.insert(lines.end(), problems_.begin(), problems_.end());
  return lines;
}

}  // namespace cgsr::app
