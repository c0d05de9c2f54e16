#pragma once

#include <string_view>
#include <variant>

#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/requests.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/tracked_objects.h"

namespace cgsr::stages {

/// Which of the search's windows the object is, and the box that fits (chapter 3); or a ball, bright everywhere and dark where there may be
/// shade (5.3).
///
/// Threads: one. After construction nothing here allocates.
class TrackStage {
 public:
  using Output = TrackedObjects;
  static constexpr std::string_view kName = "track";
  static constexpr std::string_view kMeaning =
      "Which of the windows the object is, and the box that fits (chapter 3, 5.3).";
  static constexpr runtime::StageParameters kRow{1, 0, 5500, 4, runtime::OnOverrun::kSkip};
  static constexpr Duration kMaxMatchesAge = seconds(0.2);  ///< of the search's windows that are used.

  explicit TrackStage(color::Tracker tracker) : tracker_(std::move(tracker)) {}
  explicit TrackStage(color::IntegratedTracker tracker) : tracker_(std::move(tracker)) {}

  /// \param view  of this image. \param requests  of the last image: whether the object is to be looked for at all.
  Output update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                const runtime::Aged<color::SearchResult>& matches, const runtime::Aged<ShadowMasks>& shade,
                const Requests& requests);

  /// Says where the object is in an image that is not looked at otherwise: the one that it was learned from.
  Output place(const ImageView& image, const View& view, const Box& box);

 private:
  std::variant<color::Tracker, color::IntegratedTracker> tracker_;
  TrackedObjects last_;
};

}  // namespace cgsr::stages
