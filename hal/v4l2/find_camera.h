#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cgsr::hal::v4l2 {

/// A video device node as udev knows it.
struct CameraNode {
  std::string path;  ///< /dev/video0
  std::string id;    ///< of the device itself (vendor, model, serial number): the same wherever it is plugged in.
  std::string port;  ///< where it is plugged in.
  std::string name;  ///< the product's.
};

/// \return every video device node, in the order of their numbers. Without udev: none.
std::vector<CameraNode> camera_nodes();

/// \param wanted  a path, or a CameraNode's id or port. \return the path of the first node that fits and exists.
std::optional<std::string> find_camera(const std::string& wanted);

}  // namespace cgsr::hal::v4l2
