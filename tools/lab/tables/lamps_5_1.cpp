// Table 5.1 over lamps that are drawn: place, radius of 2 to 15 cm, strength and ambient light, of which the robot is told the height alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/stages/probes_stage.h"
#include "tools/lab/configurations.h"
#include "tools/lab/experiment.h"
#include "tools/lab/probe_room.h"
#include "tools/lab/probes_trial.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr int kPerLamp = 8;
constexpr double kHeightSigma_m = 0.02;
constexpr std::array kRadii_m{0.02, 0.05, 0.10, 0.15};  // bins of the rows

constexpr double kKnown_m = 1e-4;  // a radius so sure is not estimated

enum Contender : std::size_t { kNotTold, kTold, kFixed, kContenders };
constexpr std::array<std::string_view, kContenders> kNames{"radius not told", "radius told", "5 cm taken for it"};

/// A lamp that is drawn.
struct DrawnLamp {
  ProbeRoomLight light;
  double lamp_height_m = 0.0;  // as it is told
};

/// Lamps as the generator of homes draws them: 2 to 15 cm, from half to one and a half of the world's ambient light.
DrawnLamp draw_lamp(Random& random) {
  DrawnLamp drawn;
  drawn.light.radius_m = random.uniform(kRadii_m.front(), kRadii_m.back());
  drawn.light.lumens = random.uniform(400.0, 1200.0);
  drawn.light.ambient = random.uniform(0.5, 1.5);
  drawn.light.p_WL = Vector3d(random.uniform(4.0, 7.0), random.uniform(2.0, 4.5), random.uniform(2.1, 2.75));
  drawn.lamp_height_m = drawn.light.p_WL->z() + kHeightSigma_m * random.normal();
  return drawn;
}

class LampTrials {
 public:
  LampTrials(const Setting& setting, const config::Robot& robot) : setting_(&setting), robot_(robot) {}

  Result<void> run(int number) {
    Random random = Random(setting_->seed).fork(static_cast<std::uint64_t>(number));
    const DrawnLamp drawn = draw_lamp(random);
    auto room = ProbeRoom::make(drawn.light);
    if (!room) return tl::unexpected(room.error());
    illumination::LampParameters lamp = robot_.lamp;
    lamp.height_m = drawn.lamp_height_m;
    lamp.height_sigma_m = kHeightSigma_m;
    std::array<LampAnswers, kContenders> found;
    for (int image = 0; image < kPerLamp; ++image) {
      const auto X_WR = (*room)->lit_standpoint(20.0 * kRadPerDeg, 60.0 * kRadPerDeg, random);
      if (!X_WR) continue;
      const auto seed = static_cast<std::uint32_t>(random.next());
      const ImageView view = (*room)->shoot(*X_WR, seed, static_cast<std::uint64_t>(image));
      for (std::size_t c = 0; c < kContenders; ++c) {
        config::Robot robot = robot_;
        if (c == kTold) robot.probes.shadow.lamp_radius_m = drawn.light.radius_m;
        if (c != kNotTold) robot.probes.shadow.lamp_radius_sigma_m = kKnown_m;
        auto stage = measured_probes(**room, robot, seed, lamp);
        if (!stage) return tl::unexpected(stage.error());
        found[c].judge(X_WR->inverse() * (*room)->p_WL(), stage->update(view, nullptr));
      }
    }
    for (std::size_t c = 0; c < kContenders; ++c) {
      all_[c].add(found[c]);
      for (const auto& [why, count] : found[c].unanswered) unanswered_[c][why] += count;
      of_radius_[c][bin_of(drawn.light.radius_m)].add(found[c]);
    }
    return {};
  }

  void add_rows(Report& report) const {
    for (std::size_t c = 0; c < kContenders; ++c) {
      all_[c].add_rows(std::string(kNames[c]), setting_->seed, report);
      for (std::size_t bin = 0; bin < of_radius_[c].size(); ++bin) {
        of_radius_[c][bin].add_rows(
            fmt::format("{}, {:.0f} to {:.0f} cm", kNames[c], 100.0 * kRadii_m[bin], 100.0 * kRadii_m[bin + 1]),
            setting_->seed, report);
      }
      for (const auto& [why, count] : unanswered_[c]) {
        report.notes.push_back(fmt::format("{}: {} images not answered: {}.", kNames[c], count, why));
      }
    }
  }

 private:
  static std::size_t bin_of(double radius_m) {
    const auto above = std::upper_bound(kRadii_m.begin() + 1, kRadii_m.end() - 1, radius_m);
    return static_cast<std::size_t>(above - kRadii_m.begin()) - 1;
  }

  const Setting* setting_;
  config::Robot robot_;
  std::array<AnswersByLamp, kContenders> all_;
  std::array<std::array<AnswersByLamp, kRadii_m.size() - 1>, kContenders> of_radius_;
  std::array<std::map<std::string, int>, kContenders> unanswered_;
};

}  // namespace

Result<Report> lamps_5_1(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  LampTrials trials(setting, *robot);
  for (int i = 0; i < setting.trials; ++i) {
    if (auto done = trials.run(i); !done) return tl::unexpected(done.error());
    setting.progress(fmt::format("lamp {} of {}", i + 1, setting.trials));
  }
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("where {} drawn lamps are, {} standpoints each", setting.trials, kPerLamp);
  trials.add_rows(report);
  report.notes.emplace_back(
      "A trial is a lamp in the simulated living room: radius 2 to 15 cm, 400 to 1,200 lm, half to one and a half of "
      "the "
      "world's ambient light, 2.1 to 2.75 m high. Figures are means over lamps of each lamp's mean, intervals are over "
      "lamps. The robot is told the height with 2 cm and nothing else of the lamp.");
  report.notes.emplace_back(
      "The stage probes, one image a standpoint, light from 20 to 60 degrees, among those from where at least one "
      "tip's "
      "shadow can be seen; the vision's copy is drawn anew in each image as in table-5.1.");
  report.notes.emplace_back(
      "In the same images. Radius told: the true one, not estimated; 5 cm taken for it: likewise the one that ships, "
      "whatever the lamp's is.");
  return report;
}

}  // namespace cgsr::lab
