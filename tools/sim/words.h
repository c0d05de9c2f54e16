#pragma once

#include <string>

#include <Eigen/Core>

#include "hal/sim/scene/mesh.h"
#include "platform/error.h"

namespace cgsr::sim {

/// What a command line says about places. Each refuses what it does not understand with the text and what was expected.

/// `X,Y,Z` in metres.
Result<Eigen::Vector3d> parse_point(const std::string& text);

/// `tx,ty,tz,qw,qx,qy,qz`: a pose file's row, the camera in the world. The quaternion's length must be 1 within 1 %; it is normalised.
Result<Pose> parse_pose(const std::string& text);

/// `--from` and `--to`: a camera that looks from one place at another, its image upright.
Result<Pose> parse_view(const std::string& from, const std::string& to);

struct ImageSize {
  int width_px;
  int height_px;
};

/// `WIDTHxHEIGHT`, 16 to 4096 each, the width even (YUYV shares colour between two pixels).
Result<ImageSize> parse_image_size(const std::string& text);

}  // namespace cgsr::sim
