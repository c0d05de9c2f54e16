#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/geometry/pose.h"
#include "pipeline/stages/probes_stage.h"
#include "tools/lab/configurations.h"
#include "tools/lab/experiment.h"
#include "tools/lab/probe_room.h"
#include "tools/lab/probes_trial.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr int kImages = 40;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLumens = 600.0;
constexpr double kWidest_deg = 60.0;
constexpr double kStep_m = 0.06;
constexpr double kPlaceSigma_m = 0.01;  // of the corrected pose, each image's own
constexpr double kTurnSigma_deg = 0.3;
constexpr double kUnknownHeight_m = 3.0;
constexpr int kMinAround = 3;  // standpoints of four that must show the lamp

geometry::Matrix6d pose_covariance() {
  geometry::Matrix6d P = geometry::Matrix6d::Zero();
  P(0, 0) = P(1, 1) = kPlaceSigma_m * kPlaceSigma_m;
  P(5, 5) = std::pow(kTurnSigma_deg * kRadPerDeg, 2);
  return P;
}

/// The robot's pose as localization would estimate it.
stages::PlacedRobot estimated(const sim::Pose& X_WR, Random& random) {
  geometry::Vector6d step = geometry::Vector6d::Zero();
  step[0] = kPlaceSigma_m * random.normal();
  step[1] = kPlaceSigma_m * random.normal();
  step[5] = kTurnSigma_deg * kRadPerDeg * random.normal();
  return {geometry::moved(X_WR, step), pose_covariance()};
}

double angle_at(const ProbeRoom& room, const sim::Pose& X_WR) {
  const Vector3d board = X_WR * Vector3d(0.44, 0.0, 0.9);
  const Vector3d to = room.p_WL() - board;
  return std::atan2(to.head<2>().norm(), to.z());
}

// One drive: on from step to step, turned away where it is blocked or the light gets too flat.
std::vector<sim::Pose> drive(const ProbeRoom& room, Random& random) {
  std::vector<sim::Pose> way;
  const auto start = room.standpoint(random.uniform(15.0, 50.0) * kRadPerDeg, random);
  if (!start) return way;
  way.reserve(kImages);
  sim::Pose X_WR = *start;
  for (int image = 0; image < kImages; ++image) {
    way.push_back(X_WR);
    for (int attempt = 0; attempt < 60; ++attempt) {
      const double turn = (attempt == 0 ? random.uniform(-0.12, 0.12) : random.uniform(-3.1, 3.1));
      sim::Pose next = X_WR;
      next.linear() = X_WR.linear() * geometry::rotation_of(Vector3d(0.0, 0.0, turn));
      next.translation() += next.linear() * Vector3d(kStep_m, 0.0, 0.0);
      if (!room.is_free(next) || angle_at(room, next) > kWidest_deg * kRadPerDeg) continue;
      X_WR = next;
      break;
    }
  }
  return way;
}

struct Drives {
  std::vector<double> error_cm;
  int within_bound = 0;
  std::vector<std::vector<double>> by_image = std::vector<std::vector<double>>(kImages);
};

Result<void> run_drive(ProbeRoom& room, const config::Robot& robot, Random random, Drives& drives) {
  auto stage = measured_probes(room, robot, static_cast<std::uint32_t>(random.next()), robot.lamp);
  if (!stage) return tl::unexpected(stage.error());
  const auto way = drive(room, random);
  const auto seed = static_cast<std::uint32_t>(random.next());
  stages::LampReport report;
  for (std::size_t image = 0; image < way.size(); ++image) {
    const ImageView photo = room.shoot(way[image], seed, image);
    const stages::PlacedRobot placed = estimated(way[image], random);
    report = stage->update(photo, &placed);
    if (report.known) drives.by_image[image].push_back(100.0 * (report.lamp.p_WL - room.p_WL()).norm());
  }
  if (!report.known) return {};
  const LampError off = lamp_error(report.lamp.p_WL - room.p_WL(), report.lamp.covariance);
  drives.error_cm.push_back(off.error_cm);
  drives.within_bound += off.within_bound ? 1 : 0;
  return {};
}

void add_rows(const Drives& drives, int count, std::uint64_t seed, Report& report) {
  const auto answered = static_cast<int>(drives.error_cm.size());
  report.rows.push_back(share_row("drives", "answered", answered, count));
  report.rows.push_back(sampled_row("drives", "median error", "cm", drives.error_cm, Join::kMedian, seed));
  report.rows.push_back(sampled_row("drives", "95 % within", "cm", drives.error_cm, Join::kP95, seed));
  report.rows.push_back(share_row("drives", "within its 99 % bound", drives.within_bound, std::max(1, answered)));
  Plot plot{"Error on the way", "image", "cm", {{"median", {}}}};
  for (std::size_t image = 0; image < drives.by_image.size(); ++image) {
    if (drives.by_image[image].empty()) continue;
    plot.curves[0].points.push_back({static_cast<double>(image + 1), quantile(drives.by_image[image], 0.5), {}});
  }
  report.plots.push_back(std::move(plot));
}

/// The lamp seen from four standpoints around it.
struct Around {
  std::vector<double> place_cm;
  std::vector<double> height_cm;
};

/// \return a standpoint in a quarter around the lamp that shows the shadows of all tips; nothing: this draw is none.
std::optional<sim::Pose> standpoint_in(ProbeRoom& room, int quarter, Random& random) {
  const auto X_WR = room.standpoint(random.uniform(25.0, 40.0) * kRadPerDeg, random);
  if (!X_WR) return std::nullopt;
  const Vector3d from = *X_WR * Vector3d(0.44, 0.0, 0.0) - room.p_WL();
  const double around = std::atan2(from.y(), from.x()) + std::numbers::pi;
  if (static_cast<int>(around / (std::numbers::pi / 2.0)) % 4 != quarter) return std::nullopt;
  const auto truth = room.truth(*X_WR);
  const bool all = std::ranges::all_of(truth, [](const sim::ProbeShadow& shadow) { return shadow.visible; });
  return all ? X_WR : std::nullopt;
}

/// The height not known: four standpoints around the lamp, the robot's place known as after a correction.
Result<void> look_around(ProbeRoom& room, const config::Robot& robot, Random random, Around& around) {
  illumination::LampParameters lamp = robot.lamp;
  lamp.height_sigma_m = kUnknownHeight_m;
  lamp.min_steady_images = std::min(lamp.min_steady_images, kMinAround);
  auto stage = measured_probes(room, robot, static_cast<std::uint32_t>(random.next()), lamp);
  if (!stage) return tl::unexpected(stage.error());
  const auto seed = static_cast<std::uint32_t>(random.next());
  stages::LampReport report;
  int quarter = 0;
  for (int draw = 0; draw < 4000 && quarter < 4; ++draw) {
    const auto X_WR = standpoint_in(room, quarter, random);
    if (!X_WR) continue;
    const ImageView photo = room.shoot(*X_WR, seed, static_cast<std::uint64_t>(quarter));
    const stages::PlacedRobot placed = estimated(*X_WR, random);
    report = stage->update(photo, &placed);
    ++quarter;
  }
  if (!report.known || report.lamp.seen < kMinAround) return {};
  const Vector3d off = report.lamp.p_WL - room.p_WL();
  around.place_cm.push_back(100.0 * off.norm());
  around.height_cm.push_back(100.0 * std::abs(off.z()));
  return {};
}

void add_rows(const Around& around, int count, std::uint64_t seed, Report& report) {
  const std::string row = "four standpoints, height not known";
  report.rows.push_back(share_row(row, "answered", static_cast<int>(around.place_cm.size()), count));
  if (around.place_cm.empty()) return;
  report.rows.push_back(mean_row(row, "mean error", "cm", around.place_cm, seed));
  report.rows.push_back(mean_row(row, "mean error of the height", "cm", around.height_cm, seed));
}

}  // namespace

Result<Report> lamp_drives(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  ProbeRoomLight light;
  light.lumens = kLumens;
  auto made = ProbeRoom::make(light);
  if (!made) return tl::unexpected(made.error());
  ProbeRoom& room = **made;
  const int count = setting.trials;
  Drives drives;
  Around around;
  for (int number = 0; number < count; ++number) {
    const Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(1000 + number));
    if (auto done = run_drive(room, *robot, random, drives); !done) return tl::unexpected(done.error());
    setting.progress(fmt::format("drive {} of {}", number + 1, count));
  }
  for (int number = 0; number < count; ++number) {
    const Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(5000 + number));
    if (auto done = look_around(room, *robot, random, around); !done) return tl::unexpected(done.error());
    setting.progress(fmt::format("four standpoints, {} of {}", number + 1, count));
  }
  Report report;
  report.title = fmt::format("the lamp in the world's frame, {} drives of {} images", count, kImages);
  add_rows(drives, count, setting.seed, report);
  add_rows(around, count, setting.seed, report);
  report.notes.emplace_back(
      "The stage probes with the robot's pose in each image. Drives of 6 cm between images within 60 degrees of the "
      "lamp; the robot's pose errs anew in every image by 1 cm and 0.3 degrees, which the filter is told; the vision's "
      "copy is drawn anew for each drive as in table-5.1.");
  return report;
}

}  // namespace cgsr::lab
