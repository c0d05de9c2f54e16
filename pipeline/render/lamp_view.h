#pragma once

#include <array>
#include <vector>

#include "pipeline/render/shade_parameters.h"
#include "pipeline/render/surface_raster.h"

namespace cgsr::render {

/// What a lamp's centre sees: six depth buffers around it, which say which triangles may stand between it and a point; whether one does is
/// then decided exactly. Thin things that fall between the buffers' cells are missed.
class LampView {
 public:
  /// \param map  outlives it.
  LampView(const world::Map& map, const ShadeParameters& parameters);

  /// Draws the map as the lamp sees it. Allocates nothing.
  void place(const Eigen::Vector3f& p_WL);

  struct Answer {
    bool hidden = false;
    std::uint32_t seen = kMixed;  ///< the triangle that the lamp sees all around the way to the point.
  };
  static constexpr std::uint32_t kMixed = 0xFFFFFFFEU;  ///< more than one.

  /// \param own  the surface that the point lies on, which does not hide it; kNone: none.
  [[nodiscard]] Answer look_at(const Eigen::Vector3f& p_W, std::uint32_t own) const;

 private:
  [[nodiscard]] bool stands_before(std::uint32_t triangle, const Eigen::Vector3f& ray) const;

  const world::Map& map_;
  float margin_;
  View view_;
  SurfaceRaster surfaces_;
  std::vector<DepthBuffer> faces_;  ///< +x, -x, +y, -y, +z, -z.
  Eigen::Vector3f p_WL_ = Eigen::Vector3f::Zero();
};

}  // namespace cgsr::render
