#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// Of every view's perceived edges the part of the map whose edge it is, by index; -1: none's.
using Owners = std::vector<std::vector<std::int64_t>>;

/// How far off an edge of the map, at most, a perceived edge lies that this surely explains, once the poses have settled.
inline constexpr float kExplained_px = 3.0F;
/// How much of a perceived edge that another part explains counts for a part that is looked for.
inline constexpr double kOthersShare = 0.5;

/// What all images together say of the map as it is.
struct Observed {
  std::vector<LineMatch> matches;
  std::vector<EndMatch> ends;                      ///< of those that end at a corner of the map.
  std::vector<EdgeSeen> edges;                     ///< of the map, by its index.
  std::vector<std::vector<std::int64_t>> edge_at;  ///< of every view's perceived edges: the map's edge nearest to it of
                                                   ///< those that it was matched with; -1: none.
};

/// Matches what every image shows with what the map lets expect there: chapter 4's expectation (4.2) and matching (4.1) from the poses that are
/// believed now. \param camera  in which the views' edges are, without lens.  \param radius_px  of a match.
Observed observe(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                 const RefineParameters& parameters, float radius_px);

/// Whose edges the perceived ones are.
Owners owners_of(const ElasticMap& map, const Observed& observed);

}  // namespace cgsr::mapping
