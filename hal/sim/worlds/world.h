#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/render/sensor_settings.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/worlds/world_spec.h"
#include "platform/error.h"

namespace cgsr::sim {

/// A world that is fit to be rendered, and what its file says beside the scene.
struct World {
  Scene scene;
  SensorSettings sensor;                         ///< fixed exposure that suits its light.
  std::vector<Pose> X_WR_start;                  ///< [robot]
  std::vector<std::optional<Path>> robot_walks;  ///< [robot]: scripted instead of driven.
  struct View {
    std::string name;
    Pose X_WC;
    double at_s = 0.0;
  };
  std::vector<View> views;
};

/// Where the robots stand by script: on their walk, or where they start.
std::vector<Pose> scripted_robots(const World& world, double time_s);

/// Makes the world that a file describes.
///
/// \param file_name  what messages call it; relative mesh files start at its folder.
/// \return the world, or every problem, a line each (`worlds/home.toml:41: shape 'table': there is no material 'oak'`): unknown or doubled
///         names, a mesh that is missing or cannot be read, sizes below 1 mm or places beyond 1 km, numbers that are not finite, a lamp inside
///         a solid, no robot (and so no camera), nothing to see.
Result<World> build_world(const WorldSpec& spec, const std::filesystem::path& file_name);

}  // namespace cgsr::sim
