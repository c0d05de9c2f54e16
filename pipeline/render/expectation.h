#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"

namespace cgsr::render {

/// A piece of a map's edge that the camera should see: glCorrect's expectation (4.2).
struct VisiblePiece {
  std::uint32_t edge = 0;  ///< id: index in Map::edges.
  float from = 0.0F;       ///< where on the edge it begins and ends: 0 at vertices[0], 1 at vertices[1]; from < to.
  float to = 1.0F;
  Eigen::Vector2f p0 =
      Eigen::Vector2f::Zero();  ///< pixel of `from` in a camera without lens (Camera::without_distortion).
  Eigen::Vector2f p1 = Eigen::Vector2f::Zero();  ///< pixel of `to`.
};

/// Which pieces of the map's edges are visible from a pose. Two implementations answer alike: DepthRaster (the budget path, own z-buffer) and
/// OsmesaExpectation (OpenGL). Both are made for one map, which outlives them; after construction nothing allocates in DepthRaster.
class Expectation {
 public:
  Expectation() = default;
  Expectation(const Expectation&) = delete;
  Expectation& operator=(const Expectation&) = delete;
  virtual ~Expectation() = default;

  /// \param camera  its lens is left out: pieces are straight. Its size is that of the answer's pixels; what is rasterised inside may be
  ///        smaller. \param pieces  cleared and filled, in the order of edges, each edge's pieces in the order of `from`; never beyond its
  ///        capacity in the frame path (longest and nearest first when there are more).
  virtual void look(const geometry::Pose& X_WC, const geometry::Camera& camera, std::vector<VisiblePiece>& pieces) = 0;

  /// Did the last look see something of the map at a pixel of its camera? What lies beside the map nobody can expect. True where it is not known.
  [[nodiscard]] virtual bool covers(const Eigen::Vector2f& /*pixel*/) const { return true; }
};

}  // namespace cgsr::render
