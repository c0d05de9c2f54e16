#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/adjust.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/observe.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// A map after refine().
struct Refined {
  std::vector<Eigen::Vector3d> corners;  ///< of ElasticMap, W [m].
  std::vector<double> sigma_m;           ///< of each, the mean over the axes.
  std::vector<int> observations;         ///< matches that hold each.
  Observed observed;                     ///< what the images say of the refined map.
};

/// Moves a map's corners, and the views' poses, until what the images show lies where the map expects it: matching and adjustment alternate with
/// a radius that shrinks. Nothing is removed. The map ends where the corners do. Ours, on 4.1 and 4.2.
/// \param camera  in which the views' edges are, without lens.  \param progress  told each round.
Refined refine(ElasticMap& map, std::span<View> views, const geometry::Camera& camera,
               const RefineParameters& parameters, const std::function<void(int, const Adjusted&)>& progress = {});

}  // namespace cgsr::mapping
