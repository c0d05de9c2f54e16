#include "pipeline/stages/track_stage.h"

#include "pipeline/stages/ball_track.h"

namespace cgsr::stages {

TrackedObjects TrackStage::update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                                  const runtime::Aged<color::SearchResult>& matches,
                                  const runtime::Aged<ShadowMasks>& shade, const Requests& requests) {
  last_.count = 1;
  last_.tracks.front() = {};
  if (!requests.track) return last_;
  if (auto* const ball = std::get_if<color::IntegratedTracker>(&tracker_)) {
    last_.tracks.front() = track_ball(*ball, image, shade, budget);
    return last_;
  }
  auto& tracker = std::get<color::Tracker>(tracker_);
  const View* const now = view.within(Duration::zero());
  if (now != nullptr && now->reduced) {
    const auto* const found = matches.within(kMaxMatchesAge);
    color::SearchResult known = found != nullptr ? *found : color::SearchResult{};
    known.of_this_image = matches.within(Duration::zero()) != nullptr;
    last_.tracks.front().object = tracker.track(image, *now->reduced, known, budget);
  }
  last_.next_search = tracker.search_size();
  return last_;
}

TrackedObjects TrackStage::place(const ImageView& image, const View& view, const Box& box) {
  if (auto* const tracker = std::get_if<color::Tracker>(&tracker_); tracker != nullptr && view.reduced) {
    tracker->place(image, *view.reduced, box);
    last_.next_search = tracker->search_size();
  }
  return last_;
}

}  // namespace cgsr::stages
