#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
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
using illumination::LampStatus;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLumens = 600.0;
constexpr double kHeightSigma_m = 0.02;
constexpr int kMostDraws = 400;    // for one trial
constexpr int kLeastOfCurve = 10;  // trials at each value

struct Case {
  const char* name;
  bool lamp_to_find = true;
  bool second_lamp = false;
  bool behind = false;
  bool flicker = false;
  bool moves = false;
  bool hand = false;
};

constexpr std::array kCases{
    Case{"one lamp", true},
    Case{"no lamp", false},
    Case{"two lamps", true, true},
    Case{"lamp behind", true, false, true},
    Case{"flicker", true, false, false, true},
    Case{"a lamp that moves", true, false, false, false, true},
    Case{"a hand's shadow", true, false, false, false, false, true},
};

struct Outcome {
  int asked = 0;
  int answered = 0;
  int images = 0;  // with an answer
  int within_bound = 0;
  double squares = 0.0;
  std::vector<double> error_cm;
  std::vector<double> sigma_cm;
  std::map<std::string, int> unanswered;
};

// A straight shadow across the lower part of an image, as a hand's or an arm's: what is on one side is darker.
void darken(std::vector<std::uint8_t>& yuyv, int width_px, int height_px, Random& random) {
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double offset = random.uniform(-200.0, 200.0);
  const double factor = random.uniform(0.75, 0.9);
  for (int y = 240; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double d = c * (x - 320) + s * (y - 380) - offset;
      const double share = std::clamp(0.5 + d / 8.0, 0.0, 1.0);
      auto& luma = yuyv[std::size_t{2} * static_cast<std::size_t>(y * width_px + x)];
      luma = static_cast<std::uint8_t>(std::lround(16.0 + (luma - 16.0) * (1.0 - share * (1.0 - factor))));
    }
  }
}

struct Standing {
  sim::Pose X_WR;
  bool found = false;
};

Standing stand(ProbeRoom& room, const Case& which, double angle_deg, Random& random) {
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const auto X_WR = room.standpoint(angle_deg * kRadPerDeg, random);
    if (!X_WR) return {};
    if (which.behind && (X_WR->inverse() * room.p_WL()).x() > -0.1) continue;
    const auto truth = room.truth(*X_WR);
    if (std::ranges::any_of(truth, [](const sim::ProbeShadow& shadow) { return shadow.visible; })) return {*X_WR, true};
  }
  return {};
}

/// \param p_RL  where the lamps truly are, robot frame: an answer is judged by the nearest.
void add(const stages::LampReport& report, const std::vector<Vector3d>& p_RL, Outcome& outcome) {
  ++outcome.asked;
  bool answered = false;
  for (int i = 0; i < report.single_image.count; ++i) {
    const auto& estimate = report.single_image.lamp[static_cast<std::size_t>(i)];
    if (estimate.status != LampStatus::kFound) continue;
    answered = true;
    const auto nearer = [&](const Vector3d& a, const Vector3d& b) {
      return (estimate.p_RL - a).norm() < (estimate.p_RL - b).norm();
    };
    const LampError off = lamp_error(estimate.p_RL - *std::ranges::min_element(p_RL, nearer), estimate.covariance);
    ++outcome.images;
    outcome.error_cm.push_back(off.error_cm);
    outcome.squares += off.error_cm * off.error_cm;
    outcome.sigma_cm.push_back(off.sigma_cm);
    outcome.within_bound += off.within_bound ? 1 : 0;
  }
  if (answered) {
    ++outcome.answered;
  } else {
    ++outcome.unanswered[std::string(reason_of(report))];
  }
}

Result<void> judge(ProbeRoom& room, const config::Robot& robot, const Case& which, double angle_deg, Random& random,
                   Outcome& outcome) {
  Vector3d p_WL = room.p_WL();
  if (which.moves) {
    p_WL = room.p_WL() + Vector3d(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), 0.0);
    room.move_lamp(0, p_WL);
  }
  const Standing standing = stand(room, which, angle_deg, random);
  if (!standing.found) return {};
  room.scale_light(which.flicker ? random.uniform(0.4, 1.6) : 1.0);
  room.switch_lamp(0, which.lamp_to_find);
  const auto seed = static_cast<std::uint32_t>(random.next());
  illumination::LampParameters lamp = robot.lamp;
  lamp.height_sigma_m = kHeightSigma_m;
  lamp.height_m += kHeightSigma_m * random.normal();
  auto stage = measured_probes(room, robot, seed, lamp);
  if (!stage) return tl::unexpected(stage.error());
  ImageView image = room.shoot(standing.X_WR, seed, 0);
  std::vector<std::uint8_t> darkened;
  if (which.hand) {
    darkened.assign(image.data, image.data + image.stride_bytes * image.height_px);
    darken(darkened, image.width_px, image.height_px, random);
    image.data = darkened.data();
  }
  const stages::LampReport report = stage->update(image, nullptr);
  room.switch_lamp(0, true);
  std::vector<Vector3d> p_RL{standing.X_WR.inverse() * p_WL};
  if (which.second_lamp) p_RL.emplace_back(standing.X_WR.inverse() * room.p_WL(1));
  add(report, p_RL, outcome);
  return {};
}

void report_case(const Case& which, const Outcome& outcome, Report& report) {
  const char* const answered = which.lamp_to_find ? "answered" : "answered, wrongly";
  report.rows.push_back(share_row(which.name, answered, outcome.answered, outcome.asked));
  for (const auto& [why, count] : outcome.unanswered) {
    if (!which.lamp_to_find) break;
    report.notes.push_back(fmt::format("{}: {} of {} not answered: {}.", which.name, count, outcome.asked, why));
  }
  if (!which.lamp_to_find || outcome.images == 0) return;
  const double rms = std::sqrt(outcome.squares / outcome.images);
  const double sigma = quantile(outcome.sigma_cm, 0.5);
  report.rows.push_back(share_row(which.name, "within its 99 % bound", outcome.within_bound, outcome.images));
  report.rows.push_back(sampled_row(which.name, "median error", "cm", outcome.error_cm, Join::kMedian, report.seed));
  report.rows.push_back(plain_row(which.name, "RMS error", "cm", rms, outcome.error_cm.size()));
  report.rows.push_back(
      sampled_row(which.name, "median stated sigma", "cm", outcome.sigma_cm, Join::kMedian, report.seed));
  report.rows.push_back(plain_row(which.name, "sigma over RMS", "", sigma / rms, outcome.sigma_cm.size()));
}

/// A figure over lamps too weak and too strong, or angles that the table leaves out.
struct Sweep {
  const char* title;
  const char* unit;
  std::vector<double> values;
  std::function<double(double)> angle_of;   ///< [deg]
  std::function<double(double)> factor_of;  ///< of the light
};

std::array<Sweep, 2> sweeps() {
  return {Sweep{"A lamp's strength, light at 35 degrees",
                "lm",
                {10, 30, 100, 300, 1000, 3000, 10000},
                [](double) { return 35.0; },
                [](double lumens) { return lumens / kLumens; }},
          Sweep{"The light's angle",
                "deg",
                {8, 14, 20, 40, 60, 65, 70},
                [](double angle) { return angle; },
                [](double) { return 1.0; }}};
}

/// The rooms, the robot and what draws the trials: each of them has a stream of its own.
struct Bench {
  const Setting& setting;
  config::Robot robot;
  std::unique_ptr<ProbeRoom> room;
  std::unique_ptr<ProbeRoom> room_of_two;
  std::uint64_t streams = 0;

  Random next_random() { return Random(setting.seed).fork(++streams); }
};

Result<Bench> make_bench(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  ProbeRoomLight light;
  light.lumens = kLumens;
  auto room = ProbeRoom::make(light);
  if (!room) return tl::unexpected(room.error());
  light.second_p_WL = Vector3d(4.2, 2.2, 2.75);
  auto room_of_two = ProbeRoom::make(light);
  if (!room_of_two) return tl::unexpected(room_of_two.error());
  return Bench{setting, *robot, std::move(*room), std::move(*room_of_two)};
}

Result<void> run_case(Bench& bench, const Case& which, int wanted, Report& report) {
  Random random = bench.next_random();
  Outcome outcome;
  for (int trial = 0; trial < wanted; ++trial) {
    ProbeRoom& room = which.second_lamp ? *bench.room_of_two : *bench.room;
    const double angle_deg = random.uniform(which.behind ? 15.0 : 20.0, which.behind ? 50.0 : 60.0);
    if (auto judged = judge(room, bench.robot, which, angle_deg, random, outcome); !judged) return judged;
    bench.setting.progress(fmt::format("{}: {} of {}", which.name, trial + 1, wanted));
  }
  if (which.moves) bench.room->move_lamp(0, bench.room->p_WL());
  report_case(which, outcome, report);
  return {};
}

Result<void> run_sweep(Bench& bench, const Sweep& sweep, int wanted, Report& report) {
  Plot plot{sweep.title, sweep.unit, "", {{"answered", {}}, {"median error, dm", {}}}};
  const int each = std::max(kLeastOfCurve, wanted / static_cast<int>(sweep.values.size()));
  for (const double value : sweep.values) {
    Random random = bench.next_random();
    Outcome outcome;
    for (int trial = 0; trial < each; ++trial) {
      // judge() sets the light itself: a flicker of exactly this factor.
      bench.room->set_base_light(sweep.factor_of(value));
      const auto judged = judge(*bench.room, bench.robot, kCases[0], sweep.angle_of(value), random, outcome);
      if (!judged) return judged;
      bench.setting.progress(fmt::format("{} {} {}: {} of {}", sweep.title, value, sweep.unit, trial + 1, each));
    }
    bench.room->set_base_light(1.0);
    if (outcome.asked == 0) continue;
    plot.curves[0].points.push_back({value, static_cast<double>(outcome.answered) / outcome.asked, {}});
    const std::string name = fmt::format("{} {}", value, sweep.unit);
    report.rows.push_back(share_row(name, "answered", outcome.answered, outcome.asked));
    if (outcome.error_cm.empty()) continue;
    plot.curves[1].points.push_back({value, 0.1 * quantile(outcome.error_cm, 0.5), {}});
    report.rows.push_back(sampled_row(name, "median error", "cm", outcome.error_cm, Join::kMedian, report.seed));
  }
  report.plots.push_back(std::move(plot));
  return {};
}

}  // namespace

Result<Report> lamp_cases(const Setting& setting) {
  auto bench = make_bench(setting);
  if (!bench) return tl::unexpected(bench.error());
  const int wanted = std::max(1, setting.trials / static_cast<int>(kCases.size() + 2));
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("lamps that are off, two, behind, flickering or moving, {} trials each", wanted);
  for (const Case& which : kCases) {
    if (auto done = run_case(*bench, which, wanted, report); !done) return tl::unexpected(done.error());
  }
  for (const Sweep& sweep : sweeps()) {
    if (auto done = run_sweep(*bench, sweep, wanted, report); !done) return tl::unexpected(done.error());
  }
  report.notes.emplace_back(
      "The stage probes, without a pose. One image a trial, light from 20 to 60 degrees, standpoints among those from "
      "where at least one tip's shadow can be seen; the vision's copy is drawn anew in each trial as in table-5.1, the "
      "lamp's height with 2 cm.");
  report.notes.emplace_back("Two lamps: each answer against the nearer of both.");
  return report;
}

}  // namespace cgsr::lab
