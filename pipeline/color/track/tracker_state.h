#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/color/search/box_divergence.h"
#include "pipeline/color/track/clutter.h"
#include "pipeline/color/track/color_agreement.h"
#include "pipeline/color/track/color_scan.h"
#include "pipeline/color/track/light_estimate.h"
#include "pipeline/color/track/light_follower.h"
#include "pipeline/color/track/presence.h"
#include "pipeline/color/track/tracker.h"

namespace cgsr::color {

/// A place for the object, with what is known in favour of it.
struct Place {
  LocalAnswer local;
  double divergence = 0.0;
};

/// The likeliest of several places.
struct Candidate {
  Place place;
  double log_odds = 0.0;  ///< of presence there.
};

/// The colours of a place, against the learned ones.
struct Tint {
  ObjectView view;
  ChannelQuantiles quantiles;
  MeasuredGain measured;   ///< of the light, from the learned image's, by these colours alone.
  double agreement = 0.0;  ///< ColorAmounts::agreement with the learned ones, that light taken out.
};

/// Mode plain is Alg. 3.2 alone. The rest is ours: doubt, loss and finding again, of which the dissertation (3.2.2) says nothing.
struct Tracker::State {
  State(const ColorModel& m, const TrackParameters& p, int max_width_px, int max_height_px)
      : model(m),
        parameters(p),
        divergence(m, p.search.divergence),
        pyramid(max_width_px, max_height_px),
        local(p.local),
        tentative(p.local),
        light(p.light),
        illuminant(p.illuminant),
        confidence(p.confidence),
        presence(p.presence),
        clutter(p.clutter) {
    learn_from_model();
  }

  void learn_from_model();
  void keep_colors(const ObjectView& view);
  [[nodiscard]] SearchSize search_size() const;
  TrackedObject track_plain(const SearchResult& matches) const;
  TrackedObject track_full(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget);
  Place look(const imaging::ReducedImage& reduced, const Box& box);
  [[nodiscard]] Tint tint(const Box& at) const;
  [[nodiscard]] double recent_agreement(const Tint& seen) const;
  [[nodiscard]] double missing_color_penalty(const Place& place) const;
  /// Where it will come back, it may be nearer or farther: one size after the other, in different images.
  [[nodiscard]] double lost_scale() const {
    constexpr std::array kScales{1.0, 0.7, 1.4};
    return kScales[static_cast<std::size_t>(images_lost) % kScales.size()];
  }
  [[nodiscard]] bool is_foreign(const Place& place, const Tint& seen, const ColorAmounts& amounts) const;
  void learn(const Place& place, const ColorAmounts& amounts, bool continued);
  TrackedObject lose();
  [[nodiscard]] PresenceMeasures measures_of(const Place& place) const;
  void follow_tentatively(const imaging::ReducedImage& reduced, WorkBudget& budget);
  [[nodiscard]] bool in_image(double x_px, double y_px) const {
    return x_px >= 0.0 && y_px >= 0.0 && x_px <= pyramid.width_px() && y_px <= pyramid.height_px();
  }
  [[nodiscard]] std::optional<Box> place_around();
  void next_around();
  void look_beside(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget);
  void follow_instead(const Place& other);
  bool consider(const Place& other, Candidate& likeliest) const;
  bool consider_at(const imaging::ReducedImage& reduced, const Box& at, WorkBudget& budget, Candidate& likeliest);
  void consider_while_lost(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                           Candidate& likeliest);
  bool recognise(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget, Place& place);
  bool find(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget, Place& place);
  TrackedObject answer(const Place& place, const ColorAmounts& amounts);

  ColorModel model;
  TrackParameters parameters;
  BoxDivergence divergence;
  imaging::Pyramid pyramid;
  LocalTracker local;
  LocalTracker tentative;  ///< a copy of `local` from the loss on, which goes on learning what may be the object.
  LightFollower light;
  IlluminantFilter illuminant;
  ChannelQuantiles image_quantiles;  ///< of the whole image.
  Confidence confidence;
  Presence presence;
  Clutter clutter;
  ColorScan color_scan;
  ChannelQuantiles learned_quantiles;
  ColorAmounts learned_amounts;
  ColorAmounts recent_amounts;  ///< of the last images, with their light taken out.
  Light learned_light;

  bool located = false;  ///< `box` is where the object was in the last image.
  Box box;               ///< where the object was last, or, while it is lost, what may be the object.
  Box lost_at;           ///< where it was last, when it was lost.
  double mean_score = 0.0;
  double mean_divergence = 0.0;
  int images_since_sight = 0;
  int images_since_beside = 0;
  bool lost = false;       ///< it was here, and is not seen.
  int images_lost = 0;     ///< in a row.
  std::size_t around = 0;  ///< which of the places around it is looked at next.
  int foreign_images = 0;  ///< in a row; whose colours are not the learned ones.
  double first_score = 0.0;
};

}  // namespace cgsr::color
