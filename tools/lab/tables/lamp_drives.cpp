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
#include "tools/lab/probe_drive.h"
#include "tools/lab/probe_room.h"
#include "tools/lab/probes_trial.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLumens = 600.0;
constexpr double kUnknownHeight_m = 3.0;
constexpr int kMinAround = 3;  // standpoints of four that must show the lamp

struct Drives {
  std::vector<double> error_cm, sigma_cm;
  int within_bound = 0;
  std::vector<std::vector<double>> by_image = std::vector<std::vector<double>>(kDriveImages);
};

Result<void> run_drive(ProbeRoom& room, const config::Robot& robot, Random random,
                       std::array<Drives, kDriveErrors>& drives) {
  const auto start = room.standpoint(random.uniform(15.0, 50.0) * kRadPerDeg, random);
  if (!start) return {};
  const auto off_cm = [&room](const stages::LampReport& report) {
    return 100.0 * (report.lamp.p_WL - room.p_WL()).norm();
  };
  const auto known =
      locate_while_driving(room, robot, robot.lamp, *start, random,
                           [&](std::size_t image, const std::array<stages::LampReport, kDriveErrors>& now) {
                             for (std::size_t kind = 0; kind < kDriveErrors; ++kind) {
                               if (now[kind].known) drives[kind].by_image[image].push_back(off_cm(now[kind]));
                             }
                           });
  if (!known) return tl::unexpected(known.error());
  for (std::size_t kind = 0; kind < kDriveErrors; ++kind) {
    const stages::LampReport& report = (*known)[kind];
    if (!report.known) continue;
    const LampError off = lamp_error(report.lamp.p_WL - room.p_WL(), report.lamp.covariance);
    drives[kind].error_cm.push_back(off.error_cm);
    drives[kind].sigma_cm.push_back(off.sigma_cm);
    drives[kind].within_bound += off.within_bound ? 1 : 0;
  }
  return {};
}

Curve add_rows(const std::string& row, const Drives& drives, int count, std::uint64_t seed, Report& report) {
  const auto answered = static_cast<int>(drives.error_cm.size());
  report.rows.push_back(share_row(row, "answered", answered, count));
  report.rows.push_back(sampled_row(row, "median error", "cm", drives.error_cm, Join::kMedian, seed));
  report.rows.push_back(sampled_row(row, "95 % within", "cm", drives.error_cm, Join::kP95, seed));
  report.rows.push_back(mean_row(row, "stated sigma", "cm", drives.sigma_cm, seed));
  report.rows.push_back(share_row(row, "within its 99 % bound", drives.within_bound, std::max(1, answered)));
  Curve curve{row + ", median", {}};
  for (std::size_t image = 0; image < drives.by_image.size(); ++image) {
    if (drives.by_image[image].empty()) continue;
    curve.points.push_back({static_cast<double>(image + 1), quantile(drives.by_image[image], 0.5), {}});
  }
  return curve;
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
  EstimatedPose estimated(DriveErrors::kOfEachImage, random.fork(0));
  stages::LampReport report;
  int quarter = 0;
  for (int draw = 0; draw < 4000 && quarter < 4; ++draw) {
    const auto X_WR = standpoint_in(room, quarter, random);
    if (!X_WR) continue;
    const ImageView photo = room.shoot(*X_WR, seed, static_cast<std::uint64_t>(quarter));
    const stages::PlacedRobot placed = estimated.at(*X_WR);
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
  std::array<Drives, kDriveErrors> drives;
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
  report.title = fmt::format("the lamp in the world's frame, {} drives of {} images", count, kDriveImages);
  Plot plot{"Error on the way", "image", "cm", {}};
  for (std::size_t kind = 0; kind < kDriveErrors; ++kind) {
    const auto errors = static_cast<DriveErrors>(kind);
    const std::string row =
        errors == DriveErrors::kOfEachImage ? "drives" : fmt::format("drives, {}", to_string(errors));
    plot.curves.push_back(add_rows(row, drives[kind], count, setting.seed, report));
  }
  report.plots.push_back(std::move(plot));
  add_rows(around, count, setting.seed, report);
  report.notes.emplace_back(
      "The stage probes with the robot's pose in each image. Drives of 6 cm between images within 60 degrees of the "
      "lamp; the robot's pose errs by 1 cm and 0.3 degrees, which the filter is told: anew in every image, or for as "
      "long as the localizer's does (1/e of it is left after 1.5 m or 2 rad). The vision's copy is drawn anew for each "
      "drive as in table-5.1.");
  return report;
}

}  // namespace cgsr::lab
