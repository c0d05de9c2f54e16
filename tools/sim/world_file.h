#pragma once

#include <filesystem>
#include <string>

#include "hal/sim/worlds/world.h"
#include "platform/error.h"

namespace cgsr::sim {

/// Finds a world: a file, or the bare name of one in config/worlds (of the current folder, or of the source tree that the program was
/// built in). \return an error that names the worlds that there are.
Result<std::filesystem::path> find_world(const std::string& name);

/// The same of a scenario in config/scenarios.
Result<std::filesystem::path> find_scenario(const std::string& name);

/// The same of a robot's file in config/robots.
Result<std::filesystem::path> find_robot_file(const std::string& name);

/// Reads and builds it. \return every problem of the file, a line each.
Result<World> load_world(const std::string& name);

/// \return the robot's index; an error that names those that there are. Empty: the first.
Result<int> find_robot(const World& world, const std::string& name);

/// \return the lamp's index; an error that names those that there are. Empty: the first, or -1 where there is none.
Result<int> find_lamp(const World& world, const std::string& name);

/// What is in a world, for whoever wants to look at it: map, robots, views, lamps with their lines, actors.
std::string describe_world(const World& world);

}  // namespace cgsr::sim
