#pragma once

#include <span>

#include "pipeline/imaging/color_code.h"
#include "pipeline/person/classifier.h"
#include "platform/box.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::person {

/// How an image was taken, as far as it decides which classifiers can be relied on. Shares of the pixels of the region that is classified, each in [0, 1].
struct ImageContext {
  double dark = 0.0;       ///< too dark for a hue: all channels under 0.08.
  double saturated = 0.0;  ///< cut off at the top in a channel.
  double blurred =
      0.0;  ///< 0: edges are as sharp as a lens makes them; 1: no edge is left. By the grey values, not a share of pixels.
};

/// Of the two regions that say who somebody is.
struct PersonContexts {
  ImageContext head{};   ///< for the face and its colours.
  ImageContext shirt{};  ///< for the shirt, and a marker on it.
};

/// By how much a disturbed image lowers the confidence of a kind of classifier. Ours: the dissertation names it as future work.
struct ContextParameters {
  double dark_color = 0.8;
  double dark_grey = 0.4;
  double saturated_color = 0.7;
  double saturated_grey = 0.4;
  double blurred_color = 0.1;
  double blurred_grey = 0.8;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("dark_color", self.dark_color, {0.0, 1.0}, "",
                 "The share of its confidence that a colour classifier loses in a dark region.");
    visit.number("dark_grey", self.dark_grey, {0.0, 1.0}, "",
                 "The share of its confidence that a grey classifier loses in a dark region.");
    visit.number("saturated_color", self.saturated_color, {0.0, 1.0}, "",
                 "The share of its confidence that a colour classifier loses in a saturated region.");
    visit.number("saturated_grey", self.saturated_grey, {0.0, 1.0}, "",
                 "The share of its confidence that a grey classifier loses in a saturated region.");
    visit.number("blurred_color", self.blurred_color, {0.0, 1.0}, "",
                 "The share of its confidence that a colour classifier loses in a blurred region.");
    visit.number("blurred_grey", self.blurred_grey, {0.0, 1.0}, "",
                 "The share of its confidence that a grey classifier loses in a blurred region.");
  }
};

/// \return how a region was taken, by its colours (region_colors()). How blurred it is, colours do not say: 0.
ImageContext context_of(std::span<const imaging::Rgb> colors);

/// The same of a region by 16 x 16 pixels that are spread over it, and how blurred it is along 16 of its rows; nothing is allocated.
/// \param image  YUYV.  \param region  in its pixels; the part within the image counts.
/// \return an undisturbed context where the region is outside, or for another pixel format.
ImageContext context_of(const ImageView& image, const Box& region);

/// The mean brightness of a region in [0, 1], as the camera codes it, of 16 x 16 pixels that are spread over it. \return 1 where context_of() says nothing.
double mean_luma(const ImageView& image, const Box& region);

/// How blurred grey values are along rows: the share of the differences between neighbours that is left when the row is blurred once more (Crete et al., "The blur
/// effect", 2007). A sharp face 70 px wide has .1 to .4, blurred by 2 px .6, by 3 px .8; noise looks sharp. \return 0 where the region is outside, narrower than 16 px or without a difference.
double blur_of(const ImageView& image, const Box& region);

inline constexpr double kNoNoise = 1000.0;  ///< a ratio of signal to noise that lowers no confidence.

/// By how much the grey values of a region stand out of the noise: their standard deviation over that of the noise, which is estimated by a mask that no plane or straight
/// edge along it answers to (Immerkaer, "Fast noise variance estimation", 1996), at 16 x 16 places. A face in good light has 3.5 or more, one that noise covers 1.
/// \return kNoNoise where the region is narrower than 16 px within the image, or for another pixel format.
double signal_to_noise(const ImageView& image, const Box& region);

/// \return the factor in [0, 1] by which a classifier of this kind is to be believed less: the product of 1 - share * loss over the disturbances.
double reliability(Cue cue, const ImageContext& context, const ContextParameters& parameters = {});

}  // namespace cgsr::person
