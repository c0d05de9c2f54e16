#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "pipeline/world/map.h"

namespace cgsr::world {

inline constexpr std::uint32_t kLargestCorners = 24'000'000;
inline constexpr std::uint32_t kLargestFaces = 12'000'000;
inline constexpr std::uint32_t kLargestOutline = 2'000;  ///< corners of one face.
inline constexpr std::uint32_t kLargestFan = 256;        ///< triangles at one edge.
inline constexpr float kLargestExtent_m = 1e6F;

/// What a file says, before clean-up: faces as outlines, in W, metres. Ours.
struct Soup {
  struct Face {
    std::uint32_t first = 0;  ///< in corners.
    std::uint32_t count = 0;
    std::uint32_t material = 0;
  };
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t>
      corners;  ///< indices into points, outline after outline, counter-clockwise seen from the front.
  std::vector<Face> faces;
  std::vector<std::array<std::uint32_t, 2>> lines;  ///< edges that the file draws itself.
  std::vector<Material> materials;
  bool one_sided = false;  ///< its faces are seen from the front alone.
};

}  // namespace cgsr::world
