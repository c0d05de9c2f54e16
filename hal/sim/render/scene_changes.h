#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "hal/sim/render/surfaces.h"
#include "hal/sim/render/tracer.h"
#include "hal/sim/scene/scene.h"

namespace cgsr::sim {

/// Where rays of the camera end, and where shadow rays begin from there: boxes in the world frame, empty where there are none.
struct RayBounds {
  Eigen::AlignedBox3f ends;
  Eigen::AlignedBox3f shadow_origins;

  void extend(const Ray& ray, const Surfel& surfel);
};

/// What has changed in a scene from one image to the next, and which rays may see another thing for it.
///
/// A part that moves can alter what a ray sees only where it was or where it is: in the hull of the camera and the place where the ray
/// ended, or of that place and a lamp. When the camera or the light has changed, everything has.
///
/// Threads: update() alone; affects() from any number at once.
class SceneChanges {
 public:
  /// `scene` must outlive it.
  explicit SceneChanges(const Scene& scene);

  /// Compares a moment with that of the call before; the tracer stands at it. The first time everything has changed.
  void update(const SceneState& state, const Tracer& tracer, const Pose& X_WC);

  /// May rays that ended within `bounds` the last time see anything else now?
  [[nodiscard]] bool affects(const RayBounds& bounds) const;

 private:
  struct PartState {
    bool present = false;
    Tracer::Placement X_WP;
  };

  bool take_view(const Pose& X_WC);
  bool take_light(const SceneState& state);
  void add_box(int part, const PartState& at);
  [[nodiscard]] bool affects(const RayBounds& bounds, const Eigen::AlignedBox3f& changed) const;

  const Scene* scene_;
  std::vector<int> moving_;        // parts of figures
  std::vector<PartState> states_;  // of moving_
  Eigen::Matrix3f R_WC_ = Eigen::Matrix3f::Zero();
  Eigen::Vector3f p_WC_ = Eigen::Vector3f::Zero();
  std::vector<LampState> lamps_;
  Eigen::Vector3f ambient_lux_ = Eigen::Vector3f::Zero();

  bool everything_ = true;
  Eigen::AlignedBox3f camera_;
  std::vector<Eigen::AlignedBox3f> lamp_boxes_;  // that shine
  std::vector<Eigen::AlignedBox3f> boxes_;       // where changed parts were and are
  Eigen::AlignedBox3f around_;                   // all of boxes_
};

}  // namespace cgsr::sim
