#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/sim/cache.h"
#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/worlds/world.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"
#include "platform/error.h"
#include "platform/image_view.h"

namespace cgsr::lab {

/// An image as the camera delivers it: YUYV, rows without gap.
struct Photograph {
  std::vector<std::uint8_t> yuyv;
  int width_px = 0;
  int height_px = 0;

  [[nodiscard]] ImageView view() const {
    return {yuyv.data(), width_px, height_px, std::ptrdiff_t{2} * width_px, PixelFormat::kYuyv};
  }
};

/// A simulated world as it really is, and a camera in it. Nobody walks in it unless `change` puts somebody there.
class Place {
 public:
  using Change = std::function<void(sim::WorldSpec&)>;

  /// \param world  a file of config/worlds, without `.toml`.  \param change  of what the file says, once its actors are taken out.
  static Result<std::unique_ptr<Place>> make(const std::string& world, const Change& change = {});

  /// The same of a world that is no file: a generated home. \param name  for messages.
  static Result<std::unique_ptr<Place>> make(sim::WorldSpec spec, const std::string& name, const Change& change = {});

  [[nodiscard]] const sim::World& world() const { return world_; }
  [[nodiscard]] const sim::Scene& scene() const { return world_.scene; }
  [[nodiscard]] const sim::CameraModel& camera() const { return world_.scene.robots.front().camera; }
  [[nodiscard]] geometry::Pose X_RC() const { return sim::mount_of(world_.scene.robots.front()); }
  sim::Renderer& renderer() { return photographer_->renderer(); }
  [[nodiscard]] const sim::SceneState& state() const { return state_; }

  /// Noise and lens as the world's camera has them. \param number  another number, other noise.
  Photograph photograph(const geometry::Pose& X_WC, std::uint32_t seed, std::uint64_t number);

 private:
  explicit Place(sim::World world) : world_(std::move(world)) {}

  sim::World world_;
  sim::SceneState state_;
  std::unique_ptr<sim::CachedPhotographer> photographer_;
};

/// All that the vision is told about a place.
struct Survey {
  geometry::Camera camera;
  geometry::Pose X_RC = geometry::Pose::Identity();
  world::Map map;
};

/// Measures the place with errors drawn from `seed`. The map goes through the file that `cgsr sim export` writes and the vision's own loader.
///
/// \param change  of the measured map's scene, before it is written; none: as it is.
Result<Survey> survey(const Place& place, const sim::CalibrationErrors& errors, std::uint32_t seed,
                      const std::function<void(sim::Scene&)>& change = {});

/// \return the vision's map of a measured scene: through the file that `cgsr sim export` writes and the vision's own loader.
Result<world::Map> map_of(const sim::Scene& measured);

/// \return the camera in the vision's words.
geometry::Camera camera_of(const sim::CameraModel& camera);

}  // namespace cgsr::lab
