// What speaks for a place being the object's: the measures behind Tracker::State.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/color/track/relight.h"
#include "pipeline/color/track/tracker_boxes.h"
#include "pipeline/color/track/tracker_state.h"

namespace cgsr::color {
namespace {

constexpr int kRefinements = 3;
// Of a window that may be the object as it looked last: one that fits badly gains a few in log-odds.
constexpr int kRecognitionRounds = 2;
constexpr double kMinGlanceLogOdds = -1.0;
constexpr int kWindowsWhileLost = 2;  // of the search, in an image
// What may be the object, somewhere else than what is followed tentatively, is followed instead from this on.
constexpr double kMinInsteadLogOdds = 0.0;
constexpr double kMinInsteadLead = 0.5;
// Without this share of the object's colours nothing is the object, however alike its shape.
constexpr double kMinAgreement = 0.4;
constexpr int kImagesToBeside = 3;  // from one look at something beside the followed object to the next
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

/// \return the log-odds that a place loses by colours of the object that it lacks.
double Tracker::State::missing_color_penalty(const Place& place) const {
  const DoubtParameters& doubt = parameters.doubt;
  const Tint seen = tint(place.local.box);
  const double agreement = std::max(seen.agreement, recent_agreement(seen));
  // What is where it was seen last stood in its way, or beside it, more often than elsewhere.
  const bool in_its_place = !intersection(place.local.box, lost ? lost_at : box).empty();
  if (agreement < (in_its_place ? doubt.min_agreement : kMinAgreement)) return std::numeric_limits<double>::infinity();
  return doubt.agreement_weight * std::max(0.0, doubt.min_reacquire_agreement - agreement);
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
/// \return none if the centres of all are outside the image.
std::optional<Box> Tracker::State::place_around() {
  for (std::size_t i = 0; i < kAround.size(); ++i, next_around()) {
    const auto [columns, rows] = kAround[around];
    Box place = centred_on(lost_at, box.width, box.height);
    place.x += columns * box.width;
    place.y += rows * box.height;
    if (in_image(place.x + 0.5 * place.width, place.y + 0.5 * place.height)) return place;
  }
  return std::nullopt;
}

void Tracker::State::next_around() {
  around = (around + 1) % kAround.size();
}

/// While the object is surely followed, every third image, or the next one where that is searched and has less time: how much evidence the
/// search's best window beside it shows.
void Tracker::State::look_beside(const imaging::ReducedImage& reduced, const SearchResult& matches,
                                 WorkBudget& budget) {
  if (++images_since_beside < kImagesToBeside + (matches.of_this_image ? 1 : 0)) return;
  images_since_beside = 0;
  double log_odds = kMinGlanceLogOdds;
  for (int i = 0; i < matches.count; ++i) {
    const Box& window = matches.matches[static_cast<std::size_t>(i)].box;
    if (!intersection(window, box).empty()) continue;
    if (!budget.grant()) return;
    const Place beside = look(reduced, centred_on(window, box.width, box.height));
    if (intersection(beside.local.box, box).empty()) log_odds = presence.log_odds(measures_of(beside));
    break;
  }
  clutter.add(log_odds);
}

/// What speaks for it is not enough to say that it is the object; following it will tell.
void Tracker::State::follow_instead(const Place& other) {
  const Box there = centred_on(other.local.box, box.width, box.height);
  box = with_centre_inside(there, pyramid.width_px(), pyramid.height_px());
  tentative = local;
  presence.deny();
}

/// \return whether `other` is likelier than the likeliest so far.
bool Tracker::State::consider(const Place& other, Candidate& likeliest) const {
  const double log_odds = presence.log_odds(measures_of(other));
  if (log_odds <= likeliest.log_odds) return false;
  likeliest = {other, log_odds};
  return true;
}

/// \return false: there is no work left for it.
bool Tracker::State::consider_at(const imaging::ReducedImage& reduced, const Box& at, WorkBudget& budget,
                                 Candidate& likeliest) {
  if (!budget.grant()) return false;
  consider(look(reduced, centred_on(at, box.width, box.height)), likeliest);
  return true;
}

/// The search's windows look like the learned image; what has changed since is found near the place of the loss, or by its recent colours. That
/// the windows come first also keeps `clutter` informed: without them more is taken for the object.
void Tracker::State::consider_while_lost(const imaging::ReducedImage& reduced, const SearchResult& matches,
                                         WorkBudget& budget, Candidate& likeliest) {
  int looks = parameters.doubt.places_while_lost;
  const auto consider_next = [&](const Box& at) {
    const bool looked = looks > 0 && consider_at(reduced, at, budget, likeliest);
    looks = looked ? looks - 1 : 0;
    return looked;
  };
  const auto consider_around = [&] {
    const auto there = place_around();
    if (!there || !consider_next(*there)) return false;
    next_around();
    return true;
  };
  const int windows = std::min(matches.count, kWindowsWhileLost);
  for (int i = 0; i < windows; ++i) consider_next(matches.matches[static_cast<std::size_t>(i)].box);
  if (images_lost % 2 == 1) consider_around();
  if (looks > 0 && budget.grant()) {
    // The scan and a look at its first place are one unit of work; the others take turns.
    const auto standing_out = color_scan.places(pyramid, local.colors(), light.gain(), box);
    if (!standing_out.empty()) {
      --looks;
      consider(look(reduced, centred_on(standing_out.front(), box.width, box.height)), likeliest);
    }
    const std::size_t turn = 1 + static_cast<std::size_t>(images_lost) % (ColorScan::kMaxPlaces - 1);
    if (turn < standing_out.size()) consider_next(standing_out[turn]);
  }
  while (consider_around()) {
  }
}

/// Elsewhere, or where it was lost but in another size, as it looked last. What fits best is fitted before it is judged, for the places
/// have a few sizes only.
/// \return whether one of the places is surely the object; else `place` stays as it is.
bool Tracker::State::recognise(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                               Place& place) {
  Candidate best{{}, kMinGlanceLogOdds};
  if (lost) {
    consider(place, best);
    consider_while_lost(reduced, matches, budget, best);
    clutter.add_pending(best.log_odds);
  } else {
    for (int i = 0; i < matches.count; ++i)
      consider_at(reduced, matches.matches[static_cast<std::size_t>(i)].box, budget, best);
  }
  if (best.log_odds <= kMinGlanceLogOdds) return false;
  for (int round = 0; round < kRecognitionRounds && budget.grant(); ++round) {
    const Box& near = best.place.local.box;
    const Box fitted = grown(near, local.growth(pyramid, near), model, parameters.max_size_ratio);
    if (!consider(look(reduced, fitted), best)) break;
  }
  if (best.log_odds <= kMinInsteadLogOdds) return false;
  const double log_odds = best.log_odds - missing_color_penalty(best.place);
  if (log_odds >= std::max(parameters.doubt.min_reacquire_log_odds, clutter.min_log_odds())) {
    place = best.place;
    return true;
  }
  const bool elsewhere = intersection(best.place.local.box, place.local.box).empty();
  if (lost && elsewhere &&
      log_odds > std::max(kMinInsteadLogOdds, presence.log_odds(measures_of(place)) + kMinInsteadLead))
    follow_instead(best.place);
  return false;
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
