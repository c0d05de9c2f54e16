#include "hal/sim/generator/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/robot.h"

namespace cgsr::sim {
namespace {

constexpr int kTries = 25;
constexpr double kFloorLight_lux = 60.0;  // what the shipped home has, at the exposure and gain below
constexpr double kGain = 1.6;
constexpr double kExposure_s = 0.0166667;

// Warm to daylight white, linear.
constexpr std::array<Triple, 6> kLampColors{
    {{1.0, 0.80, 0.58}, {1.0, 0.86, 0.68}, {1.0, 0.91, 0.79}, {1.0, 0.96, 0.90}, {0.97, 0.98, 1.0}, {0.90, 0.96, 1.0}}};

ShapeSpec part(std::string name, ShapeKind kind, std::string material, const Triple& foot, const Triple& size) {
  ShapeSpec spec;
  spec.name = std::move(name);
  spec.kind = kind;
  spec.material = std::move(material);
  spec.position_m = {rounded(foot[0]), rounded(foot[1]), rounded(foot[2])};
  spec.size_m = {rounded(size[0]), rounded(size[1]), rounded(size[2])};
  return spec;
}

void hang(Site& site, const Room& room, Draw& draw, LampSpec& lamp) {
  const FloorRect f = room.floor();
  const double off = std::min(0.9, 0.5 * std::min(f.width(), f.depth()) - 0.3);
  const double x = draw.uniform(-off, off);
  const double y = draw.uniform(-off, off);
  const double ceiling = site.plan().ceiling_m;
  const double below = std::min(ceiling - 2.05, lamp.radius_m + draw.uniform(0.02, 0.5));
  lamp.position_m = {rounded(f.x() + x), rounded(f.y() + y), rounded(ceiling - std::max(lamp.radius_m + 0.02, below))};
  const double cord = ceiling - lamp.position_m[2] - lamp.radius_m;
  if (cord < 0.01) return;
  ShapeSpec shape = part(lamp.name + " cord", ShapeKind::kCylinder, site.palette().metal(),
                         {lamp.position_m[0], lamp.position_m[1], ceiling - cord}, {0.012, 0.012, cord});
  shape.casts_shadow = false;
  shape.in_map = false;
  site.add(shape);
}

bool stand(Site& site, const Room& room, Draw& draw, LampSpec& lamp) {
  const double height = draw.uniform(1.4, 1.8);
  const std::string metal = site.palette().metal();
  Make make{lamp.name, {0.3, 0.3, height + lamp.radius_m}, {}, false, false};
  make.shapes = {
      part("foot", ShapeKind::kCylinder, metal, {0, 0, 0}, {0.28, 0.28, 0.02}),
      part("pole", ShapeKind::kCylinder, metal, {0, 0, 0.02}, {0.025, 0.025, height - lamp.radius_m - 0.03})};
  const int at = site.put_at_wall(make, room, draw, draw.uniform(0.02, 0.3));
  if (at < 0) return false;
  const FloorPoint& p = site.standing()[static_cast<std::size_t>(at)].footprint.middle;
  lamp.position_m = {p.x, p.y, height};
  return true;
}

bool mount_on_wall(Site& site, const Room& room, Draw& draw, LampSpec& lamp) {
  const double height = draw.uniform(1.6, 2.0);
  const double off = rounded(lamp.radius_m + 0.08);
  for (int i = 0; i < kTries; ++i) {
    const Side side = draw.pick(kSides);
    const Range1 range = range_of(room, side);
    const double along = draw.uniform(range.from + 0.4, range.to - 0.4);
    if (!site.bare(room, side, along - 0.25, along + 0.25, height - 0.3, height + 0.3)) continue;
    const AtWall face = at_wall(room, side, along, 0.0);
    Make bracket{lamp.name, {0.1, 0.12, 0.12}, {}, true, false};
    bracket.shapes = {part("bracket", ShapeKind::kBox, site.palette().metal(), {0.015, 0, 0}, {0.03, 0.12, 0.12})};
    site.put(bracket, face.place, face.heading_deg, height - 0.06);
    const FloorPoint p = at_wall(room, side, along, off).place;
    lamp.position_m = {rounded(p.x), rounded(p.y), height};
    const double wide = 2.0 * lamp.radius_m + 0.1;
    site.reserve({{p, wide, wide, face.heading_deg}, height - wide / 2, height + wide / 2});
    return true;
  }
  return false;
}

/// Adds it to the world.
Result<LampPlace> place_lamp(Site& site, std::size_t in_room, Draw& draw, int number) {
  const Room& room = site.plan().rooms[in_room];
  LampSpec lamp;
  lamp.name = number == 1 ? room.name + " lamp" : fmt::format("{} lamp {}", room.name, number);
  lamp.switch_name = lamp.name;
  lamp.radius_m = draw.uniform(0.02, 0.15);
  lamp.color = draw.pick(kLampColors);
  lamp.lumens = std::round(draw.uniform(600.0, 3000.0));
  LampPlace place{in_room, site.standing().size(), 0};
  const int kind = draw.below(10);
  bool done = true;
  if (kind < 5) {
    hang(site, room, draw, lamp);
  } else {
    done = kind < 8 ? stand(site, room, draw, lamp) : mount_on_wall(site, room, draw, lamp);
  }
  if (!done) return fail(fmt::format("{}: no place for it", lamp.name));
  place.own_to = site.standing().size();
  if (!probes_see(site, lamp, place)) return fail(fmt::format("{}: seen by the probes from nowhere", lamp.name));
  site.world().lamp.push_back(lamp);
  return place;
}

/// Illuminance of a floor by one lamp that nothing hides [lx], the mean over the room.
double mean_on_floor(const Room& room, const LampSpec& lamp) {
  constexpr int kSteps = 9;
  const FloorRect f = room.floor();
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double dx = f.x0 + (i + 0.5) * f.width() / kSteps - lamp.position_m[0];
      const double dy = f.y0 + (j + 0.5) * f.depth() / kSteps - lamp.position_m[1];
      const double z = lamp.position_m[2];
      const double squared = dx * dx + dy * dy + z * z;
      sum += lamp.lumens / (4.0 * kPi) * z / (squared * std::sqrt(squared));
    }
  }
  return sum / (kSteps * kSteps);
}

/// A large soft lamp outside of a window: the format has no sky that gives light.
void add_daylight(Site& site, Draw& draw, double lamp_lux) {
  int number = 0;
  for (const Wall& wall : site.plan().walls) {
    for (const Opening& window : wall.openings) {
      if (window.kind != OpeningKind::kWindow || number >= 2 || (number > 0 && draw.chance(0.5))) continue;
      const double middle = (window.from + window.to) / 2 + draw.uniform(-0.4, 0.4);
      const double out = draw.uniform(1.2, 2.2);
      const double at = wall.at > 0.1 ? wall.at + out : wall.at - out;
      LampSpec light;
      light.name = fmt::format("daylight {}", ++number);
      light.position_m = {rounded(wall.along_x ? middle : at), rounded(wall.along_x ? at : middle),
                          draw.uniform(2.0, 3.2)};
      light.radius_m = draw.uniform(0.4, 0.7);
      light.color = {0.86, 0.94, 1.0};
      // On what faces the window 1.5 m behind it.
      const double distance = out + 1.5;
      light.lumens = std::round(draw.uniform(0.4, 1.6) * lamp_lux * 4.0 * kPi * distance * distance);
      light.visible = false;
      site.world().lamp.push_back(light);
    }
  }
}

}  // namespace

bool probes_see(const Site& site, const LampSpec& lamp, const LampPlace& place) {
  const Room& room = site.plan().rooms[place.room];
  const ProbeBoard board;
  const FreeFloor& floor = site.floor();
  const FloorRect f = room.floor();
  const Triple& l = lamp.position_m;
  const double apex = board.p_RB.z() + board.cone_height_m;
  if (l[2] - lamp.radius_m < apex + 0.1) return false;
  const auto in_the_way = [&](double x, double y) {
    for (int i = 1; i < 40; ++i) {
      const double t = i / 40.0;
      const FloorPoint p{x + t * (l[0] - x), y + t * (l[1] - y)};
      const double z = apex + t * (l[2] - apex);
      for (std::size_t k = 0; k < site.standing().size(); ++k) {
        if (k >= place.own_from && k < place.own_to) continue;
        const Standing& thing = site.standing()[k];
        if (z > thing.from_m && z < thing.to_m && thing.footprint.distance_to(p) <= 0.0) return true;
      }
    }
    return false;
  };
  const auto shadow_on_board = [&](double x, double y, double c, double s, const Eigen::Vector2d& foot) {
    const double forward = board.p_RB.x() + foot.x();
    const double ax = x + c * forward - s * foot.y();
    const double ay = y + s * forward + c * foot.y();
    const double k = board.cone_height_m / (l[2] - apex);
    const double sx = k * (ax - l[0]);
    const double sy = k * (ay - l[1]);
    const double board_x = foot.x() + c * sx + s * sy;
    const double board_y = foot.y() + c * sy - s * sx;
    const bool on_it = std::abs(board_x) < board.depth_m / 2 - 0.01 && std::abs(board_y) < board.width_m / 2 - 0.01;
    return on_it && sx * sx + sy * sy > 0.03 * 0.03 && !in_the_way(ax, ay);
  };
  for (double x = f.x0 + 0.4; x < f.x1 - 0.4; x += 0.25) {
    for (double y = f.y0 + 0.4; y < f.y1 - 0.4; y += 0.25) {
      if (!floor.is_free({x, y}, kRobotRadius_m)) continue;
      for (int turn = 0; turn < 16; ++turn) {
        const double c = cosine(turn * kPi / 8.0);
        const double s = sine(turn * kPi / 8.0);
        const double ahead = c * (l[0] - x) + s * (l[1] - y);
        if (ahead < 0.0) continue;  // the mast and the camera would be before it
        if (std::ranges::all_of(board.cones_m, [&](const auto& foot) { return shadow_on_board(x, y, c, s, foot); })) {
          return true;
        }
      }
    }
  }
  return false;
}

Result<void> lamps_are_seen(Site& site, const Lights& lights) {
  for (std::size_t i = 0; i < lights.lamps.size(); ++i) {
    const LampSpec& lamp = site.world().lamp[i];
    if (!probes_see(site, lamp, lights.lamps[i])) return fail(fmt::format("{}: furniture hides it", lamp.name));
  }
  return {};
}

Result<Lights> add_lights(Site& site, Draw& draw) {
  Lights lights;
  std::vector<std::size_t> order(site.plan().rooms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(draw.below(static_cast<int>(i)))]);
  }
  WorldSpec& world = site.world();
  const auto wanted = static_cast<std::size_t>(draw.between(1, 3));
  double lux = 0.0;
  double lumens = 0.0;
  for (std::size_t i = 0; i < wanted; ++i) {
    auto place = place_lamp(site, order[i % order.size()], draw, 1 + static_cast<int>(i / order.size()));
    if (!place) return tl::unexpected(place.error());
    const LampSpec& lamp = world.lamp.back();
    lux = std::max(lux, mean_on_floor(site.plan().rooms[place->room], lamp));
    lumens += lamp.lumens;
    lights.lamps.push_back(*place);
  }
  lights.day = draw.chance(0.5);
  lights.ambient_share = draw.uniform(0.2, 0.75);
  const double ambient = lux * lights.ambient_share / (1.0 - lights.ambient_share);
  const double bounced = ambient * draw.uniform(0.15, 0.5);
  for (LampSpec& lamp : world.lamp) lamp.bounce = std::round(1e6 * bounced / lumens) / 1e6;
  const double warm = draw.uniform(-0.08, 0.08);
  const double own = ambient - bounced;
  world.ambient.illuminance_lux = {rounded(own * (1.0 + warm)), rounded(own), rounded(own * (1.0 - warm))};
  world.ambient.from_below = draw.uniform(0.5, 0.75);
  world.ambient.corner_reach_m = draw.uniform(0.6, 1.4);
  if (lights.day) add_daylight(site, draw, lux);
  world.exposure_s = kExposure_s;
  const double gain = draw.uniform(0.85, 1.15) * kGain * kFloorLight_lux / (lux + ambient);
  world.gain = rounded(std::clamp(gain, 0.1, 64.0));
  const double sky = (lights.day ? draw.uniform(60.0, 250.0) : draw.uniform(0.3, 2.0)) * kGain / world.gain;
  const auto material = std::ranges::find(world.material, "sky", &MaterialSpec::name);
  if (material != world.material.end()) material->glow_cd_m2 = {rounded(0.88 * sky), rounded(sky), rounded(1.16 * sky)};
  return lights;
}

}  // namespace cgsr::sim
