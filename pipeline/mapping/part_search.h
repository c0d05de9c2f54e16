#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/observe.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// Where each part of the map fits the images best when it is moved as a whole: tried on a grid, along the floor, then up and down unless it
/// stands on the floor, all images that see it together. One image matches an edge with the nearest line that could be it; which of several is
/// the right one is what all images agree on. Ours.
///
/// \param owners  whose the perceived edges are: what another part explains counts half. Empty: nobody's.
/// \param sharpness_px  how far off a line counts half: as far as the poses are off.
/// \return for every part how far it is moved, W [m]; zero where nothing else fits clearly better.
std::vector<Eigen::Vector3d> search_parts(const ElasticMap& map, std::span<const View> views,
                                          const geometry::Camera& camera, const RefineParameters& parameters,
                                          const Owners& owners, double sharpness_px);

}  // namespace cgsr::mapping
