#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/stages/search_stage.h"
#include "pipeline/stages/track_stage.h"
#include "platform/error.h"
#include "platform/work_budget.h"

namespace cgsr::stages {

/// Chapter 3's three stages for one object (Alg. 3.2).
struct ColorStages {
  std::unique_ptr<DecodeStage> decode;
  std::unique_ptr<SearchStage> search;
  std::unique_ptr<TrackStage> track;

  /// \param max_width_px, max_height_px  the largest camera image that will come.
  /// \return an error in words: a defective model, or parameters that cannot be.
  static Result<ColorStages> make(const color::ColorModel& model, const color::TrackParameters& parameters,
                                  int max_width_px, int max_height_px);
};

/// Chapter 3 alone, image after image: decode, search and track without a schedule, each measured by tools/count.
///
/// Threads: one. After make nothing here allocates.
class ColorLoop {
 public:
  static Result<ColorLoop> make(const color::ColorModel& model, const color::TrackParameters& parameters,
                                int max_width_px, int max_height_px);

  /// Says where the object is in an image that is not tracked: the one that it was learned from.
  /// \return false when the image cannot be reduced.
  bool place(const ImageView& image, const Box& box);

  /// \param search_budget, track_budget  for the units of the two stages.
  color::TrackedObject track(const ImageView& image, WorkBudget& search_budget, WorkBudget& track_budget);
  /// The same within the units of the stages' own rows (kRow), as a robot has them; mode plain searches exactly, whatever that takes.
  color::TrackedObject track(const ImageView& image);

 private:
  ColorLoop(ColorStages stages, std::uint32_t search_units) : stages_(std::move(stages)), search_units_(search_units) {}

  ColorStages stages_;
  std::uint32_t search_units_;
  runtime::Aged<TrackedObjects> objects_;
  runtime::Aged<color::SearchResult> matches_;
};

}  // namespace cgsr::stages
