#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/render/depth_raster.h"
#include "tests/render/box_map.h"

namespace cgsr::render {

inline double uniform(std::mt19937& random, double least, double most) {
  return least + (most - least) * random() / 4294967296.0;
}

/// A standpoint in the free space of a map, as far as the map's box goes; nothing stands right before the camera.
inline geometry::Pose free_pose(const world::Map& map, std::mt19937& random) {
  RasterParameters close;
  close.near_m = 0.005;
  DepthRaster raster(map, close);
  Eigen::AlignedBox3f box;
  for (const auto& p : map.vertices) box.extend(p);
  const Eigen::Vector3d least = box.min().cast<double>();
  const Eigen::Vector3d most = box.max().cast<double>();
  for (;;) {
    const Eigen::Vector3d p_WC(uniform(random, least.x(), most.x()), uniform(random, least.y(), most.y()),
                               uniform(random, 0.6, 1.5));
    const double heading = uniform(random, -3.14159, 3.14159);
    const geometry::Pose X_WC = looking_from(
        p_WC, p_WC + Eigen::Vector3d(std::cos(heading), std::sin(heading), -std::tan(uniform(random, -0.1, 0.5))));
    raster.draw(X_WC, geometry::Camera());
    float nearest = 0.0F;
    int drawn = 0;
    for (int y = 0; y < raster.buffer().height(); ++y) {
      for (int x = 0; x < raster.buffer().width(); ++x) {
        nearest = std::max(nearest, raster.buffer().inverse_depth(x, y));
        drawn += raster.buffer().name(x, y) != DepthBuffer::kNothing ? 1 : 0;
      }
    }
    if (drawn > 20000 && nearest < 1.0F / 0.3F) return X_WC;
  }
}

}  // namespace cgsr::render
