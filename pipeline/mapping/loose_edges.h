#pragma once

#include <span>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/localization/segment_table.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// Perceived edges of every view that run along no edge of the map. Ours.
/// \param map, views  after refine().  \param min_length_px  shorter ones are left out.
std::vector<std::vector<localization::PerceivedEdge>> loose_edges(const ElasticMap& map, std::span<const View> views,
                                                                  const geometry::Camera& camera,
                                                                  const ProposeParameters& parameters,
                                                                  const RefineParameters& refined_with,
                                                                  float min_length_px);

}  // namespace cgsr::mapping
