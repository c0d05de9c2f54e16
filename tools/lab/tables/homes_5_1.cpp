// Table 5.1 over homes that are drawn, with the lamps that they have: one switched on, by day or by night, of which the robot is told the height alone.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/generator/home.h"
#include "pipeline/stages/probes_stage.h"
#include "tools/lab/configurations.h"
#include "tools/lab/drawn_home.h"
#include "tools/lab/experiment.h"
#include "tools/lab/probe_drive.h"
#include "tools/lab/probe_room.h"
#include "tools/lab/probes_trial.h"

namespace cgsr::lab {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::uint64_t kHomes = 0x51;  // stream of random numbers
constexpr int kPerHome = 8;
constexpr double kHeightSigma_m = 0.02;
constexpr double kFound_cm = 4.0;  // off at most, at the end of locating

/// Where the robot has the lamp at the end of a drive, over the homes.
struct DriveEnds {
  std::vector<double> error_cm, sigma_cm;
  int found = 0;  ///< at most kFound_cm off.
  int within_bound = 0;

  void add(const Eigen::Vector3d& p_WL, const stages::LampReport& report) {
    if (!report.known) return;
    const LampError off = lamp_error(report.lamp.p_WL - p_WL, report.lamp.covariance);
    error_cm.push_back(off.error_cm);
    sigma_cm.push_back(off.sigma_cm);
    found += off.error_cm <= kFound_cm ? 1 : 0;
    within_bound += off.within_bound ? 1 : 0;
  }

  void add_rows(const std::string& row, int homes, std::uint64_t seed, Report& report) const {
    const auto known = static_cast<int>(error_cm.size());
    report.rows.push_back(share_row(row, "lamp known at its end", known, homes));
    report.rows.push_back(share_row(row, fmt::format("at most {:.0f} cm off at its end", kFound_cm), found, homes));
    if (known == 0) return;
    report.rows.push_back(mean_row(row, "error at its end", "cm", error_cm, seed));
    report.rows.push_back(mean_row(row, "stated sigma", "cm", sigma_cm, seed));
    report.rows.push_back(share_row(row, "within its 99 % bound", within_bound, known));
  }
};

class HomeTrials {
 public:
  HomeTrials(const Setting& setting, const config::Robot& robot) : setting_(&setting), robot_(robot) {}

  Result<void> run(int number) {
    const auto home = sim::generate_home(home_seed(setting_->seed, kHomes, number));
    if (!home) return tl::unexpected(home.error());
    Random random = Random(setting_->seed).fork(static_cast<std::uint64_t>(number));
    const auto chosen = static_cast<std::size_t>(random.below(static_cast<int>(home->lights.lamps.size())));
    auto room = ProbeRoom::make(*home, chosen);
    if (!room) return tl::unexpected(room.error());
    illumination::LampParameters lamp = robot_.lamp;
    lamp.height_m = (*room)->p_WL().z() + kHeightSigma_m * random.normal();
    lamp.height_sigma_m = kHeightSigma_m;
    LampAnswers answers;
    if (auto asked = ask(**room, lamp, random, answers); !asked) return asked;
    all_.add(answers);
    (home->lights.day ? by_day_ : by_night_).add(answers);
    for (const auto& [why, count] : answers.unanswered) unanswered_[why] += count;
    ++homes_;
    const auto start = (*room)->lit_standpoint(15.0 * kRadPerDeg, 50.0 * kRadPerDeg, random);
    if (!start) return {};
    const auto known = locate_while_driving(**room, robot_, lamp, *start, random, {});
    if (!known) return tl::unexpected(known.error());
    for (std::size_t kind = 0; kind < kDriveErrors; ++kind) drives_[kind].add((*room)->p_WL(), (*known)[kind]);
    return {};
  }

  void add_rows(Report& report) const {
    all_.add_rows("one image", setting_->seed, report);
    by_night_.add_rows("one image, no daylight", setting_->seed, report);
    by_day_.add_rows("one image, daylight", setting_->seed, report);
    for (std::size_t kind = kDriveErrors; kind-- > 0;) {
      drives_[kind].add_rows(fmt::format("drive, {}", to_string(static_cast<DriveErrors>(kind))), homes_,
                             setting_->seed, report);
    }
    for (const auto& [why, count] : unanswered_) {
      report.notes.push_back(fmt::format("{} images not answered: {}.", count, why));
    }
  }

 private:
  /// One image a standpoint.
  Result<void> ask(ProbeRoom& room, const illumination::LampParameters& lamp, Random& random, LampAnswers& answers) {
    for (int image = 0; image < kPerHome; ++image) {
      const auto X_WR = room.lit_standpoint(20.0 * kRadPerDeg, 60.0 * kRadPerDeg, random);
      if (!X_WR) continue;
      const auto seed = static_cast<std::uint32_t>(random.next());
      auto stage = measured_probes(room, robot_, seed, lamp);
      if (!stage) return tl::unexpected(stage.error());
      const ImageView view = room.shoot(*X_WR, seed, static_cast<std::uint64_t>(image));
      answers.judge(X_WR->inverse() * room.p_WL(), stage->update(view, nullptr));
    }
    return {};
  }

  const Setting* setting_;
  config::Robot robot_;
  int homes_ = 0;
  AnswersByLamp all_, by_day_, by_night_;
  std::array<DriveEnds, kDriveErrors> drives_;
  std::map<std::string, int> unanswered_;
};

}  // namespace

Result<Report> homes_5_1(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  HomeTrials trials(setting, *robot);
  for (int i = 0; i < setting.trials; ++i) {
    if (auto done = trials.run(i); !done) return tl::unexpected(done.error());
    setting.progress(fmt::format("home {} of {}", i + 1, setting.trials));
  }
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("where a lamp is in {} drawn homes", setting.trials);
  trials.add_rows(report);
  report.notes.emplace_back(
      "A trial is a home of its own (`cgsr sim home`): furniture, windows, ambient light and lamps of 2 to 15 cm as "
      "they "
      "are drawn, one lamp on, the others off. The robot is told the lamp's height with 2 cm and nothing else of it. "
      "Figures of one image are means over homes of each home's mean, intervals are over homes.");
  report.notes.push_back(fmt::format(
      "One image: {} standpoints a home, light from 20 to 60 degrees, among those from where at least one tip's shadow "
      "can be seen; the vision's copy of the robot is drawn anew in each image as in table-5.1.",
      kPerHome));
  report.notes.push_back(fmt::format(
      "Drive: {} images, 6 cm apart, below the lamp, begun where a shadow can be seen; what is known at the end is the "
      "filter's, in the world. The "
      "robot's "
      "pose errs by 1 cm and 0.3 degrees, which the filter is told, for as long as the localizer's does (1/e of it "
      "is left after 1.5 m or 2 rad); in the counterpart anew in every image. A lamp that is not known is not found.",
      kDriveImages));
  return report;
}

}  // namespace cgsr::lab
