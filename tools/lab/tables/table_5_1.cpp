#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/stages/probes_stage.h"
#include "tools/lab/configurations.h"
#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/image.h"
#include "tools/lab/probe_room.h"
#include "tools/lab/probes_trial.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

using illumination::LampStatus;

constexpr int kCountedImages = 30;
constexpr std::array kAngles_deg{20, 30, 40, 50, 60};
constexpr std::array kTheirBoth_cm{11.2, 13.4, 18.1, 21.9, 29.0};
constexpr std::array kTheirOne_cm{20.5, 21.8, 25.9, 28.1, 33.7};
constexpr double kLumens = 600.0;
constexpr int kMostDraws = 20000;

struct Trials {
  std::vector<double> error_cm;
  std::vector<double> triangulated_cm;
  std::vector<double> sigma_cm;
  int within_bound = 0;  // normalised squared error below its 99 % bound
  int asked = 0;
  std::map<std::string, int> unanswered;  // by its cause
};

void judge(const sim::Pose& X_WR, const Eigen::Vector3d& p_WL, const stages::LampReport& report, Trials& trials) {
  ++trials.asked;
  if (report.single_image.count == 0 || report.single_image.status != LampStatus::kFound) {
    ++trials.unanswered[std::string(reason_of(report))];
    return;
  }
  const auto& lamp = report.single_image.lamp[0];
  const Eigen::Vector3d p_RL = X_WR.inverse() * p_WL;
  const LampError off = lamp_error(lamp.p_RL - p_RL, lamp.covariance);
  trials.error_cm.push_back(off.error_cm);
  trials.sigma_cm.push_back(off.sigma_cm);
  trials.within_bound += off.within_bound ? 1 : 0;
  if (lamp.triangulated) trials.triangulated_cm.push_back(100.0 * (lamp.p_RL_triangulated - p_RL).norm());
}

Result<Trials> run(ProbeRoom& room, const config::Robot& robot, int row, int tips, int wanted, const Setting& setting) {
  Trials trials;
  const int angle_deg = kAngles_deg[static_cast<std::size_t>(row)];
  Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(100 * row + tips));
  for (int draw = 0; draw < kMostDraws && trials.asked < wanted; ++draw) {
    const auto X_WR = room.standpoint(angle_deg * std::numbers::pi / 180.0, random);
    if (!X_WR) return fail(fmt::format("there is no free standpoint at {} degrees", angle_deg));
    const auto truth = room.truth(*X_WR);
    const auto visible = std::ranges::count_if(truth, [](const sim::ProbeShadow& shadow) { return shadow.visible; });
    if (visible != tips) continue;
    const auto seed = static_cast<std::uint32_t>(random.next());
    auto stage = measured_probes(room, robot, seed, robot.lamp);
    if (!stage) return tl::unexpected(stage.error());
    const ImageView image = room.shoot(*X_WR, seed, static_cast<std::uint64_t>(draw));
    judge(*X_WR, room.p_WL(), stage->update(image, nullptr), trials);
    setting.progress(
        fmt::format("{} degrees, {} of the tips' shadows: {} of {}", angle_deg, tips, trials.asked, wanted));
  }
  return trials;
}

/// A folder with what the robot knows, and images of random standpoints of both kinds.
Result<void> write_film(ProbeRoom& room, const Setting& setting, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "img");
  Random random = Random(setting.seed).fork(0x51C);
  const auto seed = static_cast<std::uint32_t>(random.next());
  if (auto written = room.write_copy(seed, folder); !written) return written;
  for (int i = 0; i < kCountedImages;) {
    const int angle_deg = kAngles_deg[static_cast<std::size_t>(i) % kAngles_deg.size()];
    const auto X_WR = room.standpoint(angle_deg * std::numbers::pi / 180.0, random);
    if (!X_WR) return fail(fmt::format("there is no free standpoint at {} degrees", angle_deg));
    if (std::ranges::none_of(room.truth(*X_WR), &sim::ProbeShadow::visible)) continue;
    const ImageView photo = room.shoot(*X_WR, seed, static_cast<std::uint64_t>(i));
    const Image image =
        image_of_yuyv({photo.data, photo.data + photo.stride_bytes * photo.height_px}, photo.width_px, photo.height_px);
    cv::imwrite((folder / "img" / fmt::format("{:04}.png", i++)).string(), image.bgr);
  }
  return {};
}

/// What `cgsr light` costs an image of such a film.
Result<Counted> count_observation(ProbeRoom& room, const Setting& setting) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}-probes", getpid());
  if (auto written = write_film(room, setting, folder); !written) return tl::unexpected(written.error());
  auto counted = count_program("cgsr", {"light", "--config", source_path("config/illumination/lamp-robot.toml"),
                                        "--camera", (folder / "camera.yaml").string(), "--mount",
                                        (folder / "robot.toml").string(), "--input", (folder / "img").string()});
  std::filesystem::remove_all(folder);
  return counted;
}

/// The rows of one angle, and its point of the plot.
void add_rows(int tips, std::size_t angle, const Trials& trials, Report& report, Plot& plot) {
  const std::string name = fmt::format("{}, {} deg", tips == 2 ? "both" : "one", kAngles_deg[angle]);
  const int answered = static_cast<int>(trials.error_cm.size());
  Row mean = mean_row(name, "mean error", "cm", trials.error_cm, report.seed);
  mean.dissertation = tips == 2 ? kTheirBoth_cm[angle] : kTheirOne_cm[angle];
  plot.curves[tips == 2 ? 0 : 1].points.push_back(
      {static_cast<double>(kAngles_deg[angle]), mean.ours.value_or(0.0), mean.interval});
  report.rows.push_back(std::move(mean));
  report.rows.push_back(share_row(name, "answered", answered, trials.asked));
  report.rows.push_back(share_row(name, "within its 99 % bound", trials.within_bound, answered));
  report.rows.push_back(mean_row(name, "stated sigma", "cm", trials.sigma_cm, report.seed));
  if (tips == 2 && !trials.triangulated_cm.empty()) {
    report.rows.push_back(mean_row(name, "error, height triangulated", "cm", trials.triangulated_cm, report.seed));
  }
  for (const auto& [why, count] : trials.unanswered) {
    report.notes.push_back(fmt::format("{}: {} of {} not answered: {}.", name, count, trials.asked, why));
  }
}

Result<void> add_cost(ProbeRoom& room, const Setting& setting, Report& report) {
  setting.progress("counting instructions");
  const auto counted = count_observation(room, setting);
  if (!counted) return tl::unexpected(counted.error());
  for (const auto& [stage, cost] : counted->stages) {
    report.rows.push_back(plain_row("cost, " + stage, "mean", "Minstr", cost.mean_minstr, kCountedImages));
    report.rows.push_back(
        plain_row("cost, " + stage, "worst", "Minstr", cost.worst_minstr, kCountedImages, Join::kMax));
  }
  return {};
}

}  // namespace

Result<Report> table_5_1(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  ProbeRoomLight light;
  light.lumens = kLumens;
  auto room = ProbeRoom::make(light);
  if (!room) return tl::unexpected(room.error());
  const int wanted = setting.trials;
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("where the lamp is, out of one image, {} trials a row", wanted);
  Plot plot{"Error against the light's angle", "deg", "cm", {{"both shadows", {}}, {"one shadow", {}}}};
  for (int tips = 2; tips >= 1; --tips) {
    for (int row = 0; row < static_cast<int>(kAngles_deg.size()); ++row) {
      auto trials = run(**room, *robot, row, tips, wanted, setting);
      if (!trials) return tl::unexpected(trials.error());
      add_rows(tips, static_cast<std::size_t>(row), *trials, report, plot);
    }
  }
  report.plots.push_back(std::move(plot));
  if (setting.count) {
    if (auto done = add_cost(**room, setting, report); !done) return tl::unexpected(done.error());
  }
  report.notes.emplace_back(
      "The stage probes, without a pose. Errors in the robot's frame, all three coordinates; one image each; a "
      "ball-shaped lamp of 5 cm radius and 600 "
      "lm in "
      "the simulated living room. The angle is the light's from the vertical at the middle of the board.");
  report.notes.emplace_back(
      "The vision's copy of the robot is drawn anew in each trial: tips, feet and board off by N(0, 0.5 mm) and 0.2 "
      "degrees, intrinsics by 0.2 %, the mount by 3 mm and 0.3 degrees.");
  report.notes.emplace_back(
      "Standpoints and headings are random among those where the simulator's truth says that both (one: exactly one) "
      "of "
      "the tips' shadows can be seen.");
  return report;
}

}  // namespace cgsr::lab
