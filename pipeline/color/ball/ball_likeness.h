#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/ball/ball_search.h"
#include "pipeline/color/ball/shade_at_place.h"
#include "pipeline/color/search/box_divergence.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// The side of a square that lies inside a circle, of its diameter: windows of the search and what is compared afterwards are as large. Ours.
inline constexpr double kCoreSide = 0.62;

/// The histogram of a ball that fits best what is inside a circle.
struct Likeness {
  static constexpr double kUnlike = 1.0;  ///< a divergence above all that can be.

  double divergence = kUnlike;  ///< [nat]
  int light = 0;                ///< of the bright or dark model.
  bool dark = false;
};

/// Whether what is inside a circle has the ball's colours (5.3): bright ones anywhere, dark ones where there may be shade.
///
/// Threads: one. Memory is reserved by the constructor; of() never allocates.
class BallLikeness {
 public:
  /// \param ball, search  outlive it. \param diameter_m  the ball's. \param max_width_px, max_height_px  the largest camera image that will come.
  BallLikeness(const BallModel& ball, const BallSearch& search, Divergence divergence, double diameter_m,
               int max_width_px, int max_height_px);

  /// \param factor  by which the image is reduced. \param places  what is known of single places beside the mask; null: nothing.
  [[nodiscard]] Likeness of(const BallPixels& pixels, const Circle& circle, int factor, const ShadeAtPlace* places);

 private:
  /// Which pixels of a box count.
  enum class Where : std::uint8_t { kEverywhere, kShaded, kLit };
  /// One set of histograms.
  struct Histograms {
    const imaging::LabelTable& table;
    BoxDivergence divergence;
  };

  [[nodiscard]] Likeness in_the_light(const BallPixels& pixels, const Box& core);
  [[nodiscard]] bool looks_shaded_in_the_light(const BallPixels& pixels, const Circle& circle);
  [[nodiscard]] BoxDivergence::Answer nearest(Histograms& of, const BallPixels& pixels, Box box, Where where);

  Histograms bright_;
  Histograms dark_;
  double diameter_m_;
  imaging::ReducedImage labels_;  // about a circle
  int factor_ = 1;
};

/// How much light has fallen on the ball itself where it surely lay in shade: what is darker than that is another thing. How much light of windows and
/// of other lamps falls into a lamp's shade differs from home to home. Ours; the dissertation has fixed factors alone (5.3).
class LightInShade {
 public:
  /// An image passes: what was seen long ago counts less, for light changes.
  void fade();
  /// The ball has been seen in shade. \param gain  mean of the channels of its light, darkness factor included.
  void add(double gain);
  /// \return whether the ball has been as dark as that or darker in some of those images, or was hardly seen in shade at all.
  [[nodiscard]] bool is_plausible(double gain) const;

 private:
  static constexpr std::size_t kBins = 24;
  static std::size_t bin_of(double gain);

  std::array<double, kBins> images_{};  // by gain
};

}  // namespace cgsr::color
