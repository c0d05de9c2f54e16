#pragma once

#include <optional>
#include <string_view>

#include "pipeline/color/track/object_search.h"
#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/tracked_objects.h"
#include "platform/work_budget.h"

namespace cgsr::stages {

/// Chapter 3's search (Alg. 3.2): the windows of the whole image that look most like the object.
///
/// Threads: one. After construction nothing here allocates.
class SearchStage {
 public:
  using Output = color::SearchResult;
  static constexpr std::string_view kName = "search";
  static constexpr std::string_view kMeaning = "Windows that look like the object, in the whole image (Alg. 3.2).";
  static constexpr runtime::StageParameters kRow{1, 0, 7500, 200, runtime::OnOverrun::kSkip};

  /// \param first_size  with which the first image is searched: the tracker's search_size().
  /// \param min_rest_confidence  color::TrackParameters::min_rest_confidence.
  SearchStage(color::ObjectSearch search, const color::SearchSize& first_size, double min_rest_confidence)
      : search_(std::move(search)), first_size_(first_size), min_rest_confidence_(min_rest_confidence) {}

  /// \param view  of this image. \param objects  as the last image left them: they say which window size to search with.
  /// \return nothing: the object is followed surely and the last image was searched, whose windows stay for now.
  std::optional<Output> update(WorkBudget& budget, const runtime::Aged<View>& view,
                               const runtime::Aged<TrackedObjects>& objects);

 private:
  color::ObjectSearch search_;
  color::SearchSize first_size_;
  double min_rest_confidence_;
  bool rests_ = false;  ///< the last image was not searched.
};

}  // namespace cgsr::stages
