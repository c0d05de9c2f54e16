#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/imaging/segments.h"
#include "pipeline/localization/correction.h"
#include "pipeline/localization/segment_table.h"
#include "platform/image_view.h"

namespace cgsr::localization {

/// \return the camera in whose size Perception works: half of a large one's.
geometry::Camera working_camera(const geometry::Camera& camera);

/// The perception module (4.1): an image to straight edges without the lens.
class Perception {
 public:
  static constexpr std::size_t kMostSegments = 1000;

  /// \param camera  with its lens, in the size of whole images.
  explicit Perception(const geometry::Camera& camera);

  /// Camera of the working image, without lens: what perceived edges and expectations are in.
  [[nodiscard]] const geometry::Camera& camera() const { return plain_; }

  /// \param image  kYuyv or kGrey8, of the camera's size or of the working size.  \param mask  as SegmentFinder's; may be null.
  /// \return kNone, or why there are next to no edges: kWrongSize, kTooDark, kTooBright, kTooFewEdges.
  Reason perceive(const ImageView& image, const std::uint8_t* mask);

  [[nodiscard]] const SegmentTable& edges() const { return table_; }

 private:
  [[nodiscard]] bool make_grey(const ImageView& image);
  [[nodiscard]] Reason cause_of_few() const;

  geometry::Camera full_;
  geometry::Camera working_;
  geometry::Camera plain_;
  std::vector<std::uint8_t> grey_;
  const std::uint8_t* plane_ = nullptr;
  std::ptrdiff_t stride_ = 0;
  imaging::SegmentFinder finder_;
  SegmentTable table_;
};

}  // namespace cgsr::localization
