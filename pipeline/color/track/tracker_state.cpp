// From image to image: Tracker::State::track_full is what is believed of each.
#include "pipeline/color/track/tracker_state.h"

#include <algorithm>

#include "pipeline/color/track/tracker_boxes.h"

namespace cgsr::color {

/// Until an image is there in which the object was learned, the patch that the model keeps of it has to do.
void Tracker::State::learn_from_model() {
  box = {0.0, 0.0, model.width_px, model.height_px};
  if (model.samples.empty()) return;
  const SamplePatch& sample = model.samples.front();
  imaging::Pyramid patch(sample.width_px, sample.height_px);
  patch.build(sample.view());
  local.begin(patch, sample.window);
  keep_colors(view_object(patch, sample.window));
  learned_light = sample.light;
  const LocalAnswer itself = local.look(patch, sample.window);
  first_score = itself.score;
  mean_score = first_score;
}

void Tracker::State::keep_colors(const ObjectView& view) {
  learned_quantiles = channel_quantiles(view);
  learned_amounts = ColorAmounts(view);
}

SearchSize Tracker::State::search_size() const {
  if (parameters.mode == TrackMode::kPlain) return {model.width_px, model.height_px};
  if (located) return {box.width, box.height};
  return {model.width_px * lost_scale(), model.height_px * lost_scale()};
}

TrackedObject Tracker::State::track_plain(const SearchResult& matches) const {
  if (matches.count == 0) return {};
  const Match& best = matches.matches.front();
  const Light light = model.lights[static_cast<std::size_t>(best.light)];
  return {true, best.box, best.divergence, light, light};
}

/// The whole image is searched in any case. Where the object was, the local tracker says how it moved; what it says is doubted by three
/// measures together, and then it is looked for at the search's best windows, as it looked last and as it was learned: a prior, not a cage.
TrackedObject Tracker::State::track_full(const imaging::ReducedImage& reduced, const SearchResult& matches,
                                         WorkBudget& budget) {
  Place place;
  bool sure = false;
  if (!located) {
    const SearchSize size = search_size();
    box = centred_on(box, size.width_px, size.height_px);
  }
  if (located && !lost()) {
    local.follow_light(pyramid);
    place = look(reduced, box);
    sure = !is_weak(place) || recognise(reduced, matches, budget, place) || find(reduced, matches, budget, place);
    weak_images = sure ? 0 : weak_images + 1;
    if (lost()) return {};
  } else {
    sure = (located && (stayed(reduced, place) || recognise(reduced, matches, budget, place))) ||
           find(reduced, matches, budget, place);
    if (!sure) {
      ++images_lost;
      return {};
    }
    located = true;
    images_lost = 0;
    weak_images = 0;
    max_foreign_images = 0;
  }

  Box now = place.local.box;
  if (sure) now = grown(now, local.growth(pyramid, now), model, parameters.max_size_ratio);
  box = with_centre_inside(now, pyramid.width_px(), pyramid.height_px());
  const Tint seen = tint(box);
  max_foreign_images = seen.agreement < parameters.doubt.min_agreement ? max_foreign_images + 1 : 0;
  if (max_foreign_images >= parameters.doubt.max_foreign_images) {
    start_again();
    return {};
  }
  if (sure) {
    local.learn(pyramid, box);
    const double rate = images_since_sight < parameters.doubt.warm_up_images ? 0.3 : parameters.doubt.mean_rate;
    mean_score += rate * (place.local.score - mean_score);
    mean_divergence += rate * (place.divergence - mean_divergence);
  }
  ++images_since_sight;
  local.remember(pyramid, box);
  return answer(seen.gain, place.divergence);
}

/// What the local tracker followed was not the object: it forgets what it learned from it.
void Tracker::State::start_again() {
  local.forget();
  located = false;
  box = centred_on(box, model.width_px, model.height_px);
  mean_score = first_score;
  mean_divergence = first_divergence;
}

TrackedObject Tracker::State::answer(const Light& gain, double divergence_of_box) const {
  const Light exact = lit(learned_light, gain);
  const Box image{0.0, 0.0, static_cast<double>(pyramid.width_px()), static_cast<double>(pyramid.height_px())};
  return {true, intersection(box, image), divergence_of_box, nearest_of(model, exact), exact};
}

}  // namespace cgsr::color
