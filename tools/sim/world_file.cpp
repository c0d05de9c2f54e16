#include "tools/sim/world_file.h"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/sim/scene/map_count.h"
#include "platform/config/reader.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

// Where shipped files lie: here, or above the program (build/release/cgsr-sim).
std::vector<fs::path> folders_of(const std::string& kind) {
  std::vector<fs::path> folders{fs::path("config") / (kind + "s")};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path().parent_path().parent_path() / "config" / (kind + "s"));
  return folders;
}

template <class Things, class Name>
Result<int> find_named(const Things& things, const std::string& wanted, const char* what, const Name& to_string) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (to_string(things[i]) == wanted) return static_cast<int>(i);
    names.push_back(fmt::format("'{}'", to_string(things[i])));
  }
  return fail(fmt::format("there is no {} '{}'; there {}", what, wanted,
                          names.empty() ? "is none" : fmt::format("are {}", fmt::join(names, ", "))));
}

/// \param kind  "world", "scenario" or "robot".
Result<fs::path> find_shipped(const std::string& kind, const std::string& name) {
  if (name.empty()) return fail(fmt::format("no {} is named", kind));
  std::error_code error;
  if (fs::is_regular_file(name, error)) return fs::path(name);
  if (name.find('/') != std::string::npos || fs::path(name).has_extension()) {
    return fail(fmt::format("{}: {}", name, fs::exists(name, error) ? "not a file" : "there is no such file"));
  }
  std::vector<std::string> there;
  for (const fs::path& folder : folders_of(kind)) {
    const fs::path file = folder / (name + ".toml");
    if (fs::is_regular_file(file, error)) return file;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      if (at->path().extension() == ".toml") there.push_back(at->path().stem().string());
    }
    if (!there.empty()) break;
  }
  std::sort(there.begin(), there.end());
  return fail(fmt::format(
      "there is no {} '{}'; {}", kind, name,
      there.empty() ? "name its file" : fmt::format("there are {}, or name a file", fmt::join(there, ", "))));
}

}  // namespace

Result<fs::path> find_world(const std::string& name) {
  return find_shipped("world", name);
}

Result<fs::path> find_scenario(const std::string& name) {
  return find_shipped("scenario", name);
}

Result<fs::path> find_robot_file(const std::string& name) {
  return find_shipped("robot", name);
}

Result<World> load_world(const std::string& name) {
  const auto file = find_world(name);
  if (!file) return tl::unexpected(file.error());
  const auto spec = config::read_file<WorldSpec>(*file);
  if (!spec) return tl::unexpected(spec.error());
  return build_world(*spec, *file);
}

Result<int> find_robot(const World& world, const std::string& name) {
  if (name.empty()) return 0;
  return find_named(world.scene.robots, name, "robot", [](const RobotBody& robot) { return robot.name; });
}

Result<int> find_lamp(const World& world, const std::string& name) {
  if (name.empty()) return world.scene.lamps.empty() ? -1 : 0;
  return find_named(world.scene.lamps, name, "lamp", [](const Lamp& lamp) { return lamp.name; });
}

std::string describe_world(const World& world) {
  const MapCount map = count_map(world.scene);
  std::string text = fmt::format("{}: a map of {} surfaces and {} edges\n", world.scene.name, map.surfaces, map.edges);
  for (const RobotBody& robot : world.scene.robots) {
    text += fmt::format("robot '{}'{}\n", robot.name, robot.has_board ? ", with probe board" : "");
  }
  for (const World::View& view : world.views) text += fmt::format("view '{}'\n", view.name);
  for (const Lamp& lamp : world.scene.lamps) {
    const std::string line = lamp.switch_name.empty() ? "" : fmt::format(", switched by line '{}'", lamp.switch_name);
    const std::string carried = lamp.carried_by < 0 ? "" : ", carried by a robot";
    text += fmt::format("lamp '{}'{}{}\n", lamp.name, line, carried);
  }
  for (const Figure& figure : world.scene.figures) {
    if (figure.kind == FigureKind::kRobot) continue;
    text += fmt::format("actor '{}', {:.1f} s of script\n", figure.name, figure.path.duration_s());
  }
  return text;
}

}  // namespace cgsr::sim
