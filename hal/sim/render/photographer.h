#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/sim/render/renderer.h"
#include "hal/sim/render/sensor.h"
#include "hal/sim/scene/scene.h"
#include "platform/error.h"

namespace cgsr::sim {

/// The world and where the camera is, at one instant of an exposure.
struct Moment {
  SceneState state;
  Pose X_WC = Pose::Identity();
};

/// What makes one image this image and no other: noise comes out of these.
struct ImageIdentity {
  std::uint32_t seed = 0;
  std::uint64_t number = 0;
};

/// A camera that turns moments into YUYV: what the simulated camera of the hardware interfaces is made of.
///
/// Threads: one caller at a time.
class Photographer {
 public:
  /// `scene` must outlive it.
  static Result<std::unique_ptr<Photographer>> make(const Scene& scene, const CameraModel& camera,
                                                    const RenderOptions& options);

  /// Takes an image into `buffer`, which is as large as the camera's images.
  /// \param moments  one: a sharp image. Several, spread evenly over the exposure: their mean, which is motion blur; cost is proportional.
  /// \return the mean luma, for AutoExposure.
  double take(const std::vector<Moment>& moments, const SensorSettings& settings, const ImageIdentity& identity,
              const YuyvBuffer& buffer);

  /// The light of the last image before the sensor, and the renderer for truth (whose geometry() is the last moment's).
  [[nodiscard]] const RadianceImage& light() const { return light_; }
  Renderer& renderer() { return *renderer_; }

 private:
  explicit Photographer(std::unique_ptr<Renderer> renderer) : renderer_(std::move(renderer)) {}

  std::unique_ptr<Renderer> renderer_;
  Sensor sensor_;
  RadianceImage light_;
  RadianceImage moment_;
};

}  // namespace cgsr::sim
