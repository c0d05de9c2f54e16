#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/color/track/color_likelihood.h"
#include "pipeline/color/track/correlation_filter.h"
#include "pipeline/color/track/scale_filter.h"
#include "pipeline/imaging/pyramid.h"
#include "platform/box.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// What the local tracker looks at, and how fast it learns.
struct LocalParameters {
  double padding = 2.0;
  double color_share = 0.3;
  double color_rate = 0.04;
  double inner_margin = 0.2;
  double min_light_step = 0.06;
  double light_rate = 0.8;
  CorrelationParameters correlation;
  ScaleParameters scale;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("padding", self.padding, {0.5, 4.0}, "",
                 "The width of the region examined around the box, in mean sides of the box.");
    visit.number("color_share", self.color_share, {0.0, 1.0}, "",
                 "The weight of colour relative to shape in the response.");
    visit.number("color_rate", self.color_rate, {0.0, 1.0}, "", "The weight of each new image in the pixel colours.");
    visit.number("inner_margin", self.inner_margin, {0.0, 0.45}, "",
                 "The margin removed from the box, in mean sides, before its colours count as the object's.");
    visit.number("min_light_step", self.min_light_step, {0.01, 1.0}, "",
                 "A change of a channel's mean over the whole image, as a logarithm, larger than this is treated as a "
                 "change of the light.");
    visit.number("light_rate", self.light_rate, {0.0, 1.0}, "",
                 "The share of such a change that the pixel colours follow at once.");
    visit.section("correlation", self.correlation, "The correlation filter for the object's shape");
    visit.section("scale", self.scale, "The filter for the object's size");
  }
};

/// What the local tracker says about a place.
struct LocalAnswer {
  Box box;                 ///< of the size that was asked about, moved to the best place near it.
  double score = 0.0;      ///< shape and colour together, about 0..1.
  double sharpness = 0.0;  ///< peak to sidelobe ratio of the shape alone.
};

/// Knows how the object looks in detail, from the images it was seen in: a correlation filter for its shape, a likelihood per pixel for its colours
/// (merged as in Staple, Bertinetto et al. 2016, doi 10.1109/CVPR.2016.156), a scale filter for its size. Everything happens in
/// a patch of 32x32 cells around the box, so the cost does not depend on the size of image or object.
///
/// Threads: one. Memory is reserved at construction.
class LocalTracker {
 public:
  explicit LocalTracker(const LocalParameters& parameters);

  /// Forgets everything and learns the object in `box`.
  void begin(const imaging::Pyramid& image, const Box& box);

  /// Learns how it looks in a further image. \param box  where it surely is.
  void learn(const imaging::Pyramid& image, const Box& box);

  /// Back to what begin() learned: what came since was something else.
  void forget();

  /// \return the best place for the object near `box`.
  LocalAnswer look(const imaging::Pyramid& image, const Box& box);

  /// \return the factor by which `box` must grow about its centre.
  double growth(const imaging::Pyramid& image, const Box& box) { return scale_.estimate(image, box); }

  /// Takes a sudden change of the whole image's brightness or tint for a change of the light and lets the pixel colours follow it.
  void follow_light(const imaging::Pyramid& image);

  /// Keeps what surrounds `box` now, for follow_light in the next image.
  void remember(const imaging::Pyramid& image, const Box& box);

  /// The same as look, by what begin() learned and under a light that is `gain` times that of the learned image: for a first sight, or
  /// one after a loss. The gain is taken out of what is seen, so that shape and colours are those that were learned.
  LocalAnswer look_under(const Light& gain, const imaging::Pyramid& image, const Box& box);

  /// From now on the object's colours are the learned ones under a light `gain` times the learned image's.
  void believe_light(const Light& gain);

 private:
  static constexpr int kPatch_px = 64;  ///< two pixels to a cell of the filter.

  [[nodiscard]] Box region_of(const Box& box) const;
  [[nodiscard]] Box object_in_patch(double margin) const;
  struct Displacement {
    double x = 0.0;
    double y = 0.0;
  };
  [[nodiscard]] Box object_in_patch(double margin, const Box& box, const Box& taken) const;
  [[nodiscard]] Displacement displacement(const Box& box, const Box& taken) const;
  [[nodiscard]] bool patch_shows(const imaging::Pyramid& image, const Box& box) const;
  void take_patch(const imaging::Pyramid& image, const Box& box);
  void take_colors(const imaging::Pyramid& image, const Box& box, ColorPatch& patch) const;
  void take_features(const ColorPatch& patch);
  LocalAnswer answer_from_patch(const ColorLikelihood& colors, const Box& box);
  void score_colors(const ColorLikelihood& colors, imaging::RealGrid& score);

  LocalParameters parameters_;
  double reach_x_ = 3.0;  ///< width of the patch over that of the box.
  double reach_y_ = 3.0;
  FilterFeatures features_;
  CorrelationFilter shape_;
  ScaleFilter scale_;
  ColorLikelihood colors_;
  ColorLikelihood learned_colors_;  ///< as begin() learned them.
  ColorPatch patch_;
  Box taken_;                      ///< around which patch_ was taken,
  std::uint64_t taken_build_ = 0;  ///< and in which image; 0: not as the image shows it.
  ColorPatch learned_;             ///< of the first image.
  ColorPatch remembered_;          ///< of the last image in which it was seen,
  Box remembered_taken_;           ///< around where,
  Box remembered_box_;             ///< with the object there.
  ColorPatch relit_;
  imaging::Pyramid::Mean remembered_mean_;
  std::vector<float> integral_;
};

}  // namespace cgsr::color
