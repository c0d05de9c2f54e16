#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"

namespace cgsr::lab {

/// The middle of a map's bounding box.
Eigen::Vector3d centre_of(const world::Map& map);

/// How well a pose fits a picture, by a few lines that know nothing of any tracker: the distances of a body's visible edges, every
/// 5 px and by exact rays, to the nearest Canny edge within 20 degrees of their direction. [px], at most 20.
std::vector<double> distances_to_canny(const cv::Mat& grey, const world::Map& map, const geometry::Camera& camera,
                                       const geometry::Pose& X_WC);

/// What that says of a film.
struct CannyTally {
  std::vector<double> medians;  ///< an image each
  int followed = 0;             ///< images whose median is at most 2 px and 80 % of whose edges are within 3 px
  int near = 0;                 ///< places within 3 px ...
  int places = 0;               ///< ... of all

  void add(std::vector<double> distances_px);
};

}  // namespace cgsr::lab
