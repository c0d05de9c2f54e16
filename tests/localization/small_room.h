#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"
#include "platform/image_view.h"

namespace cgsr::localization::testing {

/// Makes a map out of rectangles and boxes, edge by edge as map.h wants them.
class MapBuilder {
 public:
  /// \return index of a material of this grey.
  std::uint32_t grey(float value);

  /// A rectangle from `corner` along `u` and `v`; its front is where u x v points. \param on  the surface that it lies on, or kNone.
  std::uint32_t rectangle(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                          std::uint32_t material, std::uint32_t on = world::kNone);

  /// A box without bottom, its lower corner at `corner`, standing on the surface `on`.
  void box(const Eigen::Vector3f& corner, const Eigen::Vector3f& size, std::uint32_t material, std::uint32_t on);

  world::Map map;
};

/// A room of 4 x 4 m: tape on the floor, pictures and a door at the walls, a box.
world::Map small_room();

/// A camera 0.6 m above the room's floor, looking level but a little down.
geometry::Pose in_small_room(double x_m, double y_m, double heading_rad);

/// \return X_RL: a robot that leans, nose down, about an axle that high.
geometry::Pose leaning(double pitch_rad, double axle_height_m);

/// How a camera sees a map, by rays through every pixel: each surface in its grey, shaded by direction.
class Picture {
 public:
  Picture(const world::Map& map, const geometry::Pose& X_WC, const geometry::Camera& camera, double noise,
          std::uint32_t seed);

  [[nodiscard]] ImageView view() const;
  std::vector<std::uint8_t> pixels;

 private:
  int width_;
  int height_;
};

}  // namespace cgsr::localization::testing
