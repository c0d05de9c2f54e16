#include "pipeline/color/track/tracker.h"

#include <utility>

#include "pipeline/color/track/tracker_state.h"

namespace cgsr::color {

Result<Tracker> Tracker::create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                int max_height_px) {
  if (parameters.mode == TrackMode::kFull && model.samples.empty()) {
    return fail("the colour model keeps no picture of the object, which mode \"full\" needs: learn it again");
  }
  return Tracker(std::make_unique<State>(model, parameters, max_width_px, max_height_px));
}

Tracker::Tracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

SearchSize Tracker::search_size() const {
  return state_->search_size();
}

void Tracker::place(const ImageView& image, const imaging::ReducedImage& reduced, const Box& box) {
  State& s = *state_;
  s.pyramid.build(image);
  s.local.begin(s.pyramid, box);
  s.keep_colors(view_object(s.pyramid, box));
  s.image_quantiles = channel_quantiles(view_image(s.pyramid));
  s.light.begin({1.0, 1.0, 1.0}, s.image_quantiles, s.learned_quantiles);
  s.illuminant.begin({1.0, 1.0, 1.0}, s.image_quantiles);
  const Place itself = s.look(reduced, box);
  s.first_score = itself.local.score;
  s.mean_score = s.parameters.doubt.min_found_score * s.first_score;  // it fits no other image as well as its own
  s.mean_divergence = itself.divergence;
  s.confidence.reset();
  s.box = box;
  s.located = true;
  s.images_since_sight = 0;
  s.lost = false;
  s.presence.confirm();
  s.clutter.reset();
  s.images_since_beside = 0;
  s.foreign_images = 0;
  s.images_lost = 0;
}

TrackedObject Tracker::track(const ImageView& image, const imaging::ReducedImage& reduced, const SearchResult& matches,
                             WorkBudget& budget) {
  State& s = *state_;
  if (s.parameters.mode == TrackMode::kPlain) return s.track_plain(matches);
  s.pyramid.build(image);
  return s.track_full(reduced, matches, budget);
}

}  // namespace cgsr::color
