#pragma once

#include <string_view>

#include "pipeline/runtime/aged.h"
#include "pipeline/runtime/schedule.h"
#include "pipeline/stages/decode_stage.h"
#include "platform/description.h"

namespace cgsr::stages {

/// How bright an image is as a whole.
struct Brightness {
  bool known = false;  ///< false: the image could not be decoded.
  double mean = 0.0;   ///< of the encoded luma, 0 (black) to 1 (white).

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("mean_brightness", when(self.known, self.mean), {3}, "",
                 "mean of the encoded luma of the image, 0 is black and 1 is white");
  }
};

/// Measures the mean brightness of every image. An example of a stage, in no shipped robot (docs/guides/add-a-stage.md). Ours.
///
/// Threads: one. Nothing here allocates. Cost: an addition per pixel of the decoded image.
class BrightnessStage {
 public:
  using Output = Brightness;
  static constexpr std::string_view kName = "brightness";
  static constexpr std::string_view kMeaning = "Mean brightness of the image.";
  static constexpr runtime::StageParameters kRow{1, 0, 500, 0, runtime::OnOverrun::kSkip};

  /// \param view  of this image; of an older one nothing is said.
  Output update(const runtime::Aged<View>& view);
};

}  // namespace cgsr::stages
