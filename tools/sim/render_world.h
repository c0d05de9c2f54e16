#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/sim/render/photographer.h"
#include "hal/sim/worlds/world.h"
#include "platform/error.h"
#include "tools/sim/words.h"

namespace cgsr::sim {

/// What a picture is to show.
struct PictureRequest {
  std::optional<Pose> X_WC;       ///< where the camera is; else the view, else the robot's.
  std::string view;               ///< of the world's file.
  std::string robot;              ///< whose camera; empty: the first one's.
  std::optional<double> at_s;     ///< else the view's, else 0.
  std::vector<std::string> on;    ///< lines that are on beside the room lamps'.
  std::vector<std::string> off;   ///< lines that are off.
  std::uint32_t seed = 1;         ///< of the noise.
  std::optional<ImageSize> size;  ///< else the camera's 640x480.
  bool noise = true;
  bool lens = true;  ///< its distortion.
  int edge_samples = 4;
  int threads = 2;
};

/// The moment of a world that a request means, and the camera that looks at it.
struct Take {
  Moment moment;
  CameraModel camera;
  SensorSettings sensor;
  int robot = -1;  ///< whose camera it is; -1: nobody's, and then no robot is there.
};

/// \return what the request names; or which view, robot or line is unknown, and what there is.
Result<Take> compose(const World& world, const PictureRequest& request);

/// Draws a take as the camera delivers it, and writes it as PNG. With `truth_folder`, also what is there: truth.csv, depth.png (millimetres),
/// parts.png (16 bit: 0 nothing, else the line of parts.csv), surface_shaded.png and possibly_shaded.png for the lamp.
struct PictureFiles {
  std::string output;
  std::string truth_folder;  ///< empty: none.
  std::string lamp;          ///< whose shadows; empty: the first one's.
};
Result<void> render_world(const World& world, const PictureRequest& request, const PictureFiles& files);

}  // namespace cgsr::sim
