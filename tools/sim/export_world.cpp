#include "tools/sim/export_world.h"

#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "hal/sim/calibration/calibration_files.h"
#include "hal/sim/calibration/map_file.h"
#include "tools/sim/world_file.h"

namespace cgsr::sim {

Result<void> export_world(const World& world, const ExportRequest& request, const std::filesystem::path& folder) {
  if (!std::isfinite(request.error_factor) || request.error_factor < 0.0 || request.error_factor > 20.0) {
    return fail(fmt::format("errors {} times as large are not in 0..20", request.error_factor));
  }
  const auto robot = find_robot(world, request.robot);
  if (!robot) return tl::unexpected(robot.error());
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(fmt::format("{}: {}", folder.string(), error.message()));
  auto written = write_map(world.scene, folder / "map.obj", fmt::format("The world '{}' as it is", world.scene.name));
  if (!written) return written;
  const CalibrationErrors errors = CalibrationErrors().times(request.error_factor);
  return write_calibration(calibrated_copy(world.scene, *robot, errors, request.seed), errors, request.seed,
                           folder / "calibrated");
}

}  // namespace cgsr::sim
