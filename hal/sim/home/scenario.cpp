#include "hal/sim/home/scenario.h"

#include <algorithm>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"
#include "platform/config/reader.h"

namespace cgsr::sim {
namespace {

/// A number in [-1, 1] that depends on what it is for alone.
double either_way(std::uint32_t seed, std::size_t actor, std::size_t number) {
  return 2.0 * static_cast<double>(
                   unit(mix(seed, static_cast<std::uint32_t>(actor), static_cast<std::uint32_t>(number)))) -
         1.0;
}

WalkSpec astray(const WalkSpec& walk, double astray_m, std::uint32_t seed, std::size_t actor) {
  WalkSpec moved = walk;
  for (std::size_t i = 1; i < moved.stop.size(); ++i) {
    moved.stop[i].at_m[0] += astray_m * either_way(seed, actor, 2 * i);
    moved.stop[i].at_m[1] += astray_m * either_way(seed, actor, 2 * i + 1);
  }
  return moved;
}

template <class Spec>
Spec* named(std::vector<Spec>& specs, const std::string& name) {
  const auto found = std::find_if(specs.begin(), specs.end(), [&](const Spec& spec) { return spec.name == name; });
  return found == specs.end() ? nullptr : &*found;
}

template <class Spec>
bool rewrite(std::vector<Spec>& specs, const ActorScriptSpec& script, const WalkSpec& walk) {
  Spec* actor = named(specs, script.name);
  if (actor == nullptr) return false;
  if (!walk.stop.empty()) actor->walk = walk;
  if (!script.presence.empty()) actor->presence = script.presence;
  return true;
}

void complain(std::string& problems, const std::filesystem::path& file, const std::string& text) {
  problems += fmt::format("{}{}: {}", problems.empty() ? "" : "\n", file.string(), text);
}

/// Writes what the scenario says over what the world's file says. \return problems, a line each.
std::string apply(const ScenarioSpec& spec, std::uint32_t seed, const std::filesystem::path& file, WorldSpec& world) {
  std::string problems;
  world.material.insert(world.material.end(), spec.material.begin(), spec.material.end());
  world.ball.insert(world.ball.end(), spec.ball.begin(), spec.ball.end());
  world.lamp.insert(world.lamp.end(), spec.lamp.begin(), spec.lamp.end());
  world.person.insert(world.person.end(), spec.person.begin(), spec.person.end());
  if (RobotSpec* robot =
          spec.robot.empty() ? (world.robot.empty() ? nullptr : &world.robot.front()) : named(world.robot, spec.robot);
      robot != nullptr) {
    if (spec.start.given) {
      robot->start_m = {spec.start.x_m, spec.start.y_m, 0.0};
      robot->start_heading_deg = spec.start.heading_deg;
    }
    if (spec.camera.height_m > 0.0) {
      robot->camera_height_m = spec.camera.height_m;
      robot->camera_down_deg = spec.camera.down_deg;
    }
  }
  for (std::size_t i = 0; i < spec.actor.size(); ++i) {
    const ActorScriptSpec& script = spec.actor[i];
    const WalkSpec walk = astray(script.walk, script.astray_m, seed, i);
    if (!rewrite(world.object, script, walk) && !rewrite(world.ball, script, walk) &&
        !rewrite(world.person, script, walk)) {
      complain(problems, file, fmt::format("actor '{}': the world has nobody of that name", script.name));
    }
  }
  for (const LightScriptSpec& light : spec.light) {
    if (light.lamp.empty()) {
      world.ambient.script = light.script;
    } else if (LampSpec* lamp = named(world.lamp, light.lamp)) {
      if (!light.script.empty()) lamp->script = light.script;
      if (light.radius_m > 0.0) {
        lamp->radius_m = light.radius_m;
        lamp->globe_radius_m = 0.0;
      }
    } else {
      complain(problems, file, fmt::format("light '{}': the world has no lamp of that name", light.lamp));
    }
  }
  const auto switched = [&](const WallSwitchSpec& wall) {
    return std::any_of(world.lamp.begin(), world.lamp.end(),
                       [&](const LampSpec& lamp) { return lamp.switch_name == wall.lamp_line; });
  };
  for (const WallSwitchSpec& wall : spec.wall_switch) {
    if (!switched(wall)) complain(problems, file, fmt::format("wall_switch '{}': switches no lamp", wall.lamp_line));
  }
  if (!spec.robot.empty() && named(world.robot, spec.robot) == nullptr) {
    complain(problems, file, fmt::format("robot '{}': the world has no robot of that name", spec.robot));
  }
  if (!spec.object.empty() && named(world.object, spec.object) == nullptr &&
      named(world.ball, spec.object) == nullptr && named(world.person, spec.object) == nullptr) {
    complain(problems, file, fmt::format("object '{}': the world has nothing of that name", spec.object));
  }
  return problems;
}

}  // namespace

Result<Scenario> load_scenario(const std::filesystem::path& file, std::uint32_t seed) {
  auto spec = config::read_file<ScenarioSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  if (spec->world.empty()) return fail(fmt::format("{}: world is empty: where does it happen?", file.string()));
  Scenario scenario;
  scenario.world_file = config::path_beside(file, spec->world);
  auto world = config::read_file<WorldSpec>(scenario.world_file);
  if (!world) return tl::unexpected(world.error());
  if (auto problems = apply(*spec, seed, file, *world); !problems.empty()) return fail(std::move(problems));
  scenario.spec = std::move(*spec);
  scenario.world = std::move(*world);
  return scenario;
}

}  // namespace cgsr::sim
