#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::app {

/// A row of a pose or priors file.
struct PoseRow {
  std::optional<std::int64_t> frame;  ///< number of the image that it belongs to; nothing: the file has no such column.
  geometry::Pose X = geometry::Pose::Identity();
  std::optional<double> sigma_m;    ///< of each coordinate, where the file has such a column.
  std::optional<double> sigma_rad;  ///< of the turn about each axis, likewise.
  bool corrected =
      true;      ///< false: no image corrected it, it was only carried on; so says a column `corrected` of 0 or 1.
  int line = 0;  ///< in the file, from 1.
};

/// Reads poses from CSV with the columns `[frame,]tx,ty,tz,qw,qx,qy,qz`, named in the first line in any order; further columns are
/// ignored, so that what `cgsr localize --csv` wrote can be read back. Metres and a unit quaternion. Columns `sigma_m` and `sigma_deg`
/// may say how well a pose is known: standard deviations of each coordinate and about each axis; a column `corrected`, whether it was measured
/// (1) or predicted (0). Empty lines and lines that begin with '#' are ignored.
///
/// \return at least one row, frames rising; or the first thing that is wrong, with file, line, value and what was expected.
Result<std::vector<PoseRow>> read_poses(const std::filesystem::path& file);

/// The same from text; `name` is what messages call it.
Result<std::vector<PoseRow>> parse_poses(const std::string& text, std::string_view name);

/// \return the only pose of a file.
Result<geometry::Pose> read_pose(const std::filesystem::path& file);

inline constexpr std::string_view kPoseColumns = "tx,ty,tz,qw,qx,qy,qz";

/// \return the values of kPoseColumns, to a micrometre and to 1e-8 of the quaternion, whose real part is not negative.
std::string pose_as_csv(const geometry::Pose& X);

}  // namespace cgsr::app
