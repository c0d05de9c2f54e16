#pragma once

#include "hal/sim/people/identity.h"
#include "hal/sim/scene/material.h"
#include "hal/sim/scene/mesh.h"

namespace cgsr::sim {

/// Half axes of a head of relative size 1: depth, half width, half height [m].
inline constexpr double kHeadDepth_m = 0.096;
inline constexpr double kHeadWidth_m = 0.074;
inline constexpr double kHeadHeight_m = 0.118;

/// A place on the head's grid before it is shaped: s in -1..1 runs around (0 is the front, the grid is denser there), t in -1..1 up.
struct OnHead {
  double y_m;    ///< left, of the plain ellipsoid.
  double z_m;    ///< up.
  double front;  ///< cosine of the angle around: 1 at the nose, -1 behind.
};
OnHead on_head(double s, double t);

/// The head as a mesh about the middle between ears and eyes, facing +x, z up: an ellipsoid with tapered jaw, eye sockets, eyeballs, brows,
/// nose, lips, chin, raised hair, and ears. Texture coordinates belong to face_texture().
Mesh head_mesh(const Identity& id);

/// The skin of the head, 1024 x 512, linear light: painted in front-projected metres, as theatrical make-up paints shadows, because a face
/// detector looks at twenty pixels and real heads have darker eye regions than diffuse light on this mesh gives.
Texture face_texture(const Identity& id);

}  // namespace cgsr::sim
