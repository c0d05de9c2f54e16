#include "tools/lab/probe_room.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "hal/sim/calibration/calibration_files.h"
#include "hal/sim/render/pixel_rays.h"
#include "pipeline/geometry/pose.h"
#include "platform/config/reader.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr double kRobotRadius_m = 0.35;
constexpr double kBoardRadius_m = 0.25;
constexpr float kLowest_m = 0.01F;  // above the floor
const Vector3d kElsewhere(-100.0, -100.0, 0.0);

std::array<double, 3> triple(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

sim::CalibrationErrors copy_errors() {
  sim::CalibrationErrors errors;
  errors.focal = 0.002;
  errors.centre_px = 0.64;  // 0.2 % of half an image
  errors.mount_deg = 0.3;
  errors.probe_m = 0.0005;
  return errors;
}

}  // namespace

Result<std::unique_ptr<ProbeRoom>> ProbeRoom::of(const sim::WorldSpec& spec, const std::filesystem::path& file) {
  auto world = sim::build_world(spec, file);
  if (!world) return tl::unexpected(world.error());
  std::unique_ptr<ProbeRoom> room(new ProbeRoom(std::move(*world)));
  const sim::CameraModel& camera = room->world_.scene.robots.front().camera;
  auto photographer = sim::Photographer::make(room->world_.scene, camera, {});
  if (!photographer) return tl::unexpected(photographer.error());
  room->photographer_ = std::move(*photographer);
  room->yuyv_.resize(std::size_t{2} * static_cast<std::size_t>(camera.width_px * camera.height_px));
  return room;
}

Result<std::unique_ptr<ProbeRoom>> ProbeRoom::make(const ProbeRoomLight& light) {
  const std::filesystem::path file = std::filesystem::path(source_path("config/worlds")) / "home.toml";
  auto spec = config::read_file<sim::WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  std::erase_if(spec->robot, [](const sim::RobotSpec& robot) { return !robot.has_board; });
  if (spec->robot.empty()) return fail("home.toml: there is no robot with a probe board");
  spec->object.clear();
  spec->lamp.resize(1);
  spec->lamp[0].radius_m = light.radius_m;
  spec->lamp[0].globe_radius_m = 0.0;
  spec->lamp[0].lumens = light.lumens;
  spec->lamp[0].on = light.on;
  spec->lamp[0].switch_name.clear();
  if (light.p_WL) spec->lamp[0].position_m = triple(*light.p_WL);
  for (double& lux : spec->ambient.illuminance_lux) lux *= light.ambient;
  if (light.second_p_WL) {
    spec->lamp.push_back(spec->lamp[0]);
    spec->lamp[1].name = "second lamp";
    spec->lamp[1].position_m = triple(*light.second_p_WL);
  }
  return of(*spec, file);
}

Result<std::unique_ptr<ProbeRoom>> ProbeRoom::make(const sim::GeneratedHome& home, std::size_t lamp) {
  sim::WorldSpec spec = home.world;
  std::erase_if(spec.robot, [](const sim::RobotSpec& robot) { return !robot.has_board; });
  spec.object.clear();
  for (std::size_t i = 0; i < home.lights.lamps.size(); ++i) {
    spec.lamp[i].on = i == lamp;
    spec.lamp[i].switch_name.clear();
  }
  std::swap(spec.lamp[0], spec.lamp[lamp]);
  return of(spec, spec.name);
}

sim::SceneState ProbeRoom::state(const sim::Pose& X_WR) const {
  sim::SceneState state = sim::state_at(world_.scene, 0.0, {}, {X_WR});
  for (std::size_t lamp = 0; lamp < state.lamps.size() && lamp < moved_.size(); ++lamp) {
    if (moved_[lamp]) state.lamps[lamp].p_WL = *moved_[lamp];
    if (!on_[lamp]) state.lamps[lamp].intensity_cd.setZero();
    state.lamps[lamp].intensity_cd *= static_cast<float>(factor_);
  }
  return state;
}

ImageView ProbeRoom::shoot(const sim::Pose& X_WR, std::uint32_t seed, std::uint64_t number) {
  const sim::RobotBody& body = world_.scene.robots.front();
  const sim::Moment moment{state(X_WR), X_WR * sim::mount_of(body)};
  const std::ptrdiff_t stride = std::ptrdiff_t{2} * body.camera.width_px;
  robot_is_elsewhere_ = false;
  photographer_->take({moment}, world_.sensor, {seed, number},
                      {yuyv_.data(), body.camera.width_px, body.camera.height_px, stride});
  return {yuyv_.data(), body.camera.width_px, body.camera.height_px, stride, PixelFormat::kYuyv};
}

std::vector<sim::ProbeShadow> ProbeRoom::truth(const sim::Pose& X_WR, int lamp) {
  const sim::SceneState now = state(X_WR);
  robot_is_elsewhere_ = false;
  photographer_->renderer().move_to(now);
  return sim::probe_shadows(photographer_->renderer(), now, X_WR * sim::mount_of(world_.scene.robots.front()), 0, lamp);
}

Result<void> ProbeRoom::write_copy(std::uint32_t seed, const std::filesystem::path& folder) const {
  const sim::CalibrationErrors errors = copy_errors();
  return sim::write_calibration(sim::calibrated_copy(world_.scene, 0, errors, seed), errors, seed, folder);
}

bool ProbeRoom::is_clear(const Vector3d& middle, double radius_m) const {
  constexpr int kAround = 24;
  constexpr std::array kHeights_m{0.05F, 0.2F, 0.4F, 0.6F, 0.8F, 1.0F, 1.2F};
  const sim::Tracer& tracer = photographer_->renderer().tracer();
  const auto at = [](const Vector3d& p, float z) {
    return Eigen::Vector3f(static_cast<float>(p.x()), static_cast<float>(p.y()), z);
  };
  const auto sees = [&tracer](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    return sim::sees(tracer, from, to, sim::kSightRays);
  };
  const auto is_floor = [&](const Vector3d& p) {
    return !sees(at(p, kLowest_m), at(p, -kLowest_m)) && sees(at(p, kHeights_m.back()), at(p, kLowest_m));
  };
  if (!is_floor(middle)) return false;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    const Vector3d rim = middle + radius_m * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    if (!is_floor(rim)) return false;
    if (std::ranges::any_of(kHeights_m, [&](float z) { return !sees(at(middle, z), at(rim, z)); })) return false;
  }
  return true;
}

bool ProbeRoom::is_free(const sim::Pose& X_WR) {
  if (!std::exchange(robot_is_elsewhere_, true))  // it is not in its own way
    photographer_->renderer().move_to(state(sim::pose_at(kElsewhere, 0.0)));
  const Vector3d board = X_WR * world_.scene.robots.front().board.p_RB;
  return is_clear(X_WR.translation(), kRobotRadius_m) && is_clear({board.x(), board.y(), 0.0}, kBoardRadius_m);
}

std::optional<sim::Pose> ProbeRoom::standpoint(double angle_rad, Random& random) {
  const sim::ProbeBoard& board = world_.scene.robots.front().board;
  const Vector3d lamp = moved_[0].value_or(p_WL());
  const double flat_m = (lamp.z() - board.p_RB.z()) * std::tan(angle_rad);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const double around = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
    sim::Pose X_WR = sim::pose_at(Vector3d::Zero(), heading);
    const Vector3d middle(lamp.x() + flat_m * std::cos(around), lamp.y() + flat_m * std::sin(around), 0.0);
    X_WR.translation() = middle - X_WR.linear() * Vector3d(board.p_RB.x(), board.p_RB.y(), 0.0);
    if (is_free(X_WR)) return X_WR;
  }
  return std::nullopt;
}

std::optional<sim::Pose> ProbeRoom::lit_standpoint(double least_rad, double most_rad, Random& random) {
  constexpr int kMostDraws = 400;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const auto X_WR = standpoint(random.uniform(least_rad, most_rad), random);
    if (X_WR && std::ranges::any_of(truth(*X_WR), &sim::ProbeShadow::visible)) return X_WR;
  }
  return std::nullopt;
}

RobotCopy RobotCopy::measured(const ProbeRoom& room, std::uint32_t seed, double factor) {
  const sim::CalibrationErrors errors = copy_errors();
  const auto copy = sim::calibrated_copy(room.world_.scene, 0, errors.times(factor), seed);
  RobotCopy robot;
  robot.X_RC = copy.X_RC;
  robot.camera = {copy.camera.width_px, copy.camera.height_px, copy.camera.fx_px, copy.camera.fy_px,
                  copy.camera.cx_px,    copy.camera.cy_px,     copy.camera.k1,    copy.camera.k2,
                  copy.camera.p1,       copy.camera.p2,        copy.camera.k3};
  // The board's turn, which the copy does not draw: the whole board about its middle; and each probe's foot by itself.
  Random random = Random(seed).fork(0xB0A);
  const double turn = factor * 0.2;
  robot.board.turn_deg = {turn * random.normal(), turn * random.normal(), turn * random.normal()};
  const Vector3d w(robot.board.turn_deg[0], robot.board.turn_deg[1], robot.board.turn_deg[2]);
  const Eigen::Matrix3d R = geometry::rotation_of(w * (std::numbers::pi / 180.0));
  robot.board.position_m = triple(copy.board.p_RB);
  robot.board.width_m = copy.board.width_m;
  robot.board.depth_m = copy.board.depth_m;
  robot.board.probes = static_cast<int>(copy.board.probes.size());
  for (std::size_t i = 0; i < copy.board.probes.size(); ++i) {
    const sim::MeasuredProbe& measured = copy.board.probes[i];
    illumination::ProbeParameters& probe = i == 0 ? robot.board.left : robot.board.right;
    const Vector3d off(errors.probe_m * factor * random.normal(), errors.probe_m * factor * random.normal(), 0.0);
    // A cone that leans by its own error takes its tip along.
    const double lean = turn * std::numbers::pi / 180.0 * (measured.p_RA - measured.p_RF).z();
    const Vector3d leaning(lean * random.normal(), lean * random.normal(), 0.0);
    probe.apex_m = triple(copy.board.p_RB + R * (measured.p_RA + leaning - copy.board.p_RB));
    probe.foot_m = triple(copy.board.p_RB + R * (measured.p_RF + off - copy.board.p_RB));
    probe.base_radius_m = measured.base_radius_m;
  }
  return robot;
}

}  // namespace cgsr::lab
