#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/propose.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// A part that the images do not show where the map has it, and show somewhere else.
struct MovedPart {
  std::uint32_t part = 0;  ///< index into ElasticMap::parts().
  Eigen::Vector3d shift =
      Eigen::Vector3d::Zero();  ///< from where it was measured, W [m]; along the floor if it stands there.
  double share_here = 0.0;      ///< of its edges that images should show, which they show: where the map has it,
  double share_there = 0.0;     ///< and there, as seen there, with what hides it.
  int images = 0;               ///< that show some of it there.
  std::vector<Proposal> edges;  ///< those of its edges that images show there: for a person to accept.
};

/// Looks for pieces of furniture that stand elsewhere: each part that fits badly at its place is tried, as it was measured, over a grid along the floor (and
/// up and down unless it stands there) against what was perceived, all images together, what other parts explain counting half; at the best places it is put into the map for a check with what hides it there. Not turned. Ours.
/// \param map, views  after refine(); the map is left as it was.
std::vector<MovedPart> find_moved_parts(ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                                        const RefineParameters& refined_with);

}  // namespace cgsr::mapping
