#pragma once

#include "hal/sim/render/surfaces.h"
#include "hal/sim/render/workers.h"

namespace cgsr::sim {

/// Computes how open the static places of a scene are to ambient light: 64 cosine-weighted rays from each grid point; one that meets
/// something at a distance below `reach` lets the share 0.3 + 0.7 distance / reach through. Corners and the floor under furniture get darker, as in
/// a room whose walls pass light on.
class OpenBaker {
 public:
  OpenBaker(const Scene& scene, Tracer& tracer, Surfaces& surfaces);

  /// Leaves the tracer without its moving parts: update() it afterwards.
  void bake(double reach_m, Workers& workers);

 private:
  void lay_out();
  [[nodiscard]] float open_from(const Eigen::Vector3f& p_W, const Eigen::Vector3f& n_W, float reach_m) const;

  const Scene& scene_;
  Tracer& tracer_;
  Surfaces& surfaces_;
};

}  // namespace cgsr::sim
