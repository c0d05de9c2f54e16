#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/shade_at_place.h"
#include "pipeline/color/ball/shade_mask.h"
#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/search_types.h"
#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::color {

/// The shape of a ball: a circle of a size that is known to some degree.
struct BallParameters {
  double diameter_m = 0.20;
  double min_distance_m = 1.0;
  double max_distance_m = 7.0;
  double min_found_agreement = 0.60;
  double min_kept_agreement = 0.45;
  double min_inside = 0.60;
  double max_around = 0.45;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("diameter_m", self.diameter_m, {0.01, 2.0}, "m", "The diameter of the ball.");
    visit.number("min_distance_m", self.min_distance_m, {0.1, 100.0}, "m",
                 "The smallest distance from the camera to the ball; it determines the largest circle.");
    visit.number("max_distance_m", self.max_distance_m, {0.1, 100.0}, "m",
                 "The largest distance from the camera to the ball; it determines the smallest circle.");
    visit.number("min_found_agreement", self.min_found_agreement, {0.0, 1.0}, "",
                 "The smallest share of the circle that must lie on an image edge of the same direction when the ball "
                 "is first found.");
    visit.number("min_kept_agreement", self.min_kept_agreement, {0.0, 1.0}, "",
                 "The same share for a ball that is being tracked.");
    visit.number("min_inside", self.min_inside, {0.0, 1.0}, "",
                 "The smallest share of the circle's area that must have the ball's colours.");
    visit.number("max_around", self.max_around, {0.0, 1.0}, "",
                 "The largest share of the surrounding ring that may have the ball's colours.");
  }
};

/// The section [integrated] of a robot's file.
struct IntegratedParameters {
  std::array<double, 3> dark_factors{0.25, 0.40, 0.55};
  double max_divergence = 0.33;
  double max_found_divergence = 0.24;
  double max_kept_divergence = 0.28;
  int candidates = 6;
  int max_missed_images = 3;
  SearchParameters search{Divergence::kJensenShannon, BinWeights::kPlain, 0.1, 4, 1.9, 8.0, 4};
  BallParameters ball;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("dark_factors", self.dark_factors, {0.05, 1.0}, "",
                  "The factors by which the lights of the model are multiplied where the image may be shaded.");
    visit.number("max_divergence", self.max_divergence, {0.0, 0.7}, "nat",
                 "Windows that differ more than this from every histogram of a search are discarded.");
    visit.number(
        "max_found_divergence", self.max_found_divergence, {0.0, 0.7}, "nat",
        "The largest divergence between the circle's area and the nearest histogram when the ball is first found.");
    visit.number("max_kept_divergence", self.max_kept_divergence, {0.0, 0.7}, "nat",
                 "The same divergence for a ball that is being tracked.");
    visit.number("candidates", self.candidates, {1, kMaxMatches}, "",
                 "The number of windows of each of the two searches whose shape is examined.");
    visit.number("max_missed_images", self.max_missed_images, {1, 1000}, "",
                 "After this many images without the ball, the stricter thresholds of a first detection apply again.");
    visit.section("search", self.search,
                  "The two searches over the image; their window sizes cover the sizes that the ball can have");
    visit.section("ball", self.ball, "The shape of the ball");
  }
};

/// What a ball of this size shows at these distances. \param focal_px  mean of fx and fy.
SizeRange projected_size(const BallParameters& ball, double focal_px);

/// Where the ball is in one image, and what the answer cost.
struct BallSighting {
  bool found = false;
  Box box;  ///< camera pixels, around the circle, cut at the image's border; read only when found, as down to `dark`.
  Circle circle;             ///< whole.
  double agreement = 0.0;    ///< of the image's edges with the circle, 0..1.
  double divergence = 0.0;   ///< [nat] from the histogram that fits best.
  Light light;               ///< that histogram's; with the darkness factor in it when dark.
  double shade_share = 0.0;  ///< of the circle inside the mask; 0 without one.
  bool dark = false;         ///< the histogram that fits best is a dark one.

  bool mask_used =
      false;  ///< false: there was no mask, or none that can be used, and dark histograms were searched everywhere.
  bool exact = true;        ///< false: the budget ended a search.
  int bright_windows = 0;   ///< there were to compare,
  int bright_examined = 0;  ///< and had their histogram counted.
  int dark_windows = 0;
  int dark_examined = 0;
};

/// Chapter 3's search with chapter 5's knowledge of shade (5.3), for a ball of one colour: the bright histograms of a model are searched
/// everywhere, dark ones only where there may be shade, and what they find has to be round and of a size that can be.
///
/// The model is one of learn(), of a box around the ball (`widen` off, `min_distinctiveness` 0: a single colour is what the shape makes up
/// for). Its histograms are made anew, of the circle in the box and without its corners, out of the samples that the model keeps.
///
/// Threads: one. Memory is reserved by create; track never allocates.
class IntegratedTracker {
 public:
  /// \param max_width_px, max_height_px  the largest camera image that will come.
  /// \param focal_px  mean of fx and fy; 0: not known, the ball has 1/5 to 5 times its learned size.
  /// \return an error in words: a defective model, one without a sample, parameters that cannot be.
  static Result<IntegratedTracker> create(const ColorModel& model, const IntegratedParameters& parameters,
                                          int max_width_px, int max_height_px, double focal_px = 0.0);
  IntegratedTracker(IntegratedTracker&&) noexcept;
  IntegratedTracker& operator=(IntegratedTracker&&) noexcept;
  ~IntegratedTracker();

  /// Looks for the ball in the next image.
  /// \param image  YUYV, as the camera sent it. \param mask  over this image; empty: none is known, and dark histograms are searched
  ///        everywhere (BallSighting::mask_used). \param budget  asked once per unit of the searches and per closer look.
  /// \param places  what is known of single places beside the mask, of the same image; null: nothing.
  BallSighting track(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget,
                     const ShadeAtPlace* places = nullptr);

  /// Forgets where the ball was.
  void forget();

 private:
  struct State;
  explicit IntegratedTracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::color
