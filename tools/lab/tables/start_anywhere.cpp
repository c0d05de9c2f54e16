// The first pose of a robot that is put down anywhere in a drawn home and turns on the spot.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/generator/home.h"
#include "hal/sim/render/pixel_rays.h"
#include "pipeline/behavior/free_floor.h"
#include "pipeline/global_localization/global_localizer.h"
#include "pipeline/runtime/stage_budget.h"
#include "tools/lab/drawn_home.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

using global_localization::Candidate;
using global_localization::GlobalLocalizer;
using global_localization::Motion;
using global_localization::Phase;

constexpr double kDeg = 180.0 / std::numbers::pi;
constexpr double kFromWall_m = 0.4;
constexpr double kRobotRadius_m = 0.3;
constexpr int kDraws = 1000;
constexpr double kImage_s = 0.033;
constexpr double kTurn_rad_s = 40.0 / kDeg;
constexpr double kLongest_s = 40.0;
constexpr double kInTime_s = 20.0;
constexpr std::uint32_t kUnits = 13;  // an image, as the shipped robot of the round has
constexpr double kRight_m = 0.05;
constexpr double kRight_rad = 1.5 / kDeg;
// The base: its gyro and wheels.
constexpr double kTurnShare = 0.03;
constexpr double kTurnNoise_rad = 0.1 / kDeg;
constexpr double kLean_rad = 1.0 / kDeg;
constexpr double kLeanNoise_rad = 0.1 / kDeg;
constexpr double kWander_m = 0.002;  // an image, at random: 3 cm over the turn
constexpr double kAxle_m = 0.24;

/// What came of one home.
struct Start {
  Phase phase = Phase::kTurning;
  double s = 0.0;
  PoseError error;
  bool alike_is_right = false;  ///< the most alike panorama is that of the robot's place, within 45 cm and 10 degrees.
  std::uint32_t units = 0;      ///< of the image that was granted most.
  std::size_t places = 0;
  double floor_m2 = 0.0;

  [[nodiscard]] bool right() const {
    return phase == Phase::kFound && error.position_m <= kRight_m && error.direction_rad <= kRight_rad;
  }
};

constexpr std::uint64_t kHomes = 0x43;  // stream of random numbers

/// A base that turns on the spot, and what it tells of that.
class Turn {
 public:
  Turn(const geometry::Pose& X_WR, Random& random)
      : random_(&random),
        X_WR_(X_WR),
        share_(1.0 + kTurnShare * random.normal()),
        way_round_(random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0) {
    lean();
  }

  void step(double angle_rad) {
    const double turn_rad = way_round_ * angle_rad;
    // It does not pivot on a point, and nobody tells it.
    if (turn_rad != 0.0) X_WR_.translation() += kWander_m * Eigen::Vector3d(random_->normal(), random_->normal(), 0.0);
    X_WR_ = X_WR_ * geometry::pose_on_floor(0.0, 0.0, turn_rad);
    told_rad_ += share_ * turn_rad + (turn_rad != 0.0 ? kTurnNoise_rad * random_->normal() : 0.0);
    lean();
  }

  /// The robot with its lean, about its axle.
  [[nodiscard]] geometry::Pose X_WR() const { return X_WR_ * leaning(pitch_rad_); }
  [[nodiscard]] Motion motion() const {
    return {.X_OR = geometry::pose_on_floor(0.0, 0.0, told_rad_) * leaning(told_pitch_rad_),
            .pitch_rad = told_pitch_rad_,
            .axle_height_m = kAxle_m};
  }

 private:
  void lean() {
    pitch_rad_ = kLean_rad * random_->normal();
    told_pitch_rad_ = pitch_rad_ + kLeanNoise_rad * random_->normal();
  }

  static geometry::Pose leaning(double pitch_rad) {
    const Eigen::Vector3d axle(0.0, 0.0, kAxle_m);
    geometry::Pose tilt = geometry::Pose::Identity();
    tilt.linear() = Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    tilt.translation() = axle - tilt.linear() * axle;
    return tilt;
  }

  Random* random_;
  geometry::Pose X_WR_;
  double share_;
  double way_round_;  ///< -1: to the right.
  double told_rad_ = 0.0;
  double pitch_rad_ = 0.0;
  double told_pitch_rad_ = 0.0;
};

/// Is there nothing but floor under the robot's disc, by rays from the camera's height down?
bool is_floor(Place& place, const geometry::Pose& X_WR) {
  constexpr int kAround = 12;
  constexpr float kLowest_m = 0.02F;
  const sim::Tracer& tracer = place.renderer().tracer();
  const auto eye_m = static_cast<float>(place.X_RC().translation().z());
  for (int i = 0; i <= kAround; ++i) {
    const double radius_m = i < kAround ? kRobotRadius_m : 0.0;
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    const Eigen::Vector3d foot = X_WR * Eigen::Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0);
    const Eigen::Vector3f low(static_cast<float>(foot.x()), static_cast<float>(foot.y()), kLowest_m);
    if (!sim::sees(tracer, {low.x(), low.y(), eye_m}, low, sim::kSightRays)) return false;
  }
  return true;
}

/// \return somewhere on the floor with air around the robot, whatever it sees.
std::optional<geometry::Pose> draw_start(const sim::GeneratedHome& home, Place& place, const TrueEdges& edges,
                                         Random& random) {
  const sim::FloorRect floor = home.plan.outline.inset(kFromWall_m);
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto at = draw_standpoint(place, edges, {floor.x0, floor.x1, floor.y0, floor.y1}, {.min_edges = 0}, random);
    if (!at) return std::nullopt;
    const Eigen::Vector3d& p = at->X_WR.translation();
    const geometry::Pose X_WR = geometry::pose_on_floor(p.x(), p.y(), geometry::heading_of(at->X_WR));
    if (is_floor(place, X_WR)) return X_WR;
  }
  return std::nullopt;
}

bool is_there(const Candidate& candidate, const geometry::Pose& X_WR) {
  return (candidate.X_WR.translation() - X_WR.translation()).head<2>().norm() < 0.45 &&
         std::abs(std::remainder(geometry::heading_of(candidate.X_WR) - geometry::heading_of(X_WR),
                                 2.0 * std::numbers::pi)) < 10.0 / kDeg;
}

class Trials {
 public:
  Trials(const Setting& setting, const config::Localization& configuration)
      : setting_(&setting), configuration_(configuration) {}

  Result<Start> run(int number) const {
    const std::uint32_t seed = home_seed(setting_->seed, kHomes, number);
    const auto home = sim::generate_home(seed);
    if (!home) return tl::unexpected(home.error());
    auto place = Place::make(home->world, home->world.name);
    if (!place) return tl::unexpected(place.error());
    const TrueEdges edges((*place)->scene());
    const auto told = survey(**place, sim::CalibrationErrors::chapter_4(), seed);
    if (!told) return tl::unexpected(told.error());
    Random random = Random(setting_->seed).fork(static_cast<std::uint64_t>(number));
    const auto X_WR = draw_start(*home, **place, edges, random);
    if (!X_WR) return fail(fmt::format("home {}: nowhere has a robot floor under it and air around it", seed));
    const global_localization::GlobalLocalizerParameters parameters;
    const behavior::FreeFloor floor(told->map, {.min_clearance_m = parameters.clearance_m});
    auto places = global_localization::grid_of_places(told->map, parameters.spacing_m,
                                                      [&](double x, double y) { return floor.is_free(x, y); });
    if (places.empty()) return fail(fmt::format("home {}: its map has no free floor", seed));
    Start start;
    start.places = places.size();
    start.floor_m2 = floor.width_m() * floor.depth_m();
    localization::Localizer localizer(told->map, told->camera, configuration_.localizer);
    GlobalLocalizer searcher(told->map, told->camera, told->X_RC, std::move(places), localizer, configuration_.tracker,
                             parameters);
    turn_until_found(**place, seed, *X_WR, random, searcher, start);
    return start;
  }

 private:
  static void turn_until_found(Place& place, std::uint32_t seed, const geometry::Pose& X_WR, Random& random,
                               GlobalLocalizer& searcher, Start& start) {
    Turn turn(X_WR, random);
    Photograph photo;
    std::uint64_t photos = 0;
    for (int image = 0; image * kImage_s < kLongest_s; ++image) {
      const double angle_rad = searcher.wants_turn() ? kTurn_rad_s * kImage_s : 0.0;
      if (image > 0) turn.step(searcher.turns_back() ? -angle_rad : angle_rad);
      const geometry::Pose X_WC = turn.X_WR() * place.X_RC();
      const Motion motion = turn.motion();
      if (searcher.looks_at(motion)) photo = place.photograph(X_WC, seed, photos++);
      auto budget = runtime::StageBudget::of_units(kUnits);
      const Phase before = start.phase;
      start.phase = searcher.update(photo.view(), motion, budget);
      if (before == Phase::kComparing && start.phase == Phase::kTrying)
        start.alike_is_right = is_there(searcher.candidates().front(), X_WR);
      start.units = std::max(start.units, budget.granted());
      start.s = image * kImage_s;
      if (start.phase < Phase::kFound) continue;
      if (start.phase == Phase::kFound) start.error = error_of(searcher.found().X_WC, X_WC);
      return;
    }
  }

  const Setting* setting_;
  config::Localization configuration_;
};

Report report_of(const std::vector<Start>& starts, std::uint64_t seed) {
  Report report;
  report.seed = seed;
  const int count = static_cast<int>(starts.size());
  const auto share = [&](const char* quantity, const auto& is) {
    report.rows.push_back(share_row("ours", quantity, static_cast<int>(std::ranges::count_if(starts, is)), count));
  };
  share("right within 20 s", [](const Start& s) { return s.right() && s.s <= kInTime_s; });
  share("right within 40 s", [](const Start& s) { return s.right(); });
  share("wrong and claimed", [](const Start& s) { return s.phase == Phase::kFound && !s.right(); });
  share("ambiguous", [](const Start& s) { return s.phase == Phase::kAmbiguous; });
  share("not found", [](const Start& s) { return s.phase != Phase::kFound && s.phase != Phase::kAmbiguous; });
  std::vector<double> seconds, position_cm, direction_deg, places, floor_m2;
  std::uint32_t units = 0;
  for (const Start& s : starts) {
    places.push_back(static_cast<double>(s.places));
    floor_m2.push_back(s.floor_m2);
    units = std::max(units, s.units);
    if (s.phase != Phase::kFound) continue;
    seconds.push_back(s.s);
    position_cm.push_back(100.0 * s.error.position_m);
    direction_deg.push_back(kDeg * s.error.direction_rad);
  }
  report.rows.push_back(mean_row("ours", "time where claimed", "s", seconds, seed));
  report.rows.push_back(mean_row("ours", "position error where claimed", "cm", position_cm, seed));
  report.rows.push_back(mean_row("ours", "direction error where claimed", "deg", direction_deg, seed));
  report.rows.push_back(share_row("the most alike panorama alone", "within 45 cm and 10 deg",
                                  static_cast<int>(std::ranges::count_if(starts, &Start::alike_is_right)), count));
  report.rows.push_back(mean_row("homes", "rectangle of the map", "m2", floor_m2, seed));
  report.rows.push_back(mean_row("homes", "places compared", "", places, seed));
  report.notes.push_back(
      fmt::format("The image that was granted most units of work was granted {} of {}; closing and gathering the turn "
                  "ask for none.",
                  units, kUnits));
  return report;
}

}  // namespace

Result<Report> start_anywhere(const Setting& setting) {
  const auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  const Trials trials(setting, *floor);
  std::vector<Start> starts;
  starts.reserve(static_cast<std::size_t>(setting.trials));
  for (int i = 0; i < setting.trials; ++i) {
    const auto start = trials.run(i);
    if (!start) return tl::unexpected(start.error());
    starts.push_back(*start);
    setting.progress(fmt::format(
        "home {} of {}: {} after {:.1f} s{}", i + 1, setting.trials, to_string(start->phase), start->s,
        start->phase == Phase::kFound ? fmt::format(", {:.1f} cm and {:.2f} degrees off",
                                                    100.0 * start->error.position_m, kDeg * start->error.direction_rad)
                                      : std::string()));
  }
  Report report = report_of(starts, setting.seed);
  report.title = fmt::format("the first pose in {} drawn homes, from the map alone", setting.trials);
  report.notes.insert(
      report.notes.begin(),
      {fmt::format("A trial is a home of its own (`cgsr sim home`): the robot is put down anywhere that has 35 cm of "
                   "air, turns on the "
                   "spot at {:.0f} degrees a second, and stands when it has turned once. Images come every {:.0f} ms.",
                   kTurn_rad_s * kDeg, 1000.0 * kImage_s),
       fmt::format("Told is a calibrated copy per home, as in homes-4.1; what lies about is in no map. The base tells "
                   "turns that are off by "
                   "N(0, {:.0f} %), the same all the way round, to the left or to the right, and leans by {:.1f} "
                   "degrees at random; its place wanders "
                   "by {:.0f} mm from image to image, which nobody tells. Images are sharp.",
                   100.0 * kTurnShare, kLean_rad * kDeg, 1000.0 * kWander_m),
       "Right: within 5 cm and 1.5 degrees. 'Ambiguous' counts as not found, whether or not the home has a second "
       "place like it."});
  return report;
}

}  // namespace cgsr::lab
