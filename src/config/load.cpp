#include "src/config/load.h"

#include "platform/config/reader.h"

namespace cgsr::config {

Result<Robot> load_robot(const std::filesystem::path& file) {
  auto robot = read_file<Robot>(file, Missing::kIsAnError);
  if (!robot) return robot;
  robot->run.model = path_beside(file, robot->run.model).string();
  robot->camera.replay.path = path_beside(file, robot->camera.replay.path).string();
  auto& known = robot->localization;
  for (std::string* path : {&known.map, &known.camera, &known.mount, &known.start.file})
    *path = path_beside(file, *path).string();
  robot->sim.scenario = path_beside(file, robot->sim.scenario).string();
  robot->sim.plug_in = path_beside(file, robot->sim.plug_in).string();
  return robot;
}

Result<Color> load_color(const std::filesystem::path& file) {
  if (file.empty()) return Color{};
  auto robot = load_robot(file);
  if (!robot) return tl::unexpected(robot.error());
  return robot->color;
}

}  // namespace cgsr::config
