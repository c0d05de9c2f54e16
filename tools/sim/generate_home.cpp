#include "tools/sim/generate_home.h"

#include <system_error>

#include <fmt/format.h>

#include "hal/sim/generator/home_files.h"
#include "tools/sim/world_file.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShippedRobot = "sim-home-round";

}  // namespace

Result<void> claim_folder(const fs::path& folder, bool force) {
  std::error_code error;
  const auto there = fs::status(folder, error);
  if (!fs::exists(there)) return {};
  if (!fs::is_directory(there)) return fail(fmt::format("--output {}: is a file; name a folder", folder.string()));
  if (force || fs::is_empty(folder, error)) return {};
  if (error) return fail(fmt::format("--output {}: {}", folder.string(), error.message()));
  return fail(fmt::format("--output {}: the folder is not empty; name another one, or --force to write into it",
                          folder.string()));
}

Result<GeneratedHome> generate_home_to(const HomeRequest& request) {
  if (auto claimed = claim_folder(request.folder, request.force); !claimed) return tl::unexpected(claimed.error());
  const auto robot = find_robot_file(kShippedRobot);
  if (!robot) return tl::unexpected(robot.error());
  auto home = generate_home(request.seed);
  if (!home) return home;
  if (auto written = write_home(*home, *robot, request.folder); !written) return tl::unexpected(written.error());
  return home;
}

std::string describe_home(const GeneratedHome& home) {
  std::string text = fmt::format("home {}: {} rooms, {:.1f} m2, doors {}\n", home.seed, home.plan.rooms.size(),
                                 home.plan.outline.area(), home.plan.door_graph());
  text += fmt::format("{} pieces of furniture, {} pictures, {} things that no map knows\n", home.furnished.furniture,
                      home.furnished.pictures, home.furnished.clutter);
  text += fmt::format("{} lamp{}, {}, ambient share {:.2f}\n", home.lights.lamps.size(),
                      home.lights.lamps.size() == 1 ? "" : "s", home.lights.day ? "daylight" : "night",
                      home.lights.ambient_share);
  text += fmt::format("a round of {:.1f} m through {} places\n", home.route.length_m, home.route.places.size());
  for (const std::string& why : home.rejected) text += fmt::format("drawn again: {}\n", why);
  return text;
}

}  // namespace cgsr::sim
