#include "hal/sim/generator/home.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/generator/shell.h"

namespace cgsr::sim {
namespace {

// One stream of numbers for each part of a home.
enum Stream : std::uint32_t { kPlan, kPalette, kShell, kFurniture, kLight, kWay, kRobots, kStreams };

/// The shipped robots; lens and mount of their camera are drawn around the shipped ones.
void add_robots(GeneratedHome& home, Draw draw) {
  const double height = draw.uniform(1.1, 1.3);
  const double forward = draw.uniform(-0.03, 0.05);
  RobotSpec robot;
  const double focal = draw.uniform(0.96, 1.06);
  LensSpec& lens = robot.camera;
  lens.fx_px = rounded(lens.fx_px * focal);
  lens.fy_px = rounded(lens.fy_px * focal);
  lens.cx_px = rounded(lens.cx_px + draw.uniform(-6.0, 6.0));
  lens.cy_px = rounded(lens.cy_px + draw.uniform(-6.0, 6.0));
  lens.k1 = rounded(draw.uniform(-0.10, -0.04));
  lens.k2 = rounded(draw.uniform(0.02, 0.06));
  robot.name = "robot";
  robot.start_m = {home.route.start.x, home.route.start.y, 0.0};
  robot.start_heading_deg = home.route.start_heading_deg;
  robot.camera_height_m = height;
  robot.camera_forward_m = forward;
  robot.camera_down_deg = draw.uniform(-2.0, 8.0);
  home.world.robot.push_back(robot);
  robot.name = "lamp robot";
  robot.camera_height_m = draw.uniform(1.18, 1.22);
  robot.camera_forward_m = draw.uniform(-0.01, 0.01);
  robot.camera_down_deg = draw.uniform(18.5, 21.5);
  robot.has_board = true;
  home.world.robot.push_back(robot);
}

/// From a corner of each room, one where nothing is.
void add_views(GeneratedHome& home, const Site& site) {
  constexpr double kOff_m = 0.35;
  constexpr double kHeight_m = 2.0;
  for (const Room& room : home.plan.rooms) {
    const FloorRect near = room.floor().inset(kOff_m);
    const FloorRect far = room.floor().inset(0.3 * std::min(room.floor().width(), room.floor().depth()));
    for (int corner = 0; corner < 4; ++corner) {
      const bool east = corner % 2 == 1;
      const bool north = corner / 2 == 1;
      const FloorPoint from{rounded(east ? near.x1 : near.x0), rounded(north ? near.y1 : near.y0)};
      if (corner < 3 && !site.is_air(from, kHeight_m)) continue;
      ViewSpec view;
      view.name = room.name;
      view.from_m = {from.x, from.y, kHeight_m};
      view.to_m = {rounded(east ? far.x0 : far.x1), rounded(north ? far.y0 : far.y1), 0.6};
      home.world.view.push_back(view);
      break;
    }
  }
}

Result<GeneratedHome> draw_home(std::uint32_t seed, std::uint32_t attempt) {
  const auto stream = [&](Stream which) { return Draw(seed, attempt * kStreams + which); };
  GeneratedHome home;
  home.seed = seed;
  Draw plan_draw = stream(kPlan);
  auto plan = draw_floor_plan(plan_draw);
  if (!plan) return fail("no door fits between two of the rooms");
  home.plan = std::move(*plan);
  home.world.name = fmt::format("home {}", seed);

  Site site(home.plan, home.world, Palette(home.world.material, stream(kPalette)));
  Draw shell_draw = stream(kShell);
  Draw light_draw = stream(kLight);
  Draw furniture_draw = stream(kFurniture);
  Draw way_draw = stream(kWay);
  build_shell(site, shell_draw);
  if (!site.drivable()) return fail("a bare room cannot be driven through");
  auto lights = add_lights(site, light_draw);
  if (!lights) return tl::unexpected(lights.error());
  home.lights = std::move(*lights);
  home.furnished = furnish(site, furniture_draw);
  if (!site.drivable()) return fail("a room cannot be driven through");
  if (auto seen = lamps_are_seen(site, home.lights); !seen) return tl::unexpected(seen.error());
  auto route = draw_route(site, way_draw);
  if (!route) return fail("there is no way through all rooms");
  home.route = std::move(*route);
  add_robots(home, stream(kRobots));
  add_views(home, site);
  return home;
}

}  // namespace

Result<GeneratedHome> generate_home(std::uint32_t seed) {
  if (seed > kMaxHomeSeed) return fail(fmt::format("seed {} is not in 0..{}", seed, kMaxHomeSeed));
  std::vector<std::string> rejected;
  for (std::uint32_t attempt = 0; attempt < kMaxDraws; ++attempt) {
    auto home = draw_home(seed, attempt);
    if (home) {
      home->rejected = std::move(rejected);
      return home;
    }
    rejected.push_back(home.error().message);
  }
  return fail(fmt::format("seed {}: none of {} draws is a home that can be driven and lit; the last one: {}", seed,
                          kMaxDraws, rejected.back()));
}

}  // namespace cgsr::sim
