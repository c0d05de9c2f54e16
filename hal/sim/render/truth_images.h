#pragma once

#include <cstdint>
#include <vector>

#include "hal/sim/render/renderer.h"
#include "platform/box.h"

namespace cgsr::sim {

/// The two masks of shaded regions for one lamp, one byte a pixel, 0 or 255. Only the static parts of the robot's map take part: no
/// robots, no actors. A point counts as shaded when the map hides the lamp's centre from it.
struct ShadowMasks {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> surface_shaded;   ///< the first surface of the map along the pixel's ray is.
  std::vector<std::uint8_t> possibly_shaded;  ///< some point between the camera and that surface is.
};

struct ShadowMaskOptions {
  double step_m = 0.02;  ///< between the points that are tried along a ray: thinner shadows may be missed.
  int stride_px = 1;     ///< one ray for a block of so many pixels, through its middle.
};

/// \param lamp  index into the scene's lamps. Cost: a shadow ray for every step along every ray; 640x480 at stride 1 takes seconds.
ShadowMasks shadow_masks(Renderer& renderer, const SceneState& state, const Pose& X_WC, int lamp,
                         const ShadowMaskOptions& options = {});

/// What the camera sees of a figure.
struct FigureView {
  bool in_view = false;  ///< at least one pixel.
  Box visible;           ///< around the pixels that are seen, [px].
  Box whole;             ///< around the silhouette inside the image, were nothing in front of it.
  int visible_px = 0;
  int whole_px = 0;  ///< of the silhouette inside the image.
  int lit_px = 0;    ///< of the visible ones, those that see the centre of the lamp (moving things cast shadows here).
};

/// The renderer stands at `state`: after draw() or move_to() with it.
///
/// \param figure  index into the scene's figures.  \param parts  which of its parts count (such as a head); empty: all.
/// \param lamp  whose light `lit_px` means; -1: none is asked for.
FigureView figure_view(Renderer& renderer, const SceneState& state, const Pose& X_WC, int figure,
                       const std::vector<int>& parts = {}, int lamp = -1);

/// Where the shadow of a probe's apex falls.
struct ProbeShadow {
  Eigen::Vector3d p_WA = Eigen::Vector3d::Zero();   ///< the apex.
  Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();   ///< its shadow on the board's plane.
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  ///< the shadow in the image (may lie outside).
  bool lamp_above = false;                          ///< the lamp is high enough to throw one.
  bool on_board = false;
  bool unblocked = false;  ///< the apex sees the lamp.
  bool visible = false;    ///< on the board, unblocked, in the image and not hidden by a cone.
};

/// One entry per cone of the robot's board, in its order; none for a robot without a board. The renderer stands at `state`.
std::vector<ProbeShadow> probe_shadows(Renderer& renderer, const SceneState& state, const Pose& X_WC, int robot,
                                       int lamp);

}  // namespace cgsr::sim
