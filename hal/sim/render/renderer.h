#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/sim/render/lens.h"
#include "hal/sim/render/open_baker.h"
#include "hal/sim/render/scene_changes.h"
#include "hal/sim/render/shader.h"
#include "hal/sim/render/surfaces.h"
#include "hal/sim/render/tracer.h"
#include "hal/sim/render/workers.h"
#include "hal/sim/scene/scene.h"
#include "platform/error.h"

namespace cgsr::sim {

struct RenderOptions {
  int threads = 2;       ///< 1..64; the image does not depend on it.
  int edge_samples = 4;  ///< rays for a pixel at an edge: 1 (no anti-aliasing), 4 or 16.
};

/// Light as it arrives, per pixel [cd/m^2], three floats each.
struct RadianceImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> rgb;

  [[nodiscard]] Eigen::Map<const Rgb> at(int x, int y) const {
    return Eigen::Map<const Rgb>(
        &rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)) * 3]);
  }
};

/// What is under each pixel's centre.
struct GeometryImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::int32_t> part;      ///< index into the scene's parts, -1: nothing.
  std::vector<std::uint32_t> polygon;  ///< of the part.
  std::vector<float> depth_m;          ///< along the optical axis, 0: nothing.
};

/// Draws a scene through a lens into linear light. 16x16 tiles, packets of eight rays (4x2 pixels), first one ray a pixel, then more
/// where part, face or brightness change. The result depends on scene, state, pose and camera alone: the same bytes on any number of
/// threads. A tile that nothing can have changed since the last image is not traced again.
///
/// Threads: one caller at a time.
class Renderer {
 public:
  /// `scene` must outlive the renderer. \return what the tracer cannot hold.
  static Result<std::unique_ptr<Renderer>> make(const Scene& scene, const CameraModel& camera,
                                                const RenderOptions& options);

  /// Draws the scene at `state` seen from X_WC.
  void draw(const SceneState& state, const Pose& X_WC, RadianceImage& image);

  /// Moves what moves without drawing: for questions to tracer() about another moment than the last image's.
  void move_to(const SceneState& state) { tracer_->update(state); }

  /// What the last draw() saw at each pixel's centre.
  [[nodiscard]] const GeometryImage& geometry() const { return geometry_; }

  /// The share of tiles that the last draw() traced; the others are the image's before.
  [[nodiscard]] double traced_share() const;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const CameraModel& camera() const { return camera_; }
  [[nodiscard]] const RayTable& rays() const { return rays_; }
  [[nodiscard]] const Tracer& tracer() const { return *tracer_; }
  Workers& workers() { return workers_; }

 private:
  Renderer(const Scene& scene, const CameraModel& camera, const RenderOptions& options, std::unique_ptr<Tracer> tracer);

  struct Tile {
    int left;
    int top;
    int right;   // beyond the last
    int bottom;  // beyond the last
    RayBounds first;
    RayBounds refined;
    std::vector<int> edges;  // pixels that were refined
    bool redrawn = false;
  };

  void make_tiles();
  void first_pass(Tile& tile, const Pose& X_WC);
  void edge_pass(int index, const Pose& X_WC);
  void refine(Tile& tile, const Pose& X_WC);
  [[nodiscard]] bool neighbor_redrawn(int index) const;
  [[nodiscard]] std::vector<int> edges_of(const Tile& tile) const;
  [[nodiscard]] bool differ(std::size_t a, std::size_t b) const;

  const Scene& scene_;
  CameraModel camera_;
  RenderOptions options_;
  Workers workers_;
  RayTable rays_;
  std::unique_ptr<Tracer> tracer_;
  Surfaces surfaces_;
  Shader shader_;
  GeometryImage geometry_;
  SceneChanges changes_;
  std::vector<float> first_;       // radiance of the first pass
  std::vector<float> brightness_;  // of the first pass
  std::vector<float> refined_;     // radiance with refined edges
  int tiles_across_ = 0;
  std::vector<Tile> tiles_;
};

}  // namespace cgsr::sim
