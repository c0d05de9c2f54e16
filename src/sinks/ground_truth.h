#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include "platform/box.h"
#include "platform/description.h"

namespace cgsr::sinks {

struct ImageReport;

/// What a judge knows of the image at hand, for those who write or draw it. Only simulated runs have one.
struct GroundTruth {
  std::optional<Box> box;                ///< of the object, where it is seen.
  std::optional<double> camera_off_m;    ///< error of the estimated camera pose: its position,
  std::optional<double> camera_off_deg;  ///< and its direction, the whole rotation.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("camera_off_m", self.camera_off_m, {4}, "m", "error of the estimated camera's position by truth");
    visit.number("camera_off_deg", self.camera_off_deg, {3}, "deg", "error of its direction, the whole rotation");
  }
};

/// A drawing beside the overlay of each image.
class SidePicture {
 public:
  virtual ~SidePicture() = default;
  /// Of every drawing.
  [[nodiscard]] virtual cv::Size picture_size() const = 0;
  /// \return the drawing, B G R; valid until the next call.
  virtual const cv::Mat& draw(const ImageReport& report) = 0;
};

}  // namespace cgsr::sinks
