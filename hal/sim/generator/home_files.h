#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/generator/home.h"
#include "platform/error.h"

namespace cgsr::sim {

/// \return the round through the home as a scenario file says it: all lamps on, wheels that slip.
/// \param ends_at_s  nothing: the time that the route takes.
std::string scenario_as_toml(const GeneratedHome& home, std::optional<double> ends_at_s = {});

/// \return what a robot's file for the round says beside the shipped one that it extends.
/// \param extends  the shipped robot's file, as the path that is written down.
std::string robot_as_toml(const GeneratedHome& home, const std::string& extends);

/// Writes the files that a shipped world consists of into `folder`, which is made: world.toml, round.toml (the scenario), robot.toml (the
/// robot, which extends `shipped_robot`), and in map/ what the vision is told: map.obj, map.mtl, camera.yaml, robot.toml and lamp-robot.toml (the
/// mounts) with the errors drawn from the home's seed, clutter left out. The bytes depend on the seed alone, but for the path to
/// `shipped_robot`, which is relative to `folder`.
Result<void> write_home(const GeneratedHome& home, const std::filesystem::path& shipped_robot,
                        const std::filesystem::path& folder, const CalibrationErrors& errors = {});

}  // namespace cgsr::sim
