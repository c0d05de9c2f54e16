#pragma once

#include <optional>
#include <string_view>

#include "pipeline/imaging/reduce.h"
#include "pipeline/runtime/schedule.h"
#include "platform/image_view.h"
#include "platform/pool.h"

namespace cgsr::stages {

/// What the stages after decode read beside the camera's image: its grey and colour labels.
struct View {
  Lease<imaging::ReducedImage> reduced;  ///< empty: the image could not be reduced (not YUYV, too large).

  /// The grey plane, of the reduced image's size.
  [[nodiscard]] ImageView grey() const;
};

/// Camera image to grey and colour labels, in one pass (imaging::reduce). Ours: the dissertation (Fig. 5.1)
/// forwards the image frames themselves to its components.
///
/// Threads: one. After construction nothing here allocates.
class DecodeStage {
 public:
  using Output = View;
  static constexpr std::string_view kName = "decode";
  static constexpr std::string_view kMeaning = "Camera image to grey and colour labels.";
  static constexpr runtime::StageParameters kRow{1, 0, 3000, 1, runtime::OnOverrun::kStopMotion};

  struct Setup {
    int max_width_px = 0;  ///< the largest image that will come.
    int max_height_px = 0;
    imaging::LabelTable labels;  ///< of the object that is looked for; empty: none, all labels are 0.
    std::optional<double> object_shorter_side_px{};  ///< of that object; none: whatever is in the image counts.
  };
  explicit DecodeStage(Setup setup);

  Output update(const ImageView& image);

 private:
  imaging::LabelTable labels_;
  std::optional<double> object_shorter_side_px_;
  Pool<imaging::ReducedImage> images_;
};

}  // namespace cgsr::stages
