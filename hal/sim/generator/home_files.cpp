#include "hal/sim/generator/home_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "hal/sim/calibration/calibration_files.h"
#include "hal/sim/generator/world_text.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/worlds/world.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kForward_mps = 0.35;  // of the shipped route task
constexpr double kAtPlace_s = 2.5;     // slowing down, turning, starting again
constexpr double kBefore_s = 4.0;
constexpr double kDrift_m = 0.6;  // of the odometry that keep_in relies on

Result<void> write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) return fail(fmt::format("{}: cannot be written", file.string()));
  return {};
}

/// The home's outline in the frame of the odometry: x along the heading at the start.
FloorRect seen_from_start(const GeneratedHome& home) {
  const double c = cosine(degrees(home.route.start_heading_deg));
  const double s = sine(degrees(home.route.start_heading_deg));
  const FloorRect& o = home.plan.outline;
  FloorRect seen{1e9, 1e9, -1e9, -1e9};
  for (const double x : {o.x0, o.x1}) {
    for (const double y : {o.y0, o.y1}) {
      const double dx = x - home.route.start.x;
      const double dy = y - home.route.start.y;
      seen.x0 = std::min(seen.x0, c * dx + s * dy);
      seen.x1 = std::max(seen.x1, c * dx + s * dy);
      seen.y0 = std::min(seen.y0, c * dy - s * dx);
      seen.y1 = std::max(seen.y1, c * dy - s * dx);
    }
  }
  return seen.inset(-kDrift_m);
}

}  // namespace

std::string scenario_as_toml(const GeneratedHome& home, std::optional<double> ends_at_s) {
  const double takes = home.route.length_m / kForward_mps + kAtPlace_s * static_cast<double>(home.route.places.size());
  std::string text = fmt::format(
      "# A round through all {} rooms of home {}, {:.1f} m, on wheels that slip.\n"
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {:.1f}\n\n[base]\nslip = 0.05\n\n"
      "[[line]]\nname = \"arming\"\ninput = true\n\n[[line_event]]\nwhat = \"pressed\"\nline = \"arming\"\nfrom_s = "
      "1.5\n",
      home.plan.rooms.size(), home.seed, home.route.length_m, ends_at_s.value_or(std::ceil(kBefore_s + takes)));
  for (const LampSpec& lamp : home.world.lamp) {
    if (lamp.switch_name.empty()) continue;
    text += fmt::format("\n[[line]]\nname = \"{0}\"\n\n[[wall_switch]]\nlamp_line = \"{0}\"\n", lamp.switch_name);
  }
  return text;
}

std::string robot_as_toml(const GeneratedHome& home, const std::string& extends) {
  std::string places;
  for (const FloorPoint& place : home.route.places) {
    places += fmt::format("{}{:.3f}, {:.3f}", places.empty() ? "" : "; ", place.x, place.y);
  }
  const FloorRect area = seen_from_start(home);
  return fmt::format(
      "# The shipped robot on a round through home {}, localized with a map that was measured with errors (map/).\n"
      "extends = \"{}\"\nsim.scenario = \"round.toml\"\n\n"
      "[localization]\nmap = \"map/map.obj\"\ncamera = \"map/camera.yaml\"\nmount = \"map/robot.toml\"\n"
      "start = {{x_m = {:.4f}, y_m = {:.4f}, heading_deg = {:.1f}}}\n\n"
      "[task]\nkind = \"route\"\nroute.places_m = \"{}\"\n\n"
      "[motion.keep_in]\nmin_x_m = {:.2f}\nmax_x_m = {:.2f}\nmin_y_m = {:.2f}\nmax_y_m = {:.2f}\n",
      home.seed, extends, home.route.start.x, home.route.start.y, home.route.start_heading_deg, places, area.x0,
      area.x1, area.y0, area.y1);
}

Result<void> write_home(const GeneratedHome& home, const fs::path& shipped_robot, const fs::path& folder,
                        const CalibrationErrors& errors) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(fmt::format("{}: {}", folder.string(), error.message()));
  const fs::path world_file = folder / "world.toml";
  const std::string comment = fmt::format("Home {}, drawn by `cgsr sim home --seed {}`.", home.seed, home.seed);
  const auto world = build_world(home.world, world_file);
  if (!world) return tl::unexpected(world.error());
  const fs::path extends =
      fs::absolute(shipped_robot).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  if (auto done = write_text(world_file, world_as_toml(home.world, comment)); !done) return done;
  if (auto done = write_text(folder / "round.toml", scenario_as_toml(home)); !done) return done;
  if (auto done = write_text(folder / "robot.toml", robot_as_toml(home, extends.generic_string())); !done) return done;
  if (auto done =
          write_calibration(calibrated_copy(world->scene, 0, errors, home.seed), errors, home.seed, folder / "map");
      !done) {
    return done;
  }
  return write_text(folder / "map" / "lamp-robot.toml",
                    robot_as_toml(calibrated_copy(world->scene, 1, errors, home.seed), errors));
}

}  // namespace cgsr::sim
