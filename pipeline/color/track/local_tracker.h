#pragma once

#include <cstdint>
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
    visit.section("correlation", self.correlation, "The correlation filter for the object's shape");
    visit.section("scale", self.scale, "The filter for the object's size");
  }
};

/// What the local tracker says about a place.
struct LocalAnswer {
  Box box;                    ///< of the size that was asked about, moved to the best place near it.
  double score = 0.0;         ///< shape and colour together, about 0..1.
  double sharpness = 0.0;     ///< peak to sidelobe ratio of the shape alone.
  double color_inside = 0.0;  ///< mean likelihood of the box's pixels to be the object's,
  double color_around = 0.0;  ///< and of the other pixels of the patch.

  /// \return how far the colours stand out from what is around, -1..1.
  [[nodiscard]] double separation() const { return color_inside - color_around; }
};

/// Knows how the object looks in detail, from the images it was seen in: a correlation filter for its shape, a likelihood per pixel for its colours
/// (merged as in Staple, Bertinetto et al. 2016, doi 10.1109/CVPR.2016.156), a scale filter for its size. Everything happens in
/// a patch of 32x32 cells around the box, so the cost does not depend on the size of image or object. All that it knows is under the light
/// of the image that begin() learned: a light is taken out of an image before it is compared or learned.
///
/// Threads: one. Memory is reserved at construction.
class LocalTracker {
 public:
  explicit LocalTracker(const LocalParameters& parameters);

  /// Forgets everything and learns the object in `box`.
  void begin(const imaging::Pyramid& image, const Box& box);

  /// Learns how it looks in a further image. \param box  where it surely is. \param light  gain of the image's light from begin()'s.
  void learn(const imaging::Pyramid& image, const Box& box, const Light& light);

  /// Which colours a place is compared with.
  enum class Colors : std::uint8_t {
    kRecent,  ///< those of the last images.
    kFirst,   ///< those that begin() learned.
  };

  /// \param light  gain of the image's light from begin()'s. \return the best place for the object near `box`.
  LocalAnswer look(const imaging::Pyramid& image, const Box& box, const Light& light, Colors colors = Colors::kRecent);

  /// \return how likely a colour is the object's, by the last images, under the light of begin()'s.
  [[nodiscard]] const ColorLikelihood& colors() const { return colors_; }

  /// \return the factor by which `box` must grow about its centre.
  double growth(const imaging::Pyramid& image, const Box& box) { return scale_.estimate(image, box); }

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
  [[nodiscard]] bool patch_shows(const imaging::Pyramid& image, const Box& box, const Light& light) const;
  void take_patch(const imaging::Pyramid& image, const Box& box, const Light& light);
  void take_features(const ColorPatch& patch);
  void score_colors(const ColorLikelihood& colors, RealGrid& score);
  void measure_colors(double score, LocalAnswer& answer) const;

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
  Light taken_light_;              ///< under which light,
  std::uint64_t taken_build_ = 0;  ///< and in which image.
  std::vector<float> integral_;
};

}  // namespace cgsr::color
