// 5.4.3 over drawn homes: in each a ball above a table, under it in shadow, on the floor in the light, gone and back, then a brown one; tracked with the
// mask of what may lie in shade and without it. The robot stands still and knows its map, pose and lamp as well as it states.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/generator/home.h"
#include "pipeline/stages/shade_stage.h"
#include "tools/lab/ball_film.h"
#include "tools/lab/ball_follower.h"
#include "tools/lab/ball_picture.h"
#include "tools/lab/ball_scoring.h"
#include "tools/lab/configurations.h"
#include "tools/lab/drawn_home.h"
#include "tools/lab/experiment.h"
#include "tools/lab/shade_trial.h"
#include "tools/lab/table_in_home.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kHomes = 0x543;  // stream of random numbers
constexpr int kMostHomes = 40;           // looked at for one with a table
constexpr StatedErrors kStated;
constexpr double kInShadow = 0.25;  // of the ball's visible pixels see the lamp
constexpr double kLit = 0.75;
constexpr double kOnFloor_m = 0.05;
constexpr double kGone_s = 3.0;
constexpr double kBrown_s = 8.0;
constexpr double kTheirsWith = 0.742;
constexpr double kTheirsWithout = 0.437;

enum Contender : std::size_t { kWithMask, kMaskAlone, kWithout, kBrightOnly, kContenders };
constexpr std::array<std::string_view, kContenders> kNames{"with the mask", "with the mask alone", "without a mask",
                                                           "bright colours only"};

enum Part : std::size_t { kAbove, kShaded, kFloorLit, kElsewhere, kOfBrown, kParts };
constexpr std::array<std::string_view, kParts> kPartNames{"off the floor", "on the floor, in shadow",
                                                          "on the floor, lit", "on the floor, half lit", "brown ball"};

Part part_of(const BallFilm::Shot& shot) {
  if (shot.scene == BallScene::kBrown) return kOfBrown;
  if (shot.orange_height_m > kOnFloor_m) return kAbove;
  if (shot.lit < kInShadow) return kShaded;
  return shot.lit > kLit ? kFloorLit : kElsewhere;
}

const Vector3d& any_of(const std::vector<Vector3d>& places, Random& random) {
  return places[static_cast<std::size_t>(random.below(static_cast<int>(places.size())))];
}

/// The balls' ways at a table, and how long the film is.
std::pair<BallFilm::Script, double> play_at(const TableInHome& table, Random& random) {
  using enum BallScene;
  BallFilm::Script script;
  std::vector<BallStop> way;
  const auto go = [&way](const Vector3d& to, double speed_mps, double wait_s, BallScene then) {
    way.push_back({{to.x(), to.y(), to.z()}, speed_mps, wait_s, then});
  };
  const auto over_table = [&](double wait_s, BallScene then) {
    const Vector3d raised(0.0, 0.0, random.uniform(0.0, 0.2));
    go(any_of(table.above, random) + raised, 0.4, wait_s, then);
  };
  go(table.above.front(), 0.4, 1.0, kAboveTable);
  for (const double wait_s : {0.0, 0.5, 0.0}) over_table(wait_s, kAboveTable);
  const Vector3d beside = any_of(table.lit, random);
  go({beside.x(), beside.y(), way.back().at_m[2]}, 0.5, 0.0, kOnTheWay);
  go(beside, 0.5, 0.0, kOnTheWay);
  for (const double wait_s : {0.0, 1.5, 0.5, 1.0}) go(any_of(table.in_shade, random), 0.3, wait_s, kInShadow);
  for (const double wait_s : {0.5, 0.5, 1.0}) go(any_of(table.lit, random), 0.3, wait_s, kUnderLit);
  const std::size_t leaves = way.size();
  over_table(kGone_s, kOnTheWay);  // unseen
  for (const double wait_s : {0.5, 0.5, 0.5}) over_table(wait_s, kReturned);
  over_table(0.0, kBrown);
  script.orange = ball_walk(way, 0.5, random, script.scenes);
  const double leaves_s = script.scenes[leaves - 1].first + way[leaves - 1].wait_s;
  const double ends_s = script.scenes.back().first;
  script.orange_is_there = {
      {0.0, true, 0}, {leaves_s, false, 0}, {script.scenes[leaves].first + kGone_s, true, 0}, {ends_s, false, 0}};
  way.clear();
  for (const double wait_s : {0.5, 0.5, 0.5, kBrown_s}) over_table(wait_s, kBrown);
  BallScenes of_brown;
  script.brown = ball_walk(way, ends_s, random, of_brown);
  script.brown_is_there = {{0.0, false, 0}, {ends_s, true, 0}};
  return {std::move(script), ends_s + kBrown_s};
}

/// What several trackers do in one home.
struct Take {
  std::uint32_t home = 0;
  std::array<std::array<BallScore, kParts>, kContenders> scores;
  std::vector<Picture> pictures;

  [[nodiscard]] BallScore all(Contender contender) const {
    BallScore sum;
    for (const BallScore& part : scores[contender]) sum.add(part);
    return sum;
  }
};

/// The masks of a robot whose map, camera, pose and lamp are off as it states.
Result<stages::ShadowMasks> masks_for(const BallFilm& film, const config::Robot& robot, Random& random) {
  const auto normal3 = [&random](double sigma) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vector3d(sigma * Vector3d(x, y, z));
  };
  geometry::Vector6d off;
  off << normal3(kStated.place_sigma_m), normal3(kStated.turn_sigma_rad);
  stages::ShadeStage stage(std::make_shared<const world::Map>(film.map()), film.camera(), robot.shade);
  return masks_of(stage, row_of<stages::ShadeStage>(robot), geometry::moved(film.X_WC(), off), kStated.pose(),
                  kStated.lamp(film.p_WL() + normal3(kStated.lamp_sigma_m)));
}

class HomeTake {
 public:
  HomeTake(const Setting& setting, const config::Robot& robot) : setting_(&setting), robot_(robot) {}

  /// \return nothing: the ball is not in the first image, from which it is learned.
  Result<std::optional<Take>> run(const sim::GeneratedHome& home, const TableInHome& table, Random& random) {
    auto [script, lasts_s] = play_at(table, random);
    const auto seed = static_cast<std::uint32_t>(random.next());
    auto film = BallFilm::make(world_at(home, table), home.world.name, std::move(script), seed);
    if (!film) return tl::unexpected(film.error());
    const auto masks = masks_for(**film, robot_, random);
    if (!masks) return tl::unexpected(masks.error());
    BallFilm::Shot shot = (*film)->shoot(0);
    if (!shot.orange) return std::nullopt;
    stages::ShadowMasks alone = *masks;
    alone.volumes = {};
    const std::array<stages::ShadowMasks, kContenders> given{*masks, alone, stages::ShadowMasks{},
                                                             all_lit(*masks->masks)};
    std::vector<BallTracker> trackers;
    for (std::size_t i = 0; i < kContenders; ++i) {
      auto tracker =
          learned_ball(shot.image, *shot.orange, setting_->configuration, robot_.integrated,
                       row_of<stages::TrackStage>(robot_), 0.5 * ((*film)->camera().fx_px + (*film)->camera().fy_px));
      if (!tracker) return tl::unexpected(tracker.error());
      trackers.push_back(std::move(*tracker));
    }
    Take take;
    take.home = home.seed;
    std::array<int, kParts> of_part{};
    const int images = static_cast<int>(lasts_s * BallFilm::kRate_hz);
    for (int number = 0; number < images; ++number) {
      if (number > 0) shot = (*film)->shoot(number);
      const Part part = part_of(shot);
      std::array<std::optional<Box>, kContenders> said;
      for (std::size_t i = 0; i < kContenders; ++i) {
        const color::BallSighting ball = trackers[i].track(shot.image.view(), given[i]);
        if (ball.found) said[i] = ball.box;
        take.scores[i][part].add(shot.orange, shot.brown, said[i]);
      }
      if (++of_part[part] == 10) {
        take.pictures.push_back(picture_of(shot, *masks->masks, said[kWithMask], said[kWithout],
                                           fmt::format("home {}, {}", home.seed, kPartNames[part])));
      }
    }
    return take;
  }

 private:
  const Setting* setting_;
  config::Robot robot_;
};

/// One figure of every home that has it.
class Figures {
 public:
  explicit Figures(const std::vector<Take>& takes) : takes_(&takes) {}

  template <class Figure>
  void add_row(const std::string& row, const char* quantity, const Figure& figure, std::uint64_t seed,
               Report& report) const {
    std::vector<double> of_homes;
    for (const Take& take : *takes_) {
      if (const std::optional<double> value = figure(take)) of_homes.push_back(*value);
    }
    if (!of_homes.empty()) report.rows.push_back(mean_row(row, quantity, "", of_homes, seed));
  }

 private:
  const std::vector<Take>* takes_;
};

void add_contender(Contender i, const std::vector<Take>& takes, std::uint64_t seed, Report& report) {
  const std::string name(kNames[i]);
  const Figures figures(takes);
  const auto add = [&](const std::string& row, const char* quantity, double BallScore::*sum, const auto& score) {
    figures.add_row(
        row, quantity,
        [&](const Take& take) -> std::optional<double> {
          const BallScore of = score(take);
          return of.images > 0 ? std::optional(of.mean(of.*sum)) : std::nullopt;
        },
        seed, report);
  };
  const auto all = [i](const Take& take) { return take.all(i); };
  add(name, "overlap", &BallScore::overlap, all);
  report.rows.back().dissertation = i == kWithMask  ? std::optional(kTheirsWith)
                                    : i == kWithout ? std::optional(kTheirsWithout)
                                                    : std::nullopt;
  add(name, "IoU", &BallScore::iou, all);
  figures.add_row(
      name, "false", [&](const Take& take) { return std::optional(all(take).false_share()); }, seed, report);
  for (std::size_t part = 0; part < kOfBrown; ++part) {
    const std::string row = fmt::format("{}: {}", name, kPartNames[part]);
    const auto of_part = [i, part](const Take& take) { return take.scores[i][part]; };
    add(row, "overlap", &BallScore::overlap, of_part);
    figures.add_row(
        row, "found",
        [&](const Take& take) -> std::optional<double> {
          const BallScore of = of_part(take);
          return of.images > 0 ? std::optional(of.mean(of.found - of.elsewhere)) : std::nullopt;
        },
        seed, report);
  }
  figures.add_row(
      fmt::format("{}: {}", name, kPartNames[kOfBrown]), "taken for the orange one",
      [&](const Take& take) {
        const BallScore& of = take.scores[i][kOfBrown];
        return std::optional(static_cast<double>(of.brown_tracked) / std::max(1, of.brown));
      },
      seed, report);
}

/// What the mask brings, home by home: never less is asked.
void add_gain(const std::vector<Take>& takes, std::uint64_t seed, Report& report) {
  const Figures figures(takes);
  const std::string row = "with the mask minus without";
  const auto add = [&](const char* quantity, const auto& figure) {
    figures.add_row(
        row, quantity,
        [&](const Take& take) -> std::optional<double> {
          const std::optional<double> with = figure(take, kWithMask), without = figure(take, kWithout);
          return with && without ? std::optional(*with - *without) : std::nullopt;
        },
        seed, report);
  };
  const auto overlap_of = [](std::size_t part) {
    return [part](const Take& take, Contender i) -> std::optional<double> {
      const BallScore& of = take.scores[i][part];
      return of.images > 0 ? std::optional(of.mean(of.overlap)) : std::nullopt;
    };
  };
  add("overlap, off the floor", overlap_of(kAbove));
  add("overlap, in shadow", overlap_of(kShaded));
  add("overlap, lit", overlap_of(kFloorLit));
  add("false", [](const Take& take, Contender i) { return std::optional(take.all(i).false_share()); });
}

}  // namespace

Result<Report> homes_5_4_3(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  HomeTake in_home(setting, *robot);
  std::vector<Take> takes;
  Report report;
  int without_table = 0;
  for (int number = 0; static_cast<int>(takes.size()) < setting.trials; ++number) {
    if (number >= kMostHomes * setting.trials)
      return fail("of the drawn homes too few have a table with its shadow in view");
    const auto home = sim::generate_home(home_seed(setting.seed, kHomes, number));
    if (!home) return tl::unexpected(home.error());
    Random random = Random(setting.seed).fork(static_cast<std::uint64_t>(number));
    const auto table = find_table(*home, random);
    if (!table) return tl::unexpected(table.error());
    if (!*table) {
      ++without_table;
      continue;
    }
    setting.progress(fmt::format("home {} of {}: {}", takes.size() + 1, setting.trials, home->seed));
    auto take = in_home.run(*home, **table, random);
    if (!take) return tl::unexpected(take.error());
    if (!*take) {
      ++without_table;
      continue;
    }
    std::ranges::move((*take)->pictures, std::back_inserter(report.pictures));
    takes.push_back(std::move(**take));
  }
  report.title = fmt::format("a ball in light and shade in {} drawn homes", setting.trials);
  for (const Contender i : {kWithMask, kMaskAlone, kWithout, kBrightOnly})
    add_contender(i, takes, setting.seed, report);
  add_gain(takes, setting.seed, report);
  report.notes = {
      "A home of its own for each film (`cgsr sim home`), by day or night, with one of its lamps on: one that throws "
      "the "
      "shadow of something to stand under. A still robot 1.8 to 5 m away; five images a second. Map and camera are "
      "the home's measured copy; pose and lamp are off by what the robot states (section-5.4.2).",
      "Means over homes of each home's share of images; intervals by home. Overlap is |found and true| / |true|, "
      "nothing found counting as 0. Found: something that touches the ball. False: images in which something that does "
      "not touch the ball was taken for it, of all.",
      "With the mask: dark histograms count where the ball's ray may be shaded and, at the distance that its size "
      "says, its place. With the mask alone: "
      "where its ray may be. Without a mask they are searched everywhere; bright colours only: nowhere.",
      fmt::format("Drawn homes without such a table, lamp and view: {}.", without_table)};
  return report;
}

}  // namespace cgsr::lab
