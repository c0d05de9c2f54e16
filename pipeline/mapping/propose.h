#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// A straight edge that many images show and the map does not hold: for a person to accept.
struct Proposal {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< its ends, W [m].
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int images = 0;             ///< that support it.
  double rms_px = 0.0;        ///< of the perceived edges against it.
  std::size_t best_view = 0;  ///< index of the view that shows most of it.
  std::string part = {};  ///< of the map, that was moved: the line is an edge of it; empty: the map does not hold it.
};

/// Finds edges that the map lacks: perceived edges that no edge of the map explains, in two images a line in space (the planes through both cameras
/// meet there), kept where enough other images show it too, from directions that differ. Of lines that support one another the one with most images
/// stays. Shadows' edges and patterns that keep still are proposed too: a person tells them apart. Ours.
/// \param map, views  after refine().  \return the ones with most images first.
std::vector<Proposal> propose_edges(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                                    const ProposeParameters& parameters, const RefineParameters& refined_with);

}  // namespace cgsr::mapping
