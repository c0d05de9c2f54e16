#pragma once

#include <Eigen/Core>

#include "pipeline/render/expectation.h"
#include "pipeline/render/view.h"

namespace cgsr::render {

/// A corner of the map as the camera has it.
struct ViewedCorner {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();   ///< homogeneous cells of the view's raster: (u Z, v Z, Z).
  Eigen::Vector2f at = Eigen::Vector2f::Zero();  ///< (u, v); unset behind the near plane.
  float w = 0.0F;                                ///< 1/Z, 1/m; 0: behind the near plane.

  void set(const Eigen::Vector3f& homogeneous, float near_m) {
    p = homogeneous;
    w = 0.0F;
    if (p.z() >= near_m) {
      w = 1.0F / p.z();
      at = p.head<2>() * w;
    }
  }
};

/// The part of an edge that lies before the near plane and inside of the view, on its raster. Places s in [0, 1] along it are places in the
/// image: 1/Z and cells are linear in s, places on the edge itself are not. Clipping and projection: section 2.2.
struct EdgeLine {
  Eigen::Vector2f from = Eigen::Vector2f::Zero();  ///< cells.
  Eigen::Vector2f along = Eigen::Vector2f::Zero();
  float w0 = 0.0F;  ///< 1/Z at s = 0.
  float dw = 0.0F;
  float t0 = 0.0F;  ///< where on the edge s = 0 and s = 1 are.
  float t1 = 1.0F;

  /// \param min_w  what has less inverse depth is too far away.  \return false: nothing of the edge is in view.
  bool set(const ViewedCorner& a, const ViewedCorner& b, const View& view, float near_m, float min_w = 0.0F);

  [[nodiscard]] VisiblePiece piece(std::uint32_t edge, float begin, float end, const View& view) const;
};

}  // namespace cgsr::render
