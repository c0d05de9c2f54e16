#include "pipeline/stages/color_stages.h"

#include "pipeline/runtime/stage_budget.h"
#include "platform/count_marks.h"

namespace cgsr::stages {
namespace {

template <class Output>
runtime::Aged<Output> fresh(Output output) {
  return {std::move(output), {}, Duration::zero()};
}

constexpr Duration kImagePeriod = seconds(1.0 / 30.0);  // nobody says when the images were taken

}  // namespace

Result<ColorStages> ColorStages::make(const color::ColorModel& model, const color::TrackParameters& parameters,
                                      int max_width_px, int max_height_px) {
  auto search = color::ObjectSearch::create(model, parameters, max_width_px, max_height_px);
  if (!search) return tl::unexpected(search.error());
  auto tracker = color::Tracker::create(model, parameters, max_width_px, max_height_px);
  if (!tracker) return tl::unexpected(tracker.error());
  ColorStages stages;
  stages.decode = std::make_unique<DecodeStage>(
      DecodeStage::Setup{max_width_px, max_height_px, search->labels(), search->object_shorter_side_px()});
  const color::SearchSize first = tracker->search_size();
  stages.search = std::make_unique<SearchStage>(std::move(*search), first, parameters.min_rest_confidence);
  stages.track = std::make_unique<TrackStage>(std::move(*tracker));
  return stages;
}

Result<ColorLoop> ColorLoop::make(const color::ColorModel& model, const color::TrackParameters& parameters,
                                  int max_width_px, int max_height_px) {
  auto stages = ColorStages::make(model, parameters, max_width_px, max_height_px);
  if (!stages) return tl::unexpected(stages.error());
  const bool plain = parameters.mode == color::TrackMode::kPlain;
  return ColorLoop(std::move(*stages), plain ? runtime::StageBudget::kAll : SearchStage::kRow.units);
}

bool ColorLoop::place(const ImageView& image, const Box& box) {
  const View view = stages_.decode->update(image);
  if (!view.reduced) return false;
  objects_ = fresh(stages_.track->place(image, view, box));
  return true;
}

color::TrackedObject ColorLoop::track(const ImageView& image, WorkBudget& search_budget, WorkBudget& track_budget) {
  count_stage_begin();
  const auto view = fresh(stages_.decode->update(image));
  count_stage_end(DecodeStage::kName.data());
  count_stage_begin();
  if (const auto matches = stages_.search->update(search_budget, view, objects_)) {
    matches_ = fresh(*matches);
  } else {
    matches_.age = kImagePeriod;
  }
  count_stage_end(SearchStage::kName.data());
  count_stage_begin();
  objects_ = fresh(stages_.track->update(track_budget, image, view, matches_, {}, {}));
  count_stage_end(TrackStage::kName.data());
  return objects_.value.first().object;
}

color::TrackedObject ColorLoop::track(const ImageView& image) {
  auto search_budget = runtime::StageBudget::of_units(search_units_);
  auto track_budget = runtime::StageBudget::of_units(TrackStage::kRow.units);
  return track(image, search_budget, track_budget);
}

}  // namespace cgsr::stages
