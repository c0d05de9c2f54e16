#pragma once

#include "pipeline/color/search/window_search.h"
#include "pipeline/color/track/tracker.h"

namespace cgsr::color {

/// Alg. 3.2: the windows of a whole image that are nearest to the histograms of a learned object, wherever it was before.
///
/// Threads: one. Memory is reserved by create; search never allocates.
class ObjectSearch {
 public:
  /// \param max_width_px, max_height_px  the largest camera image that will come.
  static Result<ObjectSearch> create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                     int max_height_px);

  /// The table to reduce images with (imaging::reduce).
  [[nodiscard]] const imaging::LabelTable& labels() const { return search_.labels(); }
  /// The shorter side of the learned object [px], by which the reduction of an image is chosen (imaging::reduction_for).
  [[nodiscard]] double object_shorter_side_px() const { return shorter_side_px_; }

  /// \param reduced  reduced with labels(). \param size  of the middle windows: what the tracker asks for. \param budget  asked once per unit.
  /// \return the best windows first; none when no window fits into the image.
  SearchResult search(const imaging::ReducedImage& reduced, const SearchSize& size, WorkBudget& budget);

 private:
  ObjectSearch(WindowSearch search, const TrackParameters& parameters, double shorter_side_px);

  WindowSearch search_;
  double max_divergence_;
  int candidates_;
  double shorter_side_px_;
};

}  // namespace cgsr::color
