#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/search_types.h"
#include "pipeline/color/track/clutter.h"
#include "pipeline/color/track/confidence.h"
#include "pipeline/color/track/illuminant_filter.h"
#include "pipeline/color/track/light_follower.h"
#include "pipeline/color/track/local_tracker.h"
#include "pipeline/color/track/presence.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::color {

enum class TrackMode : std::uint8_t {
  kPlain,  ///< Alg. 3.2 as the dissertation has it: one size, plain bins, the best window below the threshold, no prior.
  kFull,   ///< ours: the same search of the whole image, three sizes, and a local tracker that makes the box fit.
};

inline constexpr std::array kTrackModeNames{
    Named<TrackMode>{"plain", TrackMode::kPlain},
    Named<TrackMode>{"full", TrackMode::kFull},
};
constexpr std::string_view to_string(TrackMode mode) {
  return word_in(kTrackModeNames, mode);
}

/// What makes a place elsewhere in the image credible, and when a box holds another object. Scores are compared with their running mean
/// while the object was surely seen.
struct DoubtParameters {
  int warm_up_images = 8;
  double mean_rate = 0.05;
  double min_sure_score = 0.8;
  double min_agreement = 0.62;
  int max_foreign_images = 5;
  double min_tentative_log_odds = -4.0;
  int places_while_lost = 4;
  double min_reacquire_log_odds = 2.0;
  double min_reacquire_agreement = 0.7;
  double agreement_weight = 3.5;
  double min_found_sharpness = 14.0;
  double min_found_score = 0.45;
  double min_found_agreement = 0.86;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("warm_up_images", self.warm_up_images, {0, 1000}, "",
                 "The number of images after a detection in which the running means follow faster.");
    visit.number("mean_rate", self.mean_rate, {0.0, 1.0}, "",
                 "The weight of each reliable image in the running means.");
    visit.number("min_sure_score", self.min_sure_score, {0.0, 2.0}, "",
                 "The score from which the shape alone proves the object whatever its colours, as a ratio of the mean "
                 "score.");
    visit.number("min_agreement", self.min_agreement, {0.0, 1.0}, "",
                 "A box that contains less of the learned colours than this, and whose score is low as well, holds "
                 "another object.");
    visit.number("max_foreign_images", self.max_foreign_images, {1, 1000}, "",
                 "Tracking ends after this many consecutive images with another object in the box.");
    visit.number(
        "min_tentative_log_odds", self.min_tentative_log_odds, {-100.0, 100.0}, "",
        "The log-odds of presence from which what may be the lost object is followed, without being reported.");
    visit.number("places_while_lost", self.places_while_lost, {0, 40}, "",
                 "The number of places that are examined in each image while the object is lost: up to two of those "
                 "that the search found, in every second image one around the place of the loss, up to two whose "
                 "colours stand out, then more around the place of the loss.");
    visit.number("min_reacquire_log_odds", self.min_reacquire_log_odds, {-100.0, 100.0}, "",
                 "The least log-odds of presence (color.track.presence) with which the object is found again elsewhere "
                 "with its last appearance; where other things showed more, color.track.clutter asks for more.");
    visit.number(
        "min_reacquire_agreement", self.min_reacquire_agreement, {0.0, 1.0}, "",
        "The agreement with the learned or the recent colour amounts, corrected for the light, below which finding "
        "it again takes more log-odds.");
    visit.number("agreement_weight", self.agreement_weight, {0.0, 100.0}, "",
                 "The log-odds that each unit of agreement below min_reacquire_agreement takes.");
    visit.number("min_found_sharpness", self.min_found_sharpness, {0.0, 50.0}, "",
                 "The peak sharpness that a first detection requires.");
    visit.number("min_found_score", self.min_found_score, {0.0, 2.0}, "",
                 "The score that a first detection requires, as a ratio of the score of the learned image itself.");
    visit.number(
        "min_found_agreement", self.min_found_agreement, {0.0, 1.0}, "",
        "The agreement with the learned colour amounts, corrected for the light, that a first detection requires.");
  }
};

/// How an object is followed: the search (Alg. 3.2), and what mode full adds to it.
struct TrackParameters {
  TrackMode mode = TrackMode::kFull;
  double max_divergence = 0.40;
  int candidates = 3;
  double max_size_ratio = 5.0;
  double min_rest_confidence = 0.9;
  SearchParameters search;
  LocalParameters local;
  LightFollowerParameters light;
  IlluminantParameters illuminant;
  PresenceParameters presence;
  ClutterParameters clutter;
  DoubtParameters doubt;
  ConfidenceParameters confidence;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("mode", self.mode, kTrackModeNames,
                 "Choose plain for the dissertation's Alg. 3.2, and full for this project's extended tracker.");
    visit.number("max_divergence", self.max_divergence, {0.0, 0.7}, "nat",
                 "A window that differs more than this from every learned histogram is not the object.");
    visit.number("candidates", self.candidates, {1, kMaxMatches}, "",
                 "The number of best windows of the search that are examined closely.");
    visit.number("max_size_ratio", self.max_size_ratio, {1.0, 20.0}, "",
                 "The largest ratio between a side of the box and the learned one, upwards and downwards.");
    visit.number(
        "min_rest_confidence", self.min_rest_confidence, {0.0, 1.0}, "",
        "While the object is followed with at least this confidence, only every second image is searched; what "
        "the search finds serves when the object is in doubt.");
    visit.section("search", self.search, "The search over the whole image");
    visit.section("local", self.local, "The local tracker");
    visit.section("light", self.light, "How the object's colours change with light, side and shading");
    visit.section("illuminant", self.illuminant, "The light that falls on the object");
    visit.section("presence", self.presence, "The evidence for the object being where it is followed");
    visit.section("clutter", self.clutter, "The evidence that other things in the scene show");
    visit.section("doubt", self.doubt,
                  "The criteria by which the object is found again, and another one is told from it");
    visit.section("confidence", self.confidence, "The probability that the box covers the object");
  }
};

/// Where the object is in one image.
struct TrackedObject {
  bool found = false;
  Box box;                  ///< camera pixels, inside the image; read only when found, as all below.
  double divergence = 0.0;  ///< [nat] of the box from the learned histogram, under the light that fits best.
  Light light;  ///< the light of the grid under which its colours fit best; never preferred in the next image (3.2.2).
  Light exact_light;  ///< the light that falls on it (IlluminantFilter), not bound to the grid.
  double confidence =
      0.0;  ///< probability that the box covers the object (Confidence), 0..1; 0: not estimated, as in mode plain.
};

/// Follows a learned object from image to image, by what a search of the whole image (ObjectSearch) found in each (chapter 3).
///
/// Threads: one. Memory is reserved by create; track never allocates.
class Tracker {
 public:
  /// \param max_width_px, max_height_px  the largest camera image that will come.
  static Result<Tracker> create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                int max_height_px);
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;
  ~Tracker();

  /// The window size with which the next image is to be searched (ObjectSearch): as the object was last seen, or as it was learned.
  [[nodiscard]] SearchSize search_size() const;

  /// Says where the object is known to be, as in the image that it was learned from.
  void place(const ImageView& image, const imaging::ReducedImage& reduced, const Box& box);

  /// Which of the windows that a search found it is, or what became of the object since the last image, and the box that fits.
  /// \param image  as the camera sent it. \param reduced  the same, reduced with ObjectSearch's labels. \param matches  of the search of this
  ///        image, with search_size(). \param budget  asked once per closer look, learning or scan.
  TrackedObject track(const ImageView& image, const imaging::ReducedImage& reduced, const SearchResult& matches,
                      WorkBudget& budget);

 private:
  struct State;
  explicit Tracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::color
