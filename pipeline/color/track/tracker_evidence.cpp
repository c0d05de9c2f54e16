// What speaks for a place being the object's: the measures behind Tracker::State.
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/color/track/relight.h"
#include "pipeline/color/track/tracker_boxes.h"
#include "pipeline/color/track/tracker_state.h"

namespace cgsr::color {
namespace {

constexpr int kRefinements = 3;
// Of a window that may be the object as it looked last: one that fits badly gains a few in log-odds.
constexpr int kRecognitionRounds = 2;
constexpr double kMinGlanceLogOdds = -1.0;
// What a window of the search, which fits the object only roughly, must have of what is asked after refinement: most windows without the
// object end here, at a third of the cost.
constexpr double kGlanceScore = 0.75;
constexpr double kGlanceSharpness = 0.5;
constexpr double kGlanceAgreement = 0.65;

/// Places around the one of the loss, in the object's sides: the nearest first.
struct Offset {
  int columns;
  int rows;
};
constexpr std::array<Offset, 25> kAround{{{0, 0},   {1, 0},   {-1, 0}, {0, 1},  {0, -1}, {1, 1},  {-1, -1},
                                          {1, -1},  {-1, 1},  {2, 0},  {-2, 0}, {0, 2},  {0, -2}, {2, 1},
                                          {-2, -1}, {1, -2},  {-1, 2}, {2, -1}, {-2, 1}, {1, 2},  {-1, -2},
                                          {2, 2},   {-2, -2}, {2, -2}, {-2, 2}}};

}  // namespace

Place Tracker::State::look(const imaging::ReducedImage& reduced, const Box& at) {
  const LocalAnswer local_answer = local.look(pyramid, at, light.gain());
  return {local_answer, divergence.of(reduced, local_answer.box).divergence};
}

Tint Tracker::State::tint(const Box& at) const {
  Tint tint;
  tint.view = view_object(pyramid, at);
  tint.quantiles = channel_quantiles(tint.view);
  tint.measured = measured_gain(learned_quantiles, tint.quantiles);
  const ColorAmounts seen(relit(tint.view, inverse(tint.measured.gain)));
  tint.agreement = learned_amounts.agreement(seen);
  return tint;
}

double Tracker::State::recent_agreement(const Tint& seen) const {
  return recent_amounts.agreement(ColorAmounts(relit(seen.view, inverse(light.gain()))));
}

PresenceMeasures Tracker::State::measures_of(const Place& place) const {
  const double score_ratio = mean_score > 0.0 ? place.local.score / mean_score : 0.0;  // a plain region has no score
  return {score_ratio, place.local.sharpness, place.divergence - mean_divergence, place.local.separation()};
}

/// What is lost may be in view and look otherwise than it did: a copy of what was known follows it and learns how it looks now, as long as
/// anything speaks for it. That moves `box` and proves nothing: whether it is the object is asked of what was surely learned.
void Tracker::State::follow_tentatively(const imaging::ReducedImage& reduced, WorkBudget& budget) {
  if (!budget.grant()) return;
  const LocalAnswer answer = tentative.look(pyramid, box, light.gain());
  const Place place{answer, divergence.of(reduced, answer.box).divergence};
  if (presence.log_odds(measures_of(place)) < parameters.doubt.min_tentative_log_odds) return;
  box = with_centre_inside(answer.box, pyramid.width_px(), pyramid.height_px());
  if (recent_agreement(tint(box)) >= parameters.doubt.min_agreement && budget.grant())
    tentative.learn(pyramid, box, light.gain());
}

/// Where it may be while what is followed tentatively is something else: where it was lost, and up to two sides away, one place after the other.
/// \return none if the place's centre is outside the image.
std::optional<Box> Tracker::State::place_around(int turn) const {
  const auto [columns, rows] = kAround[static_cast<std::size_t>(turn) % kAround.size()];
  Box place = centred_on(lost_at, box.width, box.height);
  place.x += columns * box.width;
  place.y += rows * box.height;
  const double x = place.x + 0.5 * place.width;
  const double y = place.y + 0.5 * place.height;
  if (x < 0.0 || y < 0.0 || x > pyramid.width_px() || y > pyramid.height_px()) return std::nullopt;
  return place;
}

/// Elsewhere, or where it was lost but in another size, as it looked last. The window that fits best is fitted before it is judged, for the
/// search knows a few sizes only.
/// \return whether one of the search's windows is surely the object; else `place` stays as it is.
bool Tracker::State::recognise(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                               Place& place) {
  Place best;
  double most = kMinGlanceLogOdds;
  const auto consider = [&](const Place& other) {
    const double log_odds = presence.log_odds(measures_of(other));
    if (log_odds <= most) return false;
    best = other;
    most = log_odds;
    return true;
  };
  bool any = lost && consider(place);
  for (int i = 0; i < matches.count && budget.grant(); ++i) {
    const Box& window = matches.matches[static_cast<std::size_t>(i)].box;
    any |= consider(look(reduced, centred_on(window, box.width, box.height)));
  }
  const int around = lost ? parameters.doubt.places_while_lost - matches.count : 0;
  for (int i = 0; i < around && budget.grant(); ++i) {
    if (const auto near = place_around(places_looked_at++)) any |= consider(look(reduced, *near));
  }
  if (!any) return false;
  for (int round = 0; round < kRecognitionRounds && budget.grant(); ++round) {
    const Box fitted = grown(best.local.box, local.growth(pyramid, best.local.box), model, parameters.max_size_ratio);
    if (!consider(look(reduced, fitted))) break;
  }
  if (most < parameters.doubt.min_reacquire_log_odds) return false;
  const Tint seen = tint(best.local.box);
  if (std::max(seen.agreement, recent_agreement(seen)) < parameters.doubt.min_reacquire_agreement) return false;
  place = best;
  return true;
}

/// First sight, sight again after a loss, or elsewhere: each window of the search is looked at under its own light.
/// \return whether one of them is surely the object; else `place` stays as it is.
bool Tracker::State::find(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                          Place& place) {
  const DoubtParameters& doubt = parameters.doubt;
  LocalAnswer best;
  Tint seen;
  const SearchSize size = search_size();
  for (int i = 0; i < matches.count && budget.grant(); ++i) {
    const Box& window = matches.matches[static_cast<std::size_t>(i)].box;
    const Tint its_tint = tint(window);
    if (its_tint.agreement < kGlanceAgreement * doubt.min_found_agreement) continue;
    const LocalAnswer its_answer = local.look(pyramid, centred_on(window, size.width_px, size.height_px),
                                              its_tint.measured.gain, LocalTracker::Colors::kFirst);
    if (its_answer.score <= best.score) continue;
    best = its_answer;
    seen = its_tint;
  }
  if (best.score < kGlanceScore * doubt.min_found_score * first_score) return false;
  if (best.sharpness < kGlanceSharpness * doubt.min_found_sharpness) return false;
  for (int round = 0; round < kRefinements && budget.grant(); ++round) {
    best = local.look(pyramid, best.box, seen.measured.gain, LocalTracker::Colors::kFirst);
    best.box = grown(best.box, local.growth(pyramid, best.box), model, parameters.max_size_ratio);
    seen = tint(best.box);
  }
  const double its_divergence = divergence.of(reduced, best.box).divergence;
  if (best.sharpness < doubt.min_found_sharpness || best.score < doubt.min_found_score * first_score) return false;
  if (seen.agreement < doubt.min_found_agreement || its_divergence > parameters.max_divergence) return false;
  place = {best, its_divergence};
  light.set(seen.measured.gain);
  light.lose();
  if (!located) illuminant.begin(seen.measured.gain, image_quantiles);
  images_since_sight = 0;
  return true;
}

}  // namespace cgsr::color
