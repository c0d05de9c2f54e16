#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping {

/// What adjust() found.
struct Adjusted {
  bool solved = false;
  double cost_before = 0.0;  ///< sum of robust squared residuals in sigmas, halved.
  double cost_after = 0.0;
  std::vector<double> sigma_m;  ///< of each corner, the mean over the axes; empty where it was not asked for.
};

/// Bundle adjustment over edges: moves corners and poses to where the matched lines, the given poses, the odometry, and what is known of the map
/// (each part's place, its shape, what lies on what) fit together best. By Ceres (Agarwal, Mierle and others), which needs heap and seconds: not
/// for the frame path. The distances are those of Eq. 4.1; a map's own corners as unknowns beside the poses are ours.
///
/// \param corners  in W, metres: from where it begins, and where it ends.  \param views  their X_WC likewise.
/// \param with_sigmas  also work out how well each corner is known then.
Adjusted adjust(const ElasticMap& map, std::vector<Eigen::Vector3d>& corners, std::span<View> views,
                std::span<const LineMatch> matches, std::span<const EndMatch> ends, const geometry::Camera& camera,
                const RefineParameters& parameters, bool with_sigmas);

}  // namespace cgsr::mapping
