#pragma once

#include <span>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// What all images together say of the map as it is.
struct Observed {
  std::vector<LineMatch> matches;
  std::vector<EdgeSeen> edges;               ///< of the map, by its index.
  std::vector<std::vector<bool>> explained;  ///< of every view's perceived edges: an edge of the map runs there.
};

/// Matches what every image shows with what the map lets expect there: chapter 4's expectation (4.2) and matching (4.1) from the poses that are
/// believed now. \param camera  in which the views' edges are, without lens.  \param radius_px  of a match.
Observed observe(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                 const RefineParameters& parameters, float radius_px);

}  // namespace cgsr::mapping
