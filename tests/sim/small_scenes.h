#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/sim/render/renderer.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {

/// A scene with nothing but what the test puts in: no ambient light unless asked for.
inline Scene dark_scene() {
  Scene scene;
  scene.name = "test";
  scene.ambient.corner_reach_m = 0.0;
  return scene;
}

inline int matt(Scene& scene, const Rgb& albedo) {
  Material material;
  material.name = "matt " + std::to_string(scene.materials.size());
  material.albedo = albedo;
  return scene.add_material(material);
}

inline void add_lamp(Scene& scene, const Eigen::Vector3d& p_WL, double lumens, double radius_m = 0.0,
                     const Rgb& color = Rgb::Ones()) {
  Lamp lamp;
  lamp.p_WL = p_WL;
  lamp.lumens = lumens;
  lamp.radius_m = radius_m;
  lamp.color = color;
  scene.lamps.push_back(lamp);
}

/// A camera that looks straight down from (x, y, height), image x along the world's x, image y against the world's y.
inline Pose straight_down(double x, double y, double height) {
  Pose X_WC = Pose::Identity();
  X_WC.translation() = Eigen::Vector3d(x, y, height);
  X_WC.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return X_WC;
}

inline CameraModel plain_camera(int width, int height, double f_px) {
  CameraModel camera;
  camera.width_px = width;
  camera.height_px = height;
  camera.fx_px = camera.fy_px = f_px;
  camera.cx_px = (width - 1) / 2.0;
  camera.cy_px = (height - 1) / 2.0;
  return camera.without_distortion();
}

/// One thread: the tests run beside others.
inline std::unique_ptr<Renderer> renderer_for(const Scene& scene, const CameraModel& camera, int edge_samples = 1,
                                              int threads = 1) {
  auto renderer = Renderer::make(scene, camera, {threads, edge_samples});
  EXPECT_TRUE(renderer) << renderer.error().message;
  return renderer ? std::move(*renderer) : nullptr;
}

inline RadianceImage draw(const Scene& scene, const CameraModel& camera, const Pose& X_WC, int edge_samples = 1) {
  RadianceImage image;
  renderer_for(scene, camera, edge_samples)->draw(state_at(scene, 0.0), X_WC, image);
  return image;
}

/// A small generator with a fixed sequence.
class Seeded {
 public:
  explicit Seeded(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace cgsr::sim
