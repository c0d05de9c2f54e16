#pragma once

#include <filesystem>

#include "pipeline/world/occupancy.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads a floor map as ROS's map_server stores it: a YAML file with image, resolution, origin, negate and occupied_thresh, and the image beside
/// it (mode trinary; PGM, PNG or BMP). A cell is occupied when its darkness exceeds occupied_thresh.
/// \return an error that names file, line and what was expected: a key that is missing or of another kind, another mode, an image outside of the
///         file's folder, that cannot be read, or of more than kMaxMapCells cells.
Result<world::OccupancyGrid> read_ros_map(const std::filesystem::path& file);

inline constexpr int kMaxMapCells = 4096 * 4096;

}  // namespace cgsr::app
