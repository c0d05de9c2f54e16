#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/render/expectation.h"
#include "pipeline/world/map.h"
#include "platform/image_view.h"

namespace cgsr::app {

/// Draws an image with the visible edges of the map over it, as they should be seen from a pose, and a line of text below. Not for the frame
/// path.
class MapOverlay {
 public:
  /// \param map, expectation  outlive it.
  MapOverlay(const world::Map& map, render::Expectation& expectation, const geometry::Camera& camera);

  [[nodiscard]] cv::Size picture_size() const;

  /// \param X_WC  nothing: it is not known, and no edges are drawn.  \param sure  false: the pose is a prediction, the words are red.
  /// \return the picture, B G R; valid until the next call.
  const cv::Mat& draw(const ImageView& image, const std::optional<geometry::Pose>& X_WC, bool sure,
                      const std::string& words);

 private:
  const world::Map& map_;
  render::Expectation& expectation_;
  geometry::Camera camera_;
  std::vector<render::VisiblePiece> pieces_;
  cv::Mat picture_;
};

}  // namespace cgsr::app
