#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "pipeline/color/color_model.h"
#include "pipeline/color/local_tracker.h"
#include "pipeline/color/search_types.h"
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

/// When the local tracker is doubted, and what makes a place elsewhere in the image more credible. Scores are compared with their running
/// mean while the object was surely seen, divergences with theirs.
struct DoubtParameters {
  int warm_up_images = 8;
  double mean_rate = 0.05;
  double min_sure_sharpness = 8.0;
  double min_sure_score = 0.8;
  double max_divergence_rise = 0.1;
  double min_agreement = 0.62;
  int max_foreign_images = 5;
  int max_doubtful_images = 3;
  double min_stay_sharpness = 8.0;
  double min_stay_score = 0.7;
  double min_reacquire_score = 0.75;
  double min_reacquire_agreement = 0.9;
  double min_found_sharpness = 14.0;
  double min_found_score = 0.45;
  double min_found_agreement = 0.86;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("warm_up_images", self.warm_up_images, {0, 1000}, "",
                 "images after a first sight in which the means are not yet trusted: a first sight's own conditions "
                 "count instead");
    visit.number("mean_rate", self.mean_rate, {0.0, 1.0}, "", "share of each sure image in the running means");
    visit.number("min_sure_sharpness", self.min_sure_sharpness, {0.0, 50.0}, "",
                 "a peak below this, with the next two, is doubted");
    visit.number("min_sure_score", self.min_sure_score, {0.0, 2.0}, "", "a score below this share of its mean");
    visit.number("max_divergence_rise", self.max_divergence_rise, {0.0, 0.7}, "nat",
                 "a divergence above its mean by more than this");
    visit.number("min_agreement", self.min_agreement, {0.0, 1.0}, "",
                 "a box in which more of the learned colours is missing holds something else, however sure the local "
                 "tracker is");
    visit.number("max_foreign_images", self.max_foreign_images, {1, 1000}, "",
                 "such images in a row end what was followed");
    visit.number("max_doubtful_images", self.max_doubtful_images, {1, 1000}, "",
                 "doubtful images after which the object is lost");
    visit.number("min_stay_sharpness", self.min_stay_sharpness, {0.0, 50.0}, "",
                 "what ends a loss in the place where it began");
    visit.number("min_stay_score", self.min_stay_score, {0.0, 2.0}, "", "and its score, as a share of the mean");
    visit.number(
        "min_reacquire_score", self.min_reacquire_score, {0.0, 2.0}, "",
        "what a place elsewhere needs to be the object as it was last seen: its score, as a share of the mean");
    visit.number("min_reacquire_agreement", self.min_reacquire_agreement, {0.0, 1.0}, "",
                 "and how far it has the learned colours in the learned amounts, its light taken out");
    visit.number("min_found_sharpness", self.min_found_sharpness, {0.0, 50.0}, "",
                 "what a sight anywhere else needs, as the first one does");
    visit.number("min_found_score", self.min_found_score, {0.0, 2.0}, "",
                 "and its score, as a share of what the learned picture itself scores");
    visit.number("min_found_agreement", self.min_found_agreement, {0.0, 1.0}, "",
                 "and how far it has the learned colours in the learned amounts, its light taken out");
  }
};

struct TrackParameters {
  TrackMode mode = TrackMode::kFull;
  double max_divergence = 0.40;
  int candidates = 3;
  double max_size_ratio = 5.0;
  SearchParameters search;
  LocalParameters local;
  DoubtParameters doubt;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("mode", self.mode, kTrackModeNames, "plain: the dissertation's Alg. 3.2; full: ours");
    visit.number("max_divergence", self.max_divergence, {0.0, 0.7}, "nat",
                 "a window farther than this from every learned histogram is not the object");
    visit.number("candidates", self.candidates, {1, kMaxMatches}, "",
                 "best windows of the search that are looked at closely");
    visit.number("max_size_ratio", self.max_size_ratio, {1.0, 20.0}, "",
                 "largest and smallest box, as a factor of the learned one's sides");
    visit.section("search", self.search, "The search over the whole image");
    visit.section("local", self.local, "The local tracker");
    visit.section("doubt", self.doubt, "When it is doubted");
  }
};

/// Where the object is in one image.
struct TrackedObject {
  bool found = false;
  Box box;                  ///< camera pixels, inside the image; read only when found, as all below.
  double divergence = 0.0;  ///< [nat] of the box from the learned histogram, under the light that fits best.
  Light light;              ///< the light of the grid that fits best; never preferred in the next image (3.2.2).
  Light exact_light;        ///< the same, not bound to the grid.
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
  ///        image, with search_size(). \param budget  asked once per closer look.
  TrackedObject track(const ImageView& image, const imaging::ReducedImage& reduced, const SearchResult& matches,
                      WorkBudget& budget);

 private:
  struct State;
  explicit Tracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::color
