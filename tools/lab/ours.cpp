#include "tools/lab/ours.h"

#include <array>
#include <optional>

#include "pipeline/imaging/reduce.h"
#include "platform/count_marks.h"

namespace cgsr::lab {
namespace {

class OurTracker final : public BoxTracker {
 public:
  OurTracker(const config::Color& configuration, Start start) : configuration_(configuration), start_(start) {}

  Result<void> learn(const Image& image, const Box& box) override {
    const std::array samples{color::Sample{image.view(), box}};
    const auto learned = color::learn(samples, configuration_.learn);
    if (!learned) return tl::unexpected(learned.error());
    auto tracker = color::Tracker::create(learned->model, configuration_.track, image.bgr.cols, image.bgr.rows);
    if (!tracker) return tl::unexpected(tracker.error());
    tracker_ = std::move(*tracker);
    reduced_.emplace(image.bgr.cols, image.bgr.rows);
    if (start_ == Start::kAnywhere) return {};
    if (!reduce(image.view())) return fail("the image is none that can be reduced");
    tracker_->place(image.view(), *reduced_, box);
    return {};
  }

  Sighting track(const Image& image) override {
    const ImageView view = image.view();
    count_stage_begin();
    const bool reduced = reduce(view);
    count_stage_end("labels");
    if (!reduced) return {};
    UnlimitedBudget budget;
    count_stage_begin();
    const color::SearchResult matches = tracker_->search(*reduced_, budget);
    count_stage_end("search");
    count_stage_begin();
    const color::TrackedObject object = tracker_->track(view, *reduced_, matches, budget);
    count_stage_end("track");
    if (!object.found) return {};
    return {object.box, object.light, object.exact_light, object.divergence};
  }

 private:
  bool reduce(const ImageView& view) {
    const int factor = tracker_->reduction(view.width_px, view.height_px);
    return imaging::reduce(view, factor, tracker_->labels(), *reduced_).has_value();
  }

  config::Color configuration_;
  Start start_;
  std::optional<color::Tracker> tracker_;
  std::optional<imaging::ReducedImage> reduced_;
};

}  // namespace

std::unique_ptr<BoxTracker> make_ours(const config::Color& configuration, Start start) {
  return std::make_unique<OurTracker>(configuration, start);
}

std::unique_ptr<BoxTracker> make_plain(const config::Color& configuration, Start start) {
  config::Color plain = configuration;
  plain.track.mode = color::TrackMode::kPlain;
  return std::make_unique<OurTracker>(plain, start);
}

}  // namespace cgsr::lab
