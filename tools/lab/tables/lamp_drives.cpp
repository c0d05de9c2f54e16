#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp_filter.h"
#include "tools/lab/configurations.h"
#include "tools/lab/experiment.h"
#include "tools/lab/probe_room.h"

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

geometry::Matrix6d pose_covariance() {
  geometry::Matrix6d P = geometry::Matrix6d::Zero();
  P(0, 0) = P(1, 1) = kPlaceSigma_m * kPlaceSigma_m;
  P(5, 5) = std::pow(kTurnSigma_deg * kRadPerDeg, 2);
  return P;
}

geometry::Pose estimated(const sim::Pose& X_WR, Random& random) {
  geometry::Vector6d step = geometry::Vector6d::Zero();
  step[0] = kPlaceSigma_m * random.normal();
  step[1] = kPlaceSigma_m * random.normal();
  step[5] = kTurnSigma_deg * kRadPerDeg * random.normal();
  return geometry::moved(X_WR, step);
}

double angle_at(const ProbeRoom& room, const sim::Pose& X_WR) {
  const Vector3d board = X_WR * Vector3d(0.44, 0.0, 0.9);
  const Vector3d to = room.p_WL() - board;
  return std::atan2(to.head<2>().norm(), to.z());
}

struct Vision {
  illumination::Board board;
  illumination::LampParameters lamp;
  illumination::ProbesParameters probes;
};

Result<Vision> vision_of(const ProbeRoom& room, const config::Robot& robot, std::uint32_t seed) {
  const RobotCopy copy = RobotCopy::measured(room, seed, robot.probes.board);
  const auto board = illumination::make_board(copy.board, copy.X_RC, copy.camera);
  if (!board) return tl::unexpected(board.error());
  Vision vision{*board, robot.lamp, robot.probes};
  vision.probes.board = copy.board;
  return vision;
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

}  // namespace

Result<Report> lamp_drives(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  ProbeRoomLight light;
  light.lumens = kLumens;
  auto made = ProbeRoom::make(light);
  if (!made) return tl::unexpected(made.error());
  ProbeRoom& room = **made;
  const int drives = setting.trials;
  Report report;
  report.title = fmt::format("the lamp in the world's frame, {} drives of {} images", drives, kImages);

  std::vector<double> error_cm;
  int within_bound = 0;
  std::vector<std::vector<double>> by_image(kImages);
  for (int number = 0; number < drives; ++number) {
    Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(1000 + number));
    auto vision = vision_of(room, *robot, static_cast<std::uint32_t>(random.next()));
    if (!vision) return tl::unexpected(vision.error());
    illumination::ProbeObserver observer(vision->board, vision->probes,
                                         vision->lamp.height_m - vision->board.X_RB.translation().z());
    illumination::LampFilter filter(vision->board, vision->lamp);
    const auto way = drive(room, random);
    const auto seed = static_cast<std::uint32_t>(random.next());
    for (std::size_t image = 0; image < way.size(); ++image) {
      const auto observation = observer.observe(room.shoot(way[image], seed, image));
      filter.update(observation, estimated(way[image], random), pose_covariance());
      if (filter.count() > 0 && filter.lamp(0).steady)
        by_image[image].push_back(100.0 * (filter.lamp(0).p_WL - room.p_WL()).norm());
    }
    setting.progress(fmt::format("drive {} of {}", number + 1, drives));
    if (filter.count() == 0 || !filter.lamp(0).steady) continue;
    const Vector3d off = filter.lamp(0).p_WL - room.p_WL();
    error_cm.push_back(100.0 * off.norm());
    if (off.dot(filter.lamp(0).covariance.inverse() * off) < 11.345) ++within_bound;
  }
  const auto answered = static_cast<int>(error_cm.size());
  report.rows.push_back(share_row("drives", "answered", answered, drives));
  report.rows.push_back(sampled_row("drives", "median error", "cm", error_cm, Join::kMedian, setting.seed));
  report.rows.push_back(sampled_row("drives", "95 % within", "cm", error_cm, Join::kP95, setting.seed));
  report.rows.push_back(share_row("drives", "within its 99 % bound", within_bound, std::max(1, answered)));
  Plot plot{"Error on the way", "image", "cm", {{"median", {}}}};
  for (std::size_t image = 0; image < by_image.size(); ++image) {
    if (by_image[image].empty()) continue;
    plot.curves[0].points.push_back({static_cast<double>(image + 1), quantile(by_image[image], 0.5), {}});
  }
  report.plots.push_back(std::move(plot));

  // The height not known: four standpoints around the lamp, the robot's place known as after a correction.
  std::vector<double> place_cm;
  std::vector<double> height_cm;
  for (int number = 0; number < drives; ++number) {
    Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(5000 + number));
    auto vision = vision_of(room, *robot, static_cast<std::uint32_t>(random.next()));
    if (!vision) return tl::unexpected(vision.error());
    illumination::LampParameters lamp = vision->lamp;
    lamp.height_sigma_m = kUnknownHeight_m;
    illumination::ProbeObserver observer(vision->board, vision->probes,
                                         lamp.height_m - vision->board.X_RB.translation().z());
    illumination::LampFilter filter(vision->board, lamp);
    const auto seed = static_cast<std::uint32_t>(random.next());
    int quarter = 0;
    for (int draw = 0; draw < 4000 && quarter < 4; ++draw) {
      const auto X_WR = room.standpoint(random.uniform(25.0, 40.0) * kRadPerDeg, random);
      if (!X_WR) continue;
      const Vector3d from = *X_WR * Vector3d(0.44, 0.0, 0.0) - room.p_WL();
      const double around = std::atan2(from.y(), from.x()) + std::numbers::pi;
      if (static_cast<int>(around / (std::numbers::pi / 2.0)) % 4 != quarter) continue;
      const auto truth = room.truth(*X_WR);
      if (!std::ranges::all_of(truth, [](const sim::ProbeShadow& shadow) { return shadow.visible; })) continue;
      const auto observation = observer.observe(room.shoot(*X_WR, seed, static_cast<std::uint64_t>(quarter)));
      filter.update(observation, estimated(*X_WR, random), pose_covariance());
      ++quarter;
    }
    setting.progress(fmt::format("four standpoints, {} of {}", number + 1, drives));
    if (filter.count() == 0 || filter.lamp(0).seen < 3) continue;
    const Vector3d off = filter.lamp(0).p_WL - room.p_WL();
    place_cm.push_back(100.0 * off.norm());
    height_cm.push_back(100.0 * std::abs(off.z()));
  }
  report.rows.push_back(
      share_row("four standpoints, height not known", "answered", static_cast<int>(place_cm.size()), drives));
  if (!place_cm.empty()) {
    report.rows.push_back(mean_row("four standpoints, height not known", "mean error", "cm", place_cm, setting.seed));
    report.rows.push_back(
        mean_row("four standpoints, height not known", "mean error of the height", "cm", height_cm, setting.seed));
  }
  report.notes.emplace_back(
      "Drives of 6 cm between images within 60 degrees of the lamp; the robot's pose errs anew in every image by 1 cm "
      "and 0.3 degrees, which the filter is told; the vision's copy is drawn anew for each drive as in table-5.1.");
  return report;
}

}  // namespace cgsr::lab
