#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <embree3/rtcore.h>
#include <Eigen/Core>

#include "hal/sim/scene/scene.h"
#include "platform/error.h"

namespace cgsr::sim {

/// Which surfaces a ray can meet.
enum RayKind : unsigned {
  kSightRays = 1U,   ///< everything there is to see.
  kShadowRays = 2U,  ///< what casts shadows.
  kMapRays = 4U,     ///< static parts that the robot's map holds.
};

/// The parts of one figure alone. There are at most so many figures in a scene.
inline constexpr int kMostFigures = 28;
constexpr unsigned figure_rays(int figure) {
  return 16U << static_cast<unsigned>(figure);
}

/// Eight rays at a time, which is what the tracer is fastest with.
inline constexpr int kPacket = 8;

/// Rays of a camera see as far as this along its axis.
inline constexpr float kMaxDepth_m = 2000.0F;

/// What a ray met.
struct Met {
  int part = -1;  ///< index into the scene's parts.
  std::uint32_t triangle = 0;
  float u = 0.0F;  ///< barycentric, of the second and third corner.
  float v = 0.0F;
};

/// The scene as Embree holds it. Static parts are one object, each moving part is an instance: a new moment costs a commit of the
/// top level only, not a new tree.
///
/// Threads: update() alone; the queries from any number at once.
class Tracer {
 public:
  /// `scene` must outlive the tracer. Only "isa=sse2" is ever asked for: newer instruction sets differ in a few bytes of the image.
  static Result<std::unique_ptr<Tracer>> make(const Scene& scene);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Moves what moves.
  void update(const SceneState& state);

  /// Finds the nearest surface for every ray whose `valid` is -1 (0: left alone). Embree's pitfall: with packets of 16 the coherent
  /// flag never returned from the occlusion call; packets of 8 are the only ones used here.
  /// Embree says which triangle; where on it is computed here: Embree's reciprocals begin with RCPPS, whose last bits are each manufacturer's own.
  void nearest(const int* valid, RTCRayHit8& rays, bool coherent) const;

  /// Sets tfar to -inf for every ray that something blocks.
  void blocked(const int* valid, RTCRay8& rays, bool coherent) const;

  /// Names what lane `lane` hit; part is -1 when it hit nothing.
  [[nodiscard]] Met met(const RTCRayHit8& rays, int lane) const;

  /// The pose of a part's mesh in the world.
  struct Placement {
    Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
    Eigen::Vector3f p = Eigen::Vector3f::Zero();
  };
  [[nodiscard]] const Placement& placement(int part) const { return placements_[static_cast<std::size_t>(part)]; }

 private:
  explicit Tracer(const Scene& scene);
  Result<void> build();
  RTCGeometry geometry_of(const Part& part);
  /// Distance and barycentric coordinates of what a lane has hit.
  void measure(RTCRayHit8& rays, int lane) const;

  const Scene* scene_;
  RTCDevice device_ = nullptr;
  RTCScene top_ = nullptr;
  std::vector<RTCScene> objects_;          // [instance]
  std::vector<RTCGeometry> instances_;     // [instance]
  std::vector<std::vector<int>> part_of_;  // [instance][geometry]
  std::vector<Placement> placements_;      // [part]
};

}  // namespace cgsr::sim
