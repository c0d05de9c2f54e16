#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/sim/worlds/world.h"
#include "platform/error.h"

namespace cgsr::sim {

struct ExportRequest {
  std::string robot;          ///< whose camera, mount and probes; empty: the first one's.
  std::uint32_t seed = 1;     ///< of the errors.
  double error_factor = 1.0;  ///< every stated error so many times as large; 0: the copy is the truth.
};

/// Writes the static geometry as map.obj and map.mtl into `folder`, and into `folder`/calibrated what the vision may be given instead:
/// camera.yaml, robot.toml and a map, all with errors.
Result<void> export_world(const World& world, const ExportRequest& request, const std::filesystem::path& folder);

}  // namespace cgsr::sim
