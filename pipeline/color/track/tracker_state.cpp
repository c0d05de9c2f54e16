// From image to image: Tracker::State::track_full is what is believed of each.
#include "pipeline/color/track/tracker_state.h"

#include <algorithm>

#include "pipeline/color/track/relight.h"
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
  const LocalAnswer itself = local.look(patch, sample.window, {1.0, 1.0, 1.0});
  first_score = itself.score;
  mean_score = first_score;
}

void Tracker::State::keep_colors(const ObjectView& view) {
  learned_quantiles = channel_quantiles(view);
  learned_amounts = ColorAmounts(view);
  recent_amounts = learned_amounts;
}

SearchSize Tracker::State::search_size() const {
  if (parameters.mode == TrackMode::kPlain) return {model.width_px, model.height_px};
  if (located && !lost) return {box.width, box.height};
  if (located && images_lost % 2 == 0) return {box.width * lost_scale(), box.height * lost_scale()};
  return {model.width_px * lost_scale(), model.height_px * lost_scale()};
}

TrackedObject Tracker::State::track_plain(const SearchResult& matches) const {
  if (matches.count == 0) return {};
  const Match& best = matches.matches.front();
  const Light its_light = model.lights[static_cast<std::size_t>(best.light)];
  return {true, best.box, best.divergence, its_light, its_light};
}

/// The whole image is searched in any case. Where the object was, the local tracker says how it moved; when all that it measures speaks against
/// the object's presence there, it is looked for at the search's best windows, as it looked last and as it was learned: a prior, not a
/// cage. What was lost is still looked for where it was, or where something went that may be it, and nothing is learned surely meanwhile.
TrackedObject Tracker::State::track_full(const imaging::ReducedImage& reduced, const SearchResult& matches,
                                         WorkBudget& budget) {
  image_quantiles = channel_quantiles(view_image(pyramid));
  light.predict(image_quantiles);
  Place place;
  bool followed = false;
  if (located) {
    if (lost) follow_tentatively(reduced, budget);
    place = look(reduced, box);
    const double log_odds = presence.log_odds(measures_of(place));
    // What is seen again where it was lost may be something of the same shape: its colours have to be the object's, and it has to be more
    // like it than other things are.
    presence.add(lost ? log_odds - clutter.level() : log_odds);
    followed = presence.believed() && (!lost || tint(place.local.box).agreement >= parameters.doubt.min_agreement);
  }
  if (!followed) {
    const bool elsewhere =
        (located && recognise(reduced, matches, budget, place)) || find(reduced, matches, budget, place);
    if (!elsewhere) {
      illuminant.add(image_quantiles, light.change(), std::nullopt);
      if (located && !lost) return lose();
      ++images_lost;
      return {};
    }
    presence.confirm();
  }
  const bool continued = followed && !lost;
  if (!continued) {
    foreign_images = 0;
    clutter.discard_pending();
  }
  located = true;
  lost = false;
  images_lost = 0;

  const Box now = grown(place.local.box, local.growth(pyramid, place.local.box), model, parameters.max_size_ratio);
  box = with_centre_inside(now, pyramid.width_px(), pyramid.height_px());
  const Tint seen = tint(box);
  light.update(seen.quantiles, seen.measured.gain, seen.agreement);
  illuminant.add(image_quantiles, light.change(), seen.measured);
  const ColorAmounts amounts(relit(seen.view, inverse(light.gain())));
  foreign_images = is_foreign(place, seen, amounts) ? foreign_images + 1 : 0;
  if (foreign_images >= parameters.doubt.max_foreign_images) {
    presence.deny();
    return lose();
  }
  learn(place, amounts, continued);
  if (continued && foreign_images == 0) look_beside(reduced, matches, budget);
  ++images_since_sight;
  return answer(place, amounts);
}

/// The object's colours are missing under every light that it may be in: the one that these colours ask for and the followed one; they
/// are not what it has looked like since it was learned either; and the shape does not prove it.
bool Tracker::State::is_foreign(const Place& place, const Tint& seen, const ColorAmounts& amounts) const {
  if (place.local.score >= parameters.doubt.min_sure_score * mean_score) return false;
  return std::max({seen.agreement, learned_amounts.agreement(amounts), recent_amounts.agreement(amounts)}) <
         parameters.doubt.min_agreement;
}

/// Where it was looked for in many places, or followed tentatively, the next image teaches the same and has the time for it.
void Tracker::State::learn(const Place& place, const ColorAmounts& amounts, bool continued) {
  if (continued) local.learn(pyramid, box, light.gain());
  const double rate = images_since_sight < parameters.doubt.warm_up_images ? 0.3 : parameters.doubt.mean_rate;
  mean_score += rate * (place.local.score - mean_score);
  mean_divergence += rate * (place.divergence - mean_divergence);
  // What may be another object is not what it looked like.
  if (foreign_images == 0) recent_amounts.blend(amounts, parameters.doubt.mean_rate);
}

/// Nothing that was learned is forgotten: it may be found again where it was lost, or elsewhere, by what it looked like last or first.
TrackedObject Tracker::State::lose() {
  tentative = local;
  lost_at = box;
  lost = true;
  foreign_images = 0;
  images_lost = 0;
  around = 0;
  light.lose();
  confidence.reset();
  return {};
}

TrackedObject Tracker::State::answer(const Place& place, const ColorAmounts& amounts) {
  const Evidence evidence{place.local.sharpness, learned_amounts.agreement(amounts), place.local.separation()};
  const Box image{0.0, 0.0, static_cast<double>(pyramid.width_px()), static_cast<double>(pyramid.height_px())};
  return {true,
          intersection(box, image),
          place.divergence,
          nearest_of(model, lit(learned_light, light.gain())),
          lit(learned_light, illuminant.gain()),
          confidence.add(evidence)};
}

}  // namespace cgsr::color
