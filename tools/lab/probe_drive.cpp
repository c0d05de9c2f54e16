#include "tools/lab/probe_drive.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "tools/lab/probes_trial.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr double kStep_m = 0.06;
constexpr double kPlaceSigma_m = 0.01;
constexpr double kTurnSigma_rad = 0.3 * std::numbers::pi / 180.0;
// After which an error that lasts is down to 1/e: read off the localizer's on one round through the simulated home.
constexpr double kLasts_m = 1.5;
constexpr double kLasts_rad = 2.0;

double angle_at(const ProbeRoom& room, const sim::Pose& X_WR) {
  const Vector3d board = X_WR * Vector3d(0.44, 0.0, 0.9);
  const Vector3d to = room.p_WL() - board;
  return std::atan2(to.head<2>().norm(), to.z());
}

}  // namespace

std::vector<sim::Pose> drive_below_lamp(ProbeRoom& room, const sim::Pose& start, Random& random) {
  constexpr double kMaxAngle_deg = 60.0;
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  std::vector<sim::Pose> way;
  way.reserve(kDriveImages);
  sim::Pose X_WR = start;
  for (int image = 0; image < kDriveImages; ++image) {
    way.push_back(X_WR);
    for (int attempt = 0; attempt < 60; ++attempt) {
      const double turn = (attempt == 0 ? random.uniform(-0.12, 0.12) : random.uniform(-3.1, 3.1));
      sim::Pose next = X_WR;
      next.linear() = X_WR.linear() * geometry::rotation_of(Vector3d(0.0, 0.0, turn));
      next.translation() += next.linear() * Vector3d(kStep_m, 0.0, 0.0);
      if (!room.is_free(next) || angle_at(room, next) > kMaxAngle_deg * kRadPerDeg) continue;
      X_WR = next;
      break;
    }
  }
  return way;
}

stages::PlacedRobot EstimatedPose::at(const sim::Pose& X_WR) {
  double keeps = 0.0;
  if (X_WR_before_ && errors_ == DriveErrors::kThatLast) {
    const geometry::Vector6d moved = geometry::step_between(*X_WR_before_, X_WR);
    keeps = std::exp(-moved.head<3>().norm() / kLasts_m - moved.tail<3>().norm() / kLasts_rad);
  }
  const double fresh = std::sqrt(1.0 - keeps * keeps);
  off_[0] = keeps * off_[0] + fresh * kPlaceSigma_m * random_.normal();
  off_[1] = keeps * off_[1] + fresh * kPlaceSigma_m * random_.normal();
  off_[5] = keeps * off_[5] + fresh * kTurnSigma_rad * random_.normal();
  X_WR_before_ = X_WR;
  geometry::Matrix6d P = geometry::Matrix6d::Zero();
  P(0, 0) = P(1, 1) = kPlaceSigma_m * kPlaceSigma_m;
  P(5, 5) = kTurnSigma_rad * kTurnSigma_rad;
  return {geometry::moved(X_WR, off_), P};
}

Result<std::array<stages::LampReport, kDriveErrors>> locate_while_driving(
    ProbeRoom& room, const config::Robot& robot, const illumination::LampParameters& lamp, const sim::Pose& start,
    Random random,
    const std::function<void(std::size_t image, const std::array<stages::LampReport, kDriveErrors>& known)>&
        after_image) {
  const auto copy = static_cast<std::uint32_t>(random.next());
  const auto seed = static_cast<std::uint32_t>(random.next());
  std::vector<stages::ProbesStage> stage;
  std::array estimated{EstimatedPose(DriveErrors::kOfEachImage, random.fork(0)),
                       EstimatedPose(DriveErrors::kThatLast, random.fork(1))};
  stage.reserve(kDriveErrors);
  for (std::size_t kind = 0; kind < kDriveErrors; ++kind) {
    auto made = measured_probes(room, robot, copy, lamp);
    if (!made) return tl::unexpected(made.error());
    stage.push_back(std::move(*made));
  }
  const auto way = drive_below_lamp(room, start, random);
  std::array<stages::LampReport, kDriveErrors> report;
  for (std::size_t image = 0; image < way.size(); ++image) {
    const ImageView photo = room.shoot(way[image], seed, image);
    for (std::size_t kind = 0; kind < kDriveErrors; ++kind) {
      const stages::PlacedRobot placed = estimated[kind].at(way[image]);
      report[kind] = stage[kind].update(photo, &placed);
    }
    if (after_image) after_image(image, report);
  }
  return report;
}

}  // namespace cgsr::lab
