#include "tools/lab/table_in_home.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "hal/sim/render/pixel_rays.h"
#include "tools/lab/localization/place.h"
#include "tools/lab/probe_room.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_m = 0.10;  // the ball's
constexpr double kStep_m = 0.1;     // of the grid on the floor
constexpr double kFromWall_m = 0.2;
constexpr double kAir_m = 0.3;    // under a table
constexpr double kCover_m = 1.1;  // its underside is lower
constexpr double kHighTop_m = 1.2;
constexpr std::size_t kLeastCells = 20;
constexpr double kBeside_m = 0.6;
constexpr std::size_t kLeastAbove = 3, kLeastShaded = 3, kLeastLit = 2;
constexpr double kNearest_m = 1.8, kFarthest_m = 5.0;
constexpr int kStandpoints = 300;
constexpr double kMargin_px = 30.0;
constexpr double kLeastFacing =
    0.3;  // cosine between the ways to camera and lamp: where the ball is learned, most of what is seen of it is lit

double distance_along_floor(const Vector3d& a, const Vector3d& b) {
  return (a - b).head<2>().norm();
}

/// A home with nobody in it, for questions.
class QuestionedHome {
 public:
  explicit QuestionedHome(std::unique_ptr<Place> place) : place_(std::move(place)) {}

  [[nodiscard]] bool sees(const Vector3d& from, const Vector3d& to, unsigned kind) const {
    return sim::sees(place_->renderer().tracer(), from.cast<float>(), to.cast<float>(), kind);
  }
  [[nodiscard]] Vector3d lamp(std::size_t i) const { return place_->scene().lamps[i].p_WL; }
  [[nodiscard]] sim::Pose X_RC() const { return place_->X_RC(); }

  /// Puts the robot somewhere: it is in its own way, with its board. Nothing: it is nowhere.
  void put_robot(const std::optional<sim::Pose>& X_WR) {
    std::vector<sim::Pose> robots;
    if (X_WR) robots.push_back(*X_WR);
    place_->renderer().move_to(sim::state_at(place_->scene(), 0.0, {}, robots));
  }

  /// Is there air all around a ball that lies there?
  [[nodiscard]] bool is_free(const Vector3d& lowest) const {
    const Vector3d middle = lowest + Vector3d(0.0, 0.0, kRadius_m + 0.01);
    return std::ranges::all_of(
        kEnds, [&](const Vector3d& end) { return sees(middle, middle + kRadius_m * end, sim::kSightRays); });
  }

  enum class Light { kAll, kSome, kNone };
  /// How much of a ball's rim sees the lamp. \param kind  which surfaces are in its way.
  [[nodiscard]] Light light_on(const Vector3d& lowest, const Vector3d& p_WL, unsigned kind) const {
    const Vector3d middle = lowest + Vector3d(0.0, 0.0, kRadius_m);
    const auto lit = std::ranges::count_if(
        kEnds, [&](const Vector3d& end) { return sees(middle + 0.9 * kRadius_m * end, p_WL, kind); });
    if (lit == 0) return Light::kNone;
    return lit == static_cast<std::ptrdiff_t>(kEnds.size()) ? Light::kAll : Light::kSome;
  }

  [[nodiscard]] bool in_image(const sim::Pose& X_WC, const Vector3d& lowest) const {
    const Vector3d middle = lowest + Vector3d(0.0, 0.0, kRadius_m);
    const geometry::Camera camera = camera_of(place_->camera());
    const auto pixel = camera.pixel_of(X_WC.inverse() * middle);
    return pixel && pixel->x() > kMargin_px && pixel->y() > kMargin_px && pixel->x() < camera.width_px - kMargin_px &&
           pixel->y() < camera.height_px - kMargin_px && sees(X_WC.translation(), middle, sim::kSightRays);
  }

  /// The height of the first thing below `from`.
  [[nodiscard]] double height_below(const Vector3d& from) const {
    double low = 0.0, high = from.z();
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (low + high);
      (sees(from, {from.x(), from.y(), middle}, sim::kSightRays) ? high : low) = middle;
    }
    return high;
  }

 private:
  static const std::array<Vector3d, 6> kEnds;
  std::unique_ptr<Place> place_;
};

const std::array<Vector3d, 6> QuestionedHome::kEnds{Vector3d::UnitX(),  -Vector3d::UnitX(), Vector3d::UnitY(),
                                                    -Vector3d::UnitY(), Vector3d::UnitZ(),  -Vector3d::UnitZ()};

/// Floor that something covers, in one piece.
struct Cover {
  std::vector<Vector3d> cells;
  Vector3d middle = Vector3d::Zero();
};

/// The pieces of covered floor in a room, the largest first.
std::vector<Cover> covers_in(const QuestionedHome& home, const sim::FloorRect& room) {
  std::vector<Vector3d> covered;
  for (double x = room.x0; x <= room.x1; x += kStep_m) {
    for (double y = room.y0; y <= room.y1; y += kStep_m) {
      const Vector3d air(x, y, kAir_m);
      if (home.sees({x, y, 0.02}, air, sim::kSightRays) && !home.sees(air, {x, y, kCover_m}, sim::kMapRays))
        covered.emplace_back(x, y, 0.0);
    }
  }
  std::vector<Cover> all;
  while (!covered.empty()) {
    Cover cover{{covered.back()}};
    covered.pop_back();
    for (std::size_t i = 0; i < cover.cells.size(); ++i) {
      const Vector3d from = cover.cells[i];
      const auto far = std::ranges::partition(
          covered, [&](const Vector3d& cell) { return distance_along_floor(cell, from) > 1.5 * kStep_m; });
      cover.cells.insert(cover.cells.end(), far.begin(), far.end());
      covered.erase(far.begin(), far.end());
    }
    for (const Vector3d& cell : cover.cells) cover.middle += cell / static_cast<double>(cover.cells.size());
    if (cover.cells.size() >= kLeastCells) all.push_back(std::move(cover));
  }
  std::ranges::sort(all, std::ranges::greater{}, [](const Cover& cover) { return cover.cells.size(); });
  return all;
}

/// Where a ball can be at a cover under a lamp, whoever looks.
TableInHome places_at(const QuestionedHome& home, const Cover& cover, const sim::FloorRect& room, std::size_t lamp) {
  using Light = QuestionedHome::Light;
  const Vector3d p_WL = home.lamp(lamp);
  TableInHome table;
  table.lamp = lamp;
  for (const Vector3d& cell : cover.cells) {
    const double top_m = home.height_below({cell.x(), cell.y(), 1.6});
    const Vector3d above(cell.x(), cell.y(), top_m + 0.05);
    if (top_m < kHighTop_m && home.is_free(above) && home.light_on(above, p_WL, sim::kShadowRays) == Light::kAll)
      table.above.push_back(above);
    if (home.is_free(cell) && home.light_on(cell, p_WL, sim::kMapRays) == Light::kNone) table.in_shade.push_back(cell);
  }
  for (double x = room.x0; x <= room.x1; x += kStep_m) {
    for (double y = room.y0; y <= room.y1; y += kStep_m) {
      const Vector3d cell(x, y, 0.0);
      const bool near = std::ranges::any_of(
          cover.cells, [&](const Vector3d& other) { return distance_along_floor(cell, other) < kBeside_m; });
      if (near && home.is_free(cell) && home.light_on(cell, p_WL, sim::kShadowRays) == Light::kAll)
        table.lit.push_back(cell);
    }
  }
  return table;
}

/// Leaves of the places those that a robot sees, the best one to learn the ball at first. \return whether there are enough.
bool keep_visible(QuestionedHome& home, const sim::Pose& X_WR, TableInHome& table) {
  const sim::Pose X_WC = X_WR * home.X_RC();
  home.put_robot(X_WR);
  for (auto* places : {&table.above, &table.in_shade, &table.lit})
    std::erase_if(*places, [&](const Vector3d& place) { return !home.in_image(X_WC, place); });
  home.put_robot(std::nullopt);
  table.X_WR = X_WR;
  const auto facing = [&](const Vector3d& ball) {
    return (X_WC.translation() - ball).normalized().dot((home.lamp(table.lamp) - ball).normalized());
  };
  const auto best = std::ranges::max_element(table.above, {}, facing);
  if (best == table.above.end() || facing(*best) < kLeastFacing) return false;
  std::iter_swap(best, table.above.begin());
  return table.above.size() >= kLeastAbove && table.in_shade.size() >= kLeastShaded && table.lit.size() >= kLeastLit;
}

sim::WorldSpec world_of_probes(const sim::GeneratedHome& home) {
  sim::WorldSpec world = home.world;
  std::erase_if(world.robot, [](const sim::RobotSpec& robot) { return !robot.has_board; });
  world.object.clear();
  return world;
}

}  // namespace

Result<std::optional<TableInHome>> find_table(const sim::GeneratedHome& home, Random& random) {
  auto place = Place::make(world_of_probes(home), home.world.name);
  if (!place) return tl::unexpected(place.error());
  QuestionedHome asked(std::move(*place));
  auto robot_room = ProbeRoom::make(home, 0);
  if (!robot_room) return tl::unexpected(robot_room.error());
  for (const sim::Room& room : home.plan.rooms) {
    const sim::FloorRect floor = room.floor().inset(kFromWall_m);
    for (const Cover& cover : covers_in(asked, floor)) {
      for (std::size_t lamp = 0; lamp < home.lights.lamps.size(); ++lamp) {
        const TableInHome all = places_at(asked, cover, floor, lamp);
        if (all.above.size() < kLeastAbove || all.in_shade.size() < kLeastShaded || all.lit.size() < kLeastLit)
          continue;
        for (int i = 0; i < kStandpoints; ++i) {
          const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
          const double away_m = random.uniform(kNearest_m, kFarthest_m);
          const Vector3d at = cover.middle + away_m * Vector3d(std::cos(angle), std::sin(angle), 0.0);
          const sim::Pose X_WR = sim::pose_at({at.x(), at.y(), 0.0}, angle + std::numbers::pi);
          TableInHome table = all;
          if (keep_visible(asked, X_WR, table) && (*robot_room)->is_free(X_WR)) return table;
        }
      }
    }
  }
  return std::nullopt;
}

sim::WorldSpec world_at(const sim::GeneratedHome& home, const TableInHome& table) {
  sim::WorldSpec world = world_of_probes(home);
  for (std::size_t i = 0; i < home.lights.lamps.size(); ++i) {
    world.lamp[i].on = i == table.lamp;
    world.lamp[i].switch_name.clear();
  }
  std::swap(world.lamp[0], world.lamp[table.lamp]);  // the film's truth is that of the first
  const Vector3d at = table.X_WR.translation();
  const Vector3d ahead = table.X_WR.linear().col(0);
  world.robot[0].start_m = {at.x(), at.y(), 0.0};
  world.robot[0].start_heading_deg = std::atan2(ahead.y(), ahead.x()) * 180.0 / std::numbers::pi;
  return world;
}

}  // namespace cgsr::lab
