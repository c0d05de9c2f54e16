#pragma once

#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/localization/expected.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/render/depth_raster.h"

namespace cgsr::mapping {

/// The map as images are expected to show it (4.1), where its corners are when this is made.
class MapView {
 public:
  /// \param map  outlives it.  \param camera  without lens.
  MapView(const ElasticMap& map, const geometry::Camera& camera, const RefineParameters& parameters);

  /// \return the pieces of edges in view from X_WC, in the image, until the next look.
  const localization::ExpectedView& look(const geometry::Pose& X_WC);

 private:
  geometry::Camera camera_;
  render::DepthRaster raster_;
  localization::ExpectedView expected_;
  std::vector<render::VisiblePiece> visible_;
};

}  // namespace cgsr::mapping
