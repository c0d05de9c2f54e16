#pragma once

#include <cstdint>
#include <filesystem>

#include "platform/error.h"

namespace cgsr::sim {

struct ScenarioRun {
  std::filesystem::path scenario;  ///< a file, or a name in config/scenarios.
  int seed = 1;
  double duration_s = 0.0;  ///< 0: until the scenario ends.
  int width_px = 640;
  int height_px = 480;
  int threads = 2;
  std::filesystem::path video;  ///< empty: none.
  std::filesystem::path truth;  ///< CSV, a row an image; empty: none.
};

/// The columns of the file `truth`.
inline constexpr const char* kTruthColumns =
    "image,stamp_s,robot_x_m,robot_y_m,robot_heading_rad,robot_pitch_rad,tx,ty,tz,qw,qx,qy,qz,there,in_view,object_x_m,"
    "object_y_m,object_mps,distance_m,left,top,width,height";

/// What came of it.
struct ScenarioPlayed {
  std::uint64_t images = 0;
  std::uint64_t images_with_object = 0;
  double seconds = 0.0;  ///< of the scenario.
};

/// Plays a scenario without any robot's program: nobody commands the base, which stands where it was put, and everything else happens as
/// the file says. For looking at a scenario before a robot is let into it.
Result<ScenarioPlayed> run_scenario(const ScenarioRun& run);

}  // namespace cgsr::sim
